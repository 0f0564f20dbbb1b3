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

namespace armjig {
namespace {

const Suite& suite_of(std::string_view device) {
  return *std::ranges::find(suites(), device, &Suite::device);
}

const MutantsEntry& entry_of(std::string_view device) {
  return *std::ranges::find(mutants(), device, &MutantsEntry::device);
}

std::vector<std::string> findings(const Suite& suite, const MutantsEntry& entry,
                                  const MutationOptions& options) {
  const auto result = run_mutants(suite, entry, options);
  std::vector<std::string> rows;
  for (const auto& row : to_report(*result, suite, options).rows) {
    const bool is_bad = row.verdict == Verdict::kFail || row.verdict == Verdict::kError;
    if (is_bad) rows.push_back(to_text(row));
  }
  return rows;
}

std::vector<NamedFault> sample() {
  const auto all = entry_of("parol6").faults();
  std::vector<NamedFault> some;
  std::ranges::sample(all, std::back_inserter(some), 60, std::mt19937{1});
  return some;
}

TEST(Mutation, ThereAreAtLeast200GeneratedBoardsAndMostAreNotEquivalent) {
  const auto all = mutants_of(entry_of("parol6"), Profile::kFirmware);
  const auto due = std::ranges::count_if(all, &std::string::empty, &Mutant::equivalent);
  EXPECT_GE(due, 200);
}

TEST(Mutation, KillsASampleOfFaultyBoards) {
  auto entry = entry_of("parol6");
  entry.faults = sample;
  EXPECT_THAT(findings(suite_of("parol6"), entry, {.proves_requirements = false}),
              testing::IsEmpty());
}

TEST(Mutation, ExcusesUnderTheDocumentWhatOnlyShippedDevicesAreHeldTo) {
  auto entry = entry_of("parol6");
  entry.faults = sample;
  const MutationOptions documented{.profile = Profile::kDocumented, .proves_requirements = false};
  EXPECT_THAT(findings(suite_of("parol6"), entry, documented), testing::IsEmpty());
}

/// A board that nothing gets out of homing.
std::vector<NamedFault> endless_homing() { return {{"row:homing.enable.kept", "Commands"}}; }

TEST(Mutation, FindsABoardThatCannotBeBroughtToAStart) {
  auto entry = entry_of("parol6");
  entry.faults = endless_homing;
  EXPECT_THAT(findings(suite_of("parol6"), entry, {.proves_requirements = false}),
              testing::IsEmpty());
}

TEST(Mutation, KillsEveryFaultyDemoDeviceAndProvesEveryMust) {
  EXPECT_THAT(findings(suite_of("demo"), entry_of("demo"), {}), testing::IsEmpty());
}

TEST(Mutation, ListsWhatSurvivesAsAFinding) {
  auto entry = entry_of("demo");
  entry.faults = [] { return std::vector<NamedFault>{{"off-by-one:no-such-field", "Nowhere"}}; };
  EXPECT_THAT(findings(suite_of("demo"), entry, {.proves_requirements = false}),
              testing::ElementsAre(testing::HasSubstr("it survived")));
}

}  // namespace
}  // namespace armjig
