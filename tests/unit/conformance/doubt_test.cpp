// SPDX-License-Identifier: Apache-2.0
// What counts against a device on links and machines that have a part in what is seen.
#include "conformance/doubt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "tests/unit/conformance/number_bench.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

void answers_in_time(Bench& bench) {
  auto& device = number(bench);
  const auto is_late = device.late_answers-- > 0;
  device.ran.emplace_back(is_late ? "late" : "in time");
  device.expect_in_time({is_late ? 700.0 : 120.0, 0, 500, "ms"}, "0 to 500 ms", "another time");
}
void makes_start_late_now_and_then(Bench& bench) {
  auto& device = number(bench);
  device.ran.emplace_back("in time");
  if (device.ran.size() % 4 == 0) device.late_starts = 1;
}
/// A moment decides what it hears.
void races(Bench& bench) {
  auto& device = number(bench);
  device.begin_race();
  device.expect_true(device.late_answers-- <= 0, "a word", "another one");
}
void answers_wrong(Bench& bench) {
  auto& device = number(bench);
  device.expect_true(device.wrong_answers-- <= 0, "a number", "another one");
}

constexpr Requirement kPrompt[] = {{"n.prompt", Level::kMust, "It is prompt.", "here"},
                                   {"n.race", Level::kMust, "It is first.", "here"},
                                   {"n.right", Level::kMust, "It is right.", "here"},
                                   {"n.delays", Level::kMust, "It takes its time.", "here"}};
constexpr Case kPromptCases[] = {
    {.requirement = "n.prompt", .rule = "r", .run = answers_in_time},
    {.requirement = "n.right", .rule = "r", .run = answers_wrong},
    {.requirement = "n.delays", .rule = "r", .run = makes_start_late_now_and_then},
    {.requirement = "n.race", .rule = "r", .run = races, .hazard = Hazard::kCrash}};
const Chapter kPromptChapters[] = {{"Moments",
                                    {std::begin(kPrompt), std::end(kPrompt)},
                                    {std::begin(kPromptCases), std::end(kPromptCases)}}};
constexpr StartState kPromptStarts[] = {{"zero", Hazard::kObserve}};
const Suite kPromptSuite{"n", "7", kPromptChapters, kPromptStarts};

Report run_prompt(NumberBench& bench, RunOptions options = {},
                  const std::string& filter = "n.prompt") {
  options.selection.filter = filter;
  options.permissions = Permissions::all();
  return run_suite(kPromptSuite, bench, options, [](const ReportRow&) {});
}

/// On a real link, where a sound device is late, or wrong, so many times.
RunOptions beside(int late_answers, int wrong_answers = 0) {
  RunOptions options;
  options.reference = [=] {
    auto sound = std::make_shared<NumberBench>();
    sound->late_answers = late_answers;
    sound->wrong_answers = wrong_answers;
    sound->noise_here = 2ms;
    return sound;
  };
  return options;
}

TEST(ConformanceDoubt, TakesNoMoreForTheLinksOwnThanALinkOfItsKindHas) {
  NumberBench bench;
  bench.noise_here = 1900ms;
  const auto report = run_prompt(bench, beside(0));
  EXPECT_EQ(bench.heard_noise(), 1900ms);
  EXPECT_EQ(bench.noise(), 502ms) << "what binds the device, and the link";
  EXPECT_EQ(bench.link_noise(), 2ms);
  EXPECT_THAT(report.facts, testing::Contains(testing::Pair("an emulated device's answers in",
                                                            "2000 us at most")));
}

TEST(ConformanceDoubt, TakesNothingForTheLinksInVirtualTime) {
  NumberBench bench;
  bench.noise_here = 20ms;
  (void)run_prompt(bench);
  EXPECT_EQ(bench.noise(), 20ms);
  EXPECT_EQ(bench.link_noise(), 0ms);
}

TEST(ConformanceDoubt, AccusesNobodyOfAMomentThatIsNotMissedAgain) {
  NumberBench bench;
  bench.late_answers = 1;
  const auto report = run_prompt(bench, beside(0));
  EXPECT_THAT(verdicts(report), ElementsAre("n.prompt pass"));
  EXPECT_THAT(bench.ran, ElementsAre("late", "in time", "in time"));
  EXPECT_THAT(report.rows.front().actual, HasSubstr("once expected 0 to 500 ms"));
}

TEST(ConformanceDoubt, AccusesADeviceThatIsLateWhereAnEmulatedOneIsNot) {
  NumberBench bench;
  bench.late_answers = 2;
  EXPECT_THAT(verdicts(run_prompt(bench, beside(0))), ElementsAre("n.prompt fail"));
}

TEST(ConformanceDoubt, WantsAMomentMissedAgainAndAgainOnABusyMachine) {
  const auto late_for = [](int times) {
    NumberBench bench;
    bench.late_answers = times;
    auto options = beside(0);
    options.is_busy = [] { return true; };
    return run_prompt(bench, options).rows.front();
  };
  for (const int times : {2, 3, 4}) {
    const auto row = late_for(times);
    EXPECT_EQ(row.verdict, Verdict::kInconclusive) << times;
    EXPECT_THAT(row.actual, HasSubstr(std::to_string(times) + " times expected 0 to 500 ms"));
  }
  EXPECT_EQ(late_for(5).verdict, Verdict::kFail);
}

