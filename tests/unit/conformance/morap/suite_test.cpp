// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "conformance/mutation.hpp"
#include "conformance/run.hpp"
#include "harness/rig/target.hpp"
#include "tests/unit/support/suites.hpp"

namespace armjig::morap::conformance {
namespace {

Report run(const std::string& target, RunOptions options = {}) {
  const auto bench = test::morap_suite().bench(target);
  options.permissions = Permissions::all();
  return run_suite(suite(), *bench, options, [](const ReportRow&) {});
}

std::vector<std::string> not_passed(const Report& report) {
  std::vector<std::string> rows;
  for (const auto& row : report.rows) {
    if (row.verdict != Verdict::kPass) rows.push_back(to_text(row));
  }
  return rows;
}

std::size_t count(Role role) {
  std::size_t count = 0;
  for (const auto& chapter : suite().chapters) {
    count += static_cast<std::size_t>(
        std::ranges::count_if(chapter.requirements, [&](const Requirement& requirement) {
          return requirement.role == role && requirement.unobservable.empty();
        }));
  }
  return count;
}

TEST(MorapSuite, HasAtLeast120RequirementsForTheDeviceAnd15ForTheMaster) {
  EXPECT_GE(count(Role::kDevice), 120U);
  EXPECT_GE(count(Role::kHost), 15U);
}

TEST(MorapSuite, PassesOnTheEmulatedFirmware) {
  EXPECT_THAT(not_passed(run("emulated:?pen=yes")), testing::IsEmpty());
}

TEST(MorapSuite, PassesOnTheFirmwareWithTheOtherMotorAtAnotherAddress) {
  EXPECT_THAT(not_passed(run("emulated:?motor=dcx26l&nodes=1&pen=yes")), testing::IsEmpty());
}

TEST(MorapSuite, AccusesNoShaftThatFrictionStops) {
  const auto rows = not_passed(run("emulated:?dry=0.3", {.selection = {.filter = "morap.brake"}}));
  EXPECT_THAT(rows, testing::SizeIs(2));
  EXPECT_THAT(rows, testing::Each(testing::HasSubstr("needs a shaft that coasts")));
}

TEST(MorapSuite, PassesOnTheDocumentedNode) {
  EXPECT_THAT(not_passed(run("emulated:?profile=documented&pen=yes",
                             {.profile = armjig::Profile::kDocumented})),
              testing::IsEmpty());
}

TEST(MorapSuite, FindsExactlyTheMappedDeviationsOfTheFirmwareFromTheDocument) {
  const auto report = run("emulated:?pen=yes", {.profile = armjig::Profile::kDocumented});
  for (const auto& row : report.rows) {
    const auto& requirement = *find_requirement(suite(), row.requirement);
    const auto wanted =
        requirement.profiles == Profiles::kDocumented ? Verdict::kDeviation : Verdict::kPass;
    EXPECT_EQ(row.verdict, wanted) << to_text(row);
  }
}

TEST(MorapSuite, GivesTheSameReportForTheSameSeed) {
  EXPECT_EQ(to_json(run("emulated:", {.seed = 3})), to_json(run("emulated:", {.seed = 3})));
}

TEST(MorapMutants, AreAllFoundAndBreakEachMust) {
  const auto result = run_mutants(suite(), mutants_entry(), test::morap_suite().open, {});
  ASSERT_TRUE(result);
  EXPECT_GE(result->fates.size(), 100U);
  EXPECT_THAT(result->broken_on_sound, testing::IsEmpty());
  for (const auto& fate : result->fates) {
    EXPECT_EQ(fate.killer.empty(), !fate.mutant.equivalent.empty())
        << fate.mutant.name << ": " << fate.killer << " " << fate.mutant.equivalent;
  }
  for (const auto* requirement : result->unproven) ADD_FAILURE() << requirement->id;
}

TEST(MorapTargets, AreTheFirstNodeOfABusThatMayHaveOthers) {
  const std::string file = testing::TempDir() + "nodes.toml";
  std::ofstream{file} << "[[pen]]\n[[node]]\nid = 4\nmotor = \"dcx26l\"\n[[node]]\nid = 3\n";
  const RunOptions options{.selection = {.filter = "morap.read"}};
  EXPECT_THAT(not_passed(run("emulated:?nodes=3,1&pen=yes", options)), testing::IsEmpty());
  EXPECT_THAT(not_passed(run("emulated:?file=" + file, options)), testing::IsEmpty());
}

TEST(MorapTargets, NameTheOptionThatIsWrong) {
  for (const auto* target : {"emulated:?nodes=17", "emulated:?motor=none", "emulated:?speed=1",
                             "emulated:?fault=law:none", "emulated:?profile=third"}) {
    const auto bench = test::morap_suite().open({.target = *parse_target(target)});
    ASSERT_FALSE(bench) << target;
    EXPECT_THAT(bench.error().where + bench.error().hint, testing::Not(testing::IsEmpty()));
  }
}

}  // namespace
}  // namespace armjig::morap::conformance
