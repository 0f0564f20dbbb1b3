// SPDX-License-Identifier: Apache-2.0
// What a suite is worth: the faulty devices that it finds. All of them are tried by
// `armjig conformance mutants`, which ctest -L soak runs.
#include "conformance/mutation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "conformance/parol6/suite.hpp"
#include "tests/unit/support/suites.hpp"

namespace armjig {
namespace {

using test::demo_suite;
using test::parol6_suite;

std::vector<std::string> findings(const test::TestedSuite& device, const MutationOptions& options) {
  const auto result = run_mutants(device.suite, device.mutants, device.open, options);
  std::vector<std::string> rows;
  for (const auto& row : to_report(*result, device.suite, options).rows) {
    const bool is_bad = row.verdict == Verdict::kFail || row.verdict == Verdict::kError;
    if (is_bad) rows.push_back(to_text(row));
  }
  return rows;
}

std::vector<NamedFault> sample() {
  const auto all = parol6::conformance::mutants_entry().faults();
  std::vector<NamedFault> some;
  std::ranges::sample(all, std::back_inserter(some), 60, std::mt19937{1});
  return some;
}

TEST(Mutation, ThereAreAtLeast200GeneratedBoardsAndMostAreNotEquivalent) {
  const auto all = mutants_of(parol6::conformance::mutants_entry(), Profile::kFirmware);
  const auto due = std::ranges::count_if(all, &std::string::empty, &Mutant::equivalent);
  EXPECT_GE(due, 200);
}

TEST(Mutation, KillsASampleOfFaultyBoards) {
  auto device = parol6_suite();
  device.mutants.faults = sample;
  EXPECT_THAT(findings(device, {.proves_requirements = false}), testing::IsEmpty());
}

TEST(Mutation, ExcusesUnderTheDocumentWhatOnlyShippedDevicesAreHeldTo) {
  auto device = parol6_suite();
  device.mutants.faults = sample;
  const MutationOptions documented{.profile = Profile::kDocumented, .proves_requirements = false};
  EXPECT_THAT(findings(device, documented), testing::IsEmpty());
}

/// A board that nothing gets out of homing.
std::vector<NamedFault> endless_homing() { return {{"row:homing.enable.kept", "Commands"}}; }

TEST(Mutation, FindsABoardThatCannotBeBroughtToAStart) {
  auto device = parol6_suite();
  device.mutants.faults = endless_homing;
  EXPECT_THAT(findings(device, {.proves_requirements = false}), testing::IsEmpty());
}

TEST(Mutation, KillsEveryFaultyDemoDeviceAndProvesEveryMust) {
  EXPECT_THAT(findings(demo_suite(), {}), testing::IsEmpty());
}

TEST(Mutation, SaysWhatWasNotTriedWhenItIsStopped) {
  const auto device = demo_suite();
  int asked = 0;
  MutationOptions options;
  options.must_stop = [&asked] { return ++asked > 12; };
  const auto result = run_mutants(device.suite, device.mutants, device.open, options);
  const auto report = to_report(*result, device.suite, options);
  EXPECT_GT(report.count(Verdict::kPass), 0U);
  EXPECT_GT(report.count(Verdict::kSkipped), 0U);
  EXPECT_EQ(report.count(Verdict::kFail), 0U) << "nobody knows whether they survive";
  EXPECT_TRUE(result->unproven.empty());
  EXPECT_EQ(report.rows.size(), mutants_of(device.mutants, Profile::kFirmware).size());
  EXPECT_THAT(report.rows.back().actual, testing::HasSubstr("interrupted"));
}

TEST(Mutation, ListsWhatSurvivesAsAFinding) {
  auto device = demo_suite();
  device.mutants.faults = [] {
    return std::vector<NamedFault>{{"off-by-one:no-such-field", "Nowhere"}};
  };
  EXPECT_THAT(findings(device, {.proves_requirements = false}),
              testing::ElementsAre(testing::HasSubstr("it survived")));
}

}  // namespace
}  // namespace armjig
