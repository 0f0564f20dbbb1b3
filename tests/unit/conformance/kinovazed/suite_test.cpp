// SPDX-License-Identifier: Apache-2.0
// The KinovaZED suite against the emulated servers, sound and faulty.
#include "conformance/kinovazed/suite.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "conformance/mutation.hpp"
#include "conformance/run.hpp"
#include "harness/rig/target.hpp"
#include "tests/unit/support/suites.hpp"

namespace armjig::kinovazed::conformance {
namespace {

Report run(const std::string& target, RunOptions options = {}) {
  const auto bench = test::kinovazed_suite().bench(target);
  options.permissions = Permissions::all();
  return run_suite(suite(), *bench, options, [](const ReportRow&) {});
}

std::vector<std::string> but_passed(const Report& report) {
  std::vector<std::string> rows;
  for (const auto& row : report.rows) {
    if (row.verdict != Verdict::kPass) rows.push_back(to_text(row));
  }
  return rows;
}

TEST(KinovazedSuite, HasAtLeast150RequirementsThatCasesCheck) {
  std::ptrdiff_t count = 0;
  for (const auto& chapter : suite().chapters) {
    count += std::ranges::count_if(chapter.requirements, [](const Requirement& requirement) {
      return requirement.role == Role::kDevice && requirement.unobservable.empty();
    });
  }
  EXPECT_GE(count, 150);
}

TEST(KinovazedSuite, PassesOnTheEmulatedServerWithEitherArm) {
  EXPECT_THAT(but_passed(run("emulated:")), testing::IsEmpty());
  EXPECT_THAT(but_passed(run("emulated:?plant=bench")), testing::IsEmpty());
}

TEST(KinovazedSuite, TakesEitherOrderWhereItIsNotGiven) {
  EXPECT_THAT(but_passed(run("emulated:?race=event")), testing::IsEmpty());
  EXPECT_THAT(but_passed(run("emulated:?race=random")), testing::IsEmpty());
}

TEST(KinovazedSuite, PassesOnAServerWithASlowArm) {
  EXPECT_THAT(but_passed(run("emulated:?call-us=2000")), testing::IsEmpty());
}

TEST(KinovazedSuite, AccusesNoServerWhoseArmTakesUpTo19MsACall) {
  using armjig::Profile;
  for (const auto profile : {Profile::kFirmware, Profile::kDocumented}) {
    for (const auto* call_us : {"3000", "5000", "10000", "19000"}) {
      const auto target =
          fmt::format("emulated:?profile={}&call-us={}", to_string(profile), call_us);
      const auto report = run(target, {.profile = profile});
      EXPECT_EQ(conclusion_of(report), Conclusion::kPassed) << target;
      // Two moments of a fast server cannot be hit.
      EXPECT_LE(but_passed(report).size(), 2U) << testing::PrintToString(but_passed(report));
    }
  }
}

TEST(KinovazedSuite, FindsAServerSlowFromItsFirstAnswerOnThatNoLinkExcuses) {
  RunOptions options;
  options.selection.filter = "kinovazed.time.answer.stopped";
  EXPECT_THAT(but_passed(run("emulated:?call-us=40000", options)), testing::IsEmpty());
  const auto slow = run("emulated:?call-us=150000", options);
  ASSERT_THAT(but_passed(slow), testing::SizeIs(1));
  EXPECT_EQ(slow.rows.front().verdict, Verdict::kFail);
  EXPECT_THAT(slow.rows.front().expected, testing::HasSubstr("0 to 500 ms"));
}

TEST(KinovazedSuite, PassesOnTheDocumentedServer) {
  EXPECT_THAT(
      but_passed(run("emulated:?profile=documented", {.profile = armjig::Profile::kDocumented})),
      testing::IsEmpty());
}

TEST(KinovazedSuite, FindsExactlyTheMappedDeviationsOfTheFirmwareFromTheDocument) {
  const auto suite = conformance::suite();
  for (const auto& row : run("emulated:", {.profile = armjig::Profile::kDocumented}).rows) {
    const auto& requirement = *find_requirement(suite, row.requirement);
    const auto wanted =
        requirement.profiles == Profiles::kDocumented ? Verdict::kDeviation : Verdict::kPass;
    EXPECT_EQ(row.verdict, wanted) << to_text(row);
  }
}

TEST(KinovazedSuite, GivesTheSameReportForTheSameSeed) {
  EXPECT_EQ(to_json(run("emulated:", {.seed = 3})), to_json(run("emulated:", {.seed = 3})));
}

TEST(KinovazedMutants, AreFoundAndProveEveryRequirement) {
  const auto result = run_mutants(suite(), mutants_entry(), test::kinovazed_suite().open, {});
  ASSERT_TRUE(result);
  EXPECT_THAT(result->broken_on_sound, testing::IsEmpty());
  EXPECT_GE(result->fates.size(), 100U);
  for (const auto& fate : result->fates) {
    EXPECT_EQ(fate.killer.empty(), !fate.mutant.equivalent.empty()) << fate.mutant.name;
  }
  for (const auto* requirement : result->unproven) ADD_FAILURE() << requirement->id;
}

}  // namespace
}  // namespace armjig::kinovazed::conformance
