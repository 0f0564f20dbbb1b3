// SPDX-License-Identifier: Apache-2.0
// The KinovaZED suite against the emulated servers, sound and faulty.
#include "conformance/kinovazed/suite.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "conformance/mutation.hpp"
#include "conformance/run.hpp"
#include "emulators/kinovazed/objectives.hpp"
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
    for (const auto* arm :
         {"plant=jaco&call-us=3000", "plant=jaco&call-us=5000", "plant=jaco&call-us=10000",
          "plant=jaco&call-us=19000", "plant=bench&call-us=3000", "plant=bench&call-us=10000",
          "plant=bench&call-us=14000", "plant=bench&call-us=19000"}) {
      const auto target = fmt::format("emulated:?profile={}&{}", to_string(profile), arm);
      const auto report = run(target, {.profile = profile});
      EXPECT_EQ(conclusion_of(report), Conclusion::kPassed) << target;
      // Two moments of a fast server cannot be hit.
      EXPECT_LE(but_passed(report).size(), 2U) << testing::PrintToString(but_passed(report));
    }
  }
}

/// Where an arm is when it is looked at is another place each time.
TEST(KinovazedSuite, TakesTheWaysOfASlowArmForWhatTheyAreEachTime) {
  RunOptions options;
  options.selection.filter = "kinovazed.objective.ways";
  options.repeat = 12;
  for (const auto* call_us : {"3000", "5000", "8000", "10000", "12000", "19000"}) {
    const auto report = run(fmt::format("emulated:?call-us={}", call_us), options);
    EXPECT_THAT(but_passed(report), testing::IsEmpty()) << call_us;
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

struct Moved {
  Objective objective;
  std::size_t point;
  float emulation::Pose::* component;
};

std::string json_of(const emulation::Pose& pose) {
  return fmt::format(R"({{"X":{},"Y":{},"Z":{},"pitch":{},"yaw":{},"roll":{}}})", pose.x, pose.y,
                     pose.z, pose.pitch, pose.yaw, pose.roll);
}

/// The published objectives, one number of which is 0.15 too large.
std::string objectives_with(const Moved& moved) {
  std::string text;
  const auto set = emulation::published_objectives();
  for (std::size_t i = 0; i < kObjectiveNames.size(); ++i) {
    auto path = *set.find(static_cast<Objective>(i));
    if (path.objective == moved.objective) path.points[moved.point].*moved.component += 0.15F;
    std::string points;
    for (const auto& point : path.points) points += (points.empty() ? "" : ",") + json_of(point);
    text +=
        fmt::format(R"({}{{"name":"{}","is_abs":{},"origin":{},"sequence":[{}]}})",
                    text.empty() ? "[" : ",", to_string(path.objective), path.origin.has_value(),
                    json_of(path.origin.value_or(emulation::Pose{})), points);
  }
  return text + "]";
}

/// Without a hand at the arm, by times alone.
TEST(KinovazedSuite, FindsAWayPointThatIsElsewhereByHowLongObjectivesTake) {
  using emulation::Pose;
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("armjig-objectives-{}.json", ::getpid());
  RunOptions options;
  options.selection.filter = "kinovazed.objective.ways";
  for (const auto& moved :
       {Moved{Objective::kHome, 0, &Pose::x}, Moved{Objective::kHandle, 1, &Pose::y},
        Moved{Objective::kSuckDoor, 0, &Pose::z}, Moved{Objective::kAntenna, 1, &Pose::x},
        Moved{Objective::kOpenDoor, 3, &Pose::roll}, Moved{Objective::kOpenDoor, 6, &Pose::y},
        Moved{Objective::kPullDoor, 2, &Pose::z}, Moved{Objective::kPlaceBottle, 0, &Pose::z}}) {
    std::ofstream{file} << objectives_with(moved);
    for (const auto* plant : {"jaco", "bench"}) {
      const auto report =
          run(fmt::format("emulated:?plant={}&objectives={}", plant, file.string()), options);
      EXPECT_EQ(conclusion_of(report), Conclusion::kFindings)
          << to_string(moved.objective) << " " << moved.point << " " << plant
          << testing::PrintToString(but_passed(report));
    }
  }
  std::filesystem::remove(file);
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
