// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "conformance/run.hpp"
#include "tests/unit/support/suites.hpp"

namespace armjig {
namespace {

using test::suite_of;

/// What the case with some of the sessions says of an emulated device.
ReportRow row_about(std::string_view device, const std::string& target) {
  const auto tested = suite_of(device);
  RunOptions run;
  run.selection.filter = ".sessions.as-reference.few";
  run.permissions = Permissions::all();
  const auto bench = tested.bench(target);
  const auto report = run_suite(tested.suite, *bench, run, [](const ReportRow&) {});
  EXPECT_EQ(report.rows.size(), 1U);
  return report.rows.at(0);
}

TEST(Sessions, ShowNothingInASoundDeviceWhateverItsPlantAndPasses) {
  const auto verdict_on = [](std::string_view device, const std::string& target) {
    const auto bench = suite_of(device).bench(target);
    bench->begin(Profile::kFirmware, 1);
    bench->expect_as_reference(20);
    return bench->judgement().verdict;
  };
  EXPECT_EQ(verdict_on("parol6", "emulated:?pass-us=250&to-switch=4000"), Verdict::kPass);
  EXPECT_EQ(verdict_on("morap", "emulated:?pen=yes&load=1"), Verdict::kPass);
  EXPECT_EQ(verdict_on("kinovazed", "emulated:?plant=bench"), Verdict::kPass);
  EXPECT_EQ(verdict_on("kinovazed", "emulated:?clock=2"), Verdict::kPass);
}

TEST(Sessions, ShowWhatNoRequirementSpeaksOfAndHowToSeeItAgain) {
  const auto row = row_about("parol6", "emulated:?fault=zero:gripper.object");
  EXPECT_EQ(row.verdict, Verdict::kFail);
  EXPECT_THAT(row.actual, testing::HasSubstr("gripper.object"));
  EXPECT_THAT(row.actual, testing::HasSubstr("armjig fuzz parol6 --target "
                                             "'emulated:?fault=zero:gripper.object' "
                                             "--model 'emulated:' --seed "));
}

TEST(Sessions, AreLeftOutWhereTheLinkIsBadOnPurpose) {
  const auto tested = suite_of("kinovazed");
  RigOptions how;
  how.target = parse_target("emulated:").value();
  how.impairment.emplace();
  const auto bench = tested.open(how).value();
  bench->begin(Profile::kFirmware, 1);
  bench->expect_as_reference(1);
  EXPECT_EQ(bench->judgement().verdict, Verdict::kSkipped);
  EXPECT_TRUE(bench->judgement().is_left_out);
}

}  // namespace
}  // namespace armjig