TEST(ConformanceDoubt, WantsAnyFailureAgainOnABusyMachine) {
  const auto wrong_for = [](int times, bool is_busy) {
    NumberBench bench;
    bench.wrong_answers = times;
    auto options = beside(0);
    options.is_busy = [is_busy] { return is_busy; };
    return run_prompt(bench, options, "n.right").rows.front();
  };
  EXPECT_EQ(wrong_for(1, false).verdict, Verdict::kFail);
  const auto once = wrong_for(1, true);
  EXPECT_EQ(once.verdict, Verdict::kInconclusive);
  EXPECT_THAT(once.actual, HasSubstr("2 times as it should be, on a machine that has too much"));
  EXPECT_EQ(wrong_for(4, true).verdict, Verdict::kInconclusive);
  EXPECT_EQ(wrong_for(5, true).verdict, Verdict::kFail);
}

TEST(ConformanceDoubt, TriesNothingAgainOnABusyMachineOnceSomethingHasFailedForGood) {
  NumberBench bench;
  auto options = beside(0);
  options.is_busy = [] { return true; };
  bench.late_answers = 5;
  bench.wrong_answers = 1;
  const auto found = verdicts(run_prompt(bench, options, "n."));
  EXPECT_THAT(found, testing::IsSupersetOf({"n.prompt fail", "n.right fail"}));
}

TEST(ConformanceDoubt, TriesAStartAgainThatWasLateOnce) {
  NumberBench bench;
  bench.late_starts = 1;
  EXPECT_THAT(verdicts(run_prompt(bench, beside(0))), ElementsAre("n.prompt pass"));
}

TEST(ConformanceDoubt, TriesAStartAgainHoweverOftenItWasLateOnceBefore) {
  NumberBench bench;
  auto options = beside(0);
  options.repeat = 20;
  EXPECT_THAT(verdicts(run_prompt(bench, options, "n.delays")), ElementsAre("n.delays pass"));
}

TEST(ConformanceDoubt, DoesNotGiveUpAStartThatIsLateOnABusyMachine) {
  NumberBench bench;
  bench.late_starts = 4;
  auto options = beside(0);
  options.is_busy = [] { return true; };
  options.required_share = 0;
  EXPECT_THAT(verdicts(run_prompt(bench, options, "n.")),
              ElementsAre("n.prompt inconclusive", "n.right pass", "n.delays pass", "n.race pass"));
}

TEST(ConformanceDoubt, AccusesADeviceWhoseStartIsLateEachTime) {
  const auto visits_of = [](bool is_busy) {
    NumberBench bench;
    bench.late_starts = 100;
    auto options = beside(0);
    options.is_busy = [is_busy] { return is_busy; };
    options.repeat = 10;
    const auto found = verdicts(run_prompt(bench, options, "n."));
    EXPECT_THAT(found, testing::Contains("n.start fail"));
    return bench.visited.size();
  };
  EXPECT_LT(visits_of(false), 10U) << "not again for each case";
  EXPECT_LT(visits_of(true), 40U) << "nor for ever";
}

TEST(ConformanceDoubt, LeavesOpenWhatAnEmulatedDeviceOnSuchALinkMissesAsWell) {
  NumberBench bench;
  bench.late_answers = 2;
  const auto report = run_prompt(bench, beside(1));
  ASSERT_THAT(verdicts(report), ElementsAre("n.prompt inconclusive"));
  EXPECT_THAT(report.rows.front().actual, HasSubstr("an emulated device on such a link"));
}

TEST(ConformanceDoubt, TriesAnEmulatedDeviceAsOftenAsTheOneThatIsAccused) {
  NumberBench bench;
  bench.late_answers = 2;
  RunOptions options;
  options.reference = [opened = 0]() mutable {
    auto sound = std::make_shared<NumberBench>();
    sound->late_answers = ++opened == 3 ? 1 : 0;  // the first one is for the noise
    return sound;
  };
  EXPECT_THAT(verdicts(run_prompt(bench, options)), ElementsAre("n.prompt inconclusive"));
}

TEST(ConformanceDoubt, LeavesOpenWhateverAnEmulatedDeviceOnSuchALinkFails) {
  const auto wrong_beside = [](int wrong_answers) {
    NumberBench bench;
    bench.wrong_answers = 1;
    return verdicts(run_prompt(bench, beside(0, wrong_answers), "n.right"));
  };
  EXPECT_THAT(wrong_beside(1), ElementsAre("n.right inconclusive"));
  EXPECT_THAT(wrong_beside(0), ElementsAre("n.right fail"));
}

TEST(ConformanceDoubt, TakesWhatAMomentDecidesForAMomentThatWasMissed) {
  NumberBench lucky;
  lucky.late_answers = 1;
  EXPECT_THAT(verdicts(run_prompt(lucky, beside(0), "n.race")), ElementsAre("n.race pass"));
  NumberBench late;
  late.late_answers = 2;
  EXPECT_THAT(verdicts(run_prompt(late, beside(1), "n.race")), ElementsAre("n.race inconclusive"));
  NumberBench unlucky;
  unlucky.late_answers = 2;
  EXPECT_THAT(verdicts(run_prompt(unlucky, beside(0), "n.race")),
              ElementsAre("n.race inconclusive"))
      << "chance may decide a race twice";
  NumberBench other;
  other.late_answers = 5;
  EXPECT_THAT(verdicts(run_prompt(other, beside(0), "n.race")), ElementsAre("n.race fail"));
}

TEST(ConformanceDoubt, SaysHowNearToItsBoundsAPassWas) {
  NumberBench bench;
  EXPECT_EQ(run_prompt(bench).rows.front().margin, "120.0 of 0.0 to 500.0 ms");
}

}  // namespace
}  // namespace armjig
