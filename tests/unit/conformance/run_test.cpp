// SPDX-License-Identifier: Apache-2.0
// The engine, with made-up suites and devices that die, change their minds or lie.
#include "conformance/run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/conformance/number_bench.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

void passes(Bench& bench) {
  number(bench).ran.emplace_back("passes");
  number(bench).randoms.push_back(bench.random());
}
void passes_too(Bench& bench) {
  number(bench).ran.emplace_back("passes too");
  number(bench).randoms.push_back(bench.random());
}
void fails_twice(Bench& bench) {
  number(bench).ran.emplace_back("fails");
  bench.fail("one", "two");
  bench.fail("three", "four");
}
void fails_every_other_time(Bench& bench) {
  if (number(bench).calls % 2 == 0) bench.fail("an odd call", "an even one");
}
void moves_on(Bench& bench) {
  auto& device = number(bench);
  device.ran.emplace_back("moves on");
  if (device.is_stopped_now) return bench.give_up("nobody watches over the arm");
  if (device.supervisors_left-- <= 0) return;
  device.is_stopped_now = true;
  bench.give_up("nobody watches over the arm any more");
}
void takes_stop_for_fault(Bench& bench) {
  number(bench).is_stopped_now = true;
  bench.fail("an arm that moves", "one that stands");
}
void is_late(Bench& bench) {
  auto& device = number(bench);
  device.ran.emplace_back("late");
  if (device.stops_left-- <= 0) return;
  device.missed += 3s;
  bench.fail_by_silence("an answer in time", "one 3 s later");
}
void dies(Bench& bench) {
  if (number(bench).deaths_left-- <= 0) return;
  number(bench).is_dead = true;
  bench.fail_by_silence("an answer", "silence");
}
void loses_link(Bench& bench) { number(bench).lose_link({ErrorCode::kDisconnected, 0}); }
void is_quiet_once(Bench& bench) { bench.fail_by_silence("an answer", "silence"); }
void crashes(Bench& bench) { number(bench).ran.emplace_back("crashes"); }
void skips(Bench& bench) {
  if (number(bench).stops_left-- > 0) number(bench).missed += 3s;
  bench.skip("no hand");
}
void breaks_document(Bench& bench) { bench.fail("what the document says", "something else"); }
void obeys_firmware(Bench& bench) {
  if (!number(bench).obeys_firmware) bench.fail("what the firmware does", "something else");
}

constexpr Requirement kRequirements[] = {
    {"n.pass", Level::kMust, "It passes.", "here"},
    {"n.too", Level::kMust, "It passes too.", "here"},
    {"n.fail", Level::kMust, "It is one.", "here"},
    {"n.flaky", Level::kMust, "It is odd.", "here"},
    {"n.late", Level::kMust, "It is in time.", "here"},
    {"n.dies", Level::kMust, "It lives.", "here"},
    {"n.link", Level::kMust, "It is there.", "here"},
    {"n.quiet", Level::kMust, "It answers.", "here"},
    {"n.skips", Level::kMust, "It has hands.", "here"},
    {"n.documented", Level::kMust, "It is documented.", "here", Profiles::kDocumented,
     "n.firmware"},
    {"n.firmware", Level::kMust, "It is shipped.", "here", Profiles::kFirmware, "n.documented"},
    {"n.beyond", Level::kMust, "It can be reached.", "here"},
    {"n.moves", Level::kMust, "It moves.", "here"},
    {"n.watched", Level::kMust, "It is watched.", "here"},
    {"n.unseen", Level::kMust, "It moves on.", "here"},
};

constexpr Case kCases[] = {
    {.requirement = "n.moves", .rule = "r", .run = passes, .hazard = Hazard::kMove, .start = 1},
    {.requirement = "n.pass", .rule = "r", .run = passes},
    {.requirement = "n.too", .rule = "r", .run = passes_too, .start = 1},
    {.requirement = "n.fail", .rule = "r", .run = fails_twice},
    {.requirement = "n.flaky", .rule = "r", .run = fails_every_other_time},
    {.requirement = "n.quiet", .rule = "r", .run = is_quiet_once, .tier = Tier::kFull},
    {.requirement = "n.skips", .rule = "r", .run = skips},
    {.requirement = "n.watched", .rule = "r", .run = moves_on},
    {.requirement = "n.unseen", .rule = "r", .run = takes_stop_for_fault},
    {.requirement = "n.beyond", .variant = "a", .rule = "r", .run = passes, .start = 2},
    {.requirement = "n.beyond", .variant = "b", .rule = "r", .run = passes, .start = 2},
    {.requirement = "n.late", .rule = "r", .run = is_late},
    {.requirement = "n.dies", .rule = "r", .run = dies},
    {.requirement = "n.link", .rule = "r", .run = loses_link},
    {.requirement = "n.documented", .rule = "r", .run = breaks_document},
    {.requirement = "n.firmware", .rule = "r", .run = obeys_firmware},
};

constexpr StartState kStarts[] = {
    {"zero", Hazard::kObserve}, {"one", Hazard::kObserve}, {"beyond reach", Hazard::kObserve}};
const Chapter kChapters[] = {{"Numbers",
                              {std::begin(kRequirements), std::end(kRequirements)},
                              {std::begin(kCases), std::end(kCases)}}};
const Suite kSuite{"n", "7", kChapters, kStarts};

Report run(NumberBench& bench, const std::string& filter, RunOptions options = {}) {
  options.selection.filter = filter;
  options.permissions.add(Hazard::kMove);
  options.command = "armjig conformance n";
  return run_suite(kSuite, bench, options, [](const ReportRow&) {});
}

Report run(const std::string& filter, const RunOptions& options = {}) {
  NumberBench bench;
  return run(bench, filter, options);
}

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(ConformanceRun, TellsAFailureWithAllThatIsKnownAboutIt) {
  const auto report = run("n.fail");
  ASSERT_EQ(report.rows.size(), 1U);
  const auto& row = report.rows[0];
  EXPECT_EQ(row.verdict, Verdict::kFail);
  EXPECT_EQ(row.expected, "one") << "the first finding decides";
  EXPECT_EQ(row.actual, "two");
  EXPECT_EQ(row.demand, "It is one.");
  EXPECT_EQ(row.source, "here");
  EXPECT_EQ(row.evidence, "the last exchange\n");
  EXPECT_EQ(row.repeat, "armjig conformance n --filter n.fail");
}

TEST(ConformanceRun, NamesTheCatalogueAndTheSeed) {
  const auto report = run("n.pass", {.seed = 5});
  EXPECT_THAT(report.facts,
              testing::Contains(std::pair<std::string, std::string>{"catalogue", "7"}));
  EXPECT_THAT(report.facts, testing::Contains(std::pair<std::string, std::string>{"seed", "5"}));
}

TEST(ConformanceRun, GoesFromStartStateToStartState) {
  NumberBench bench;
  (void)run(bench, "");
  EXPECT_TRUE(std::ranges::is_sorted(bench.visited)) << "start 0 first, then 1, then 2";
}

TEST(ConformanceRun, GivesUpAStartStateOnce) {
  NumberBench bench;
  const auto report = run(bench, "n.beyond");
  EXPECT_THAT(verdicts(report),
              ElementsAre("n.start fail", "n.beyond.a inconclusive", "n.beyond.b inconclusive"));
  EXPECT_THAT(report.rows[0].summary, HasSubstr("beyond reach"));
  EXPECT_THAT(report.rows[2].actual, HasSubstr("beyond reach"));
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings) << "a sound device can be brought there";
  EXPECT_EQ(bench.visited.size(), 1U);
  EXPECT_THAT(bench.ran, IsEmpty());
}

TEST(ConformanceRun, BlamesNobodyForAStartStateThatIsLeftOpen) {
  NumberBench bench;
  bench.leaves_beyond_open = true;
  const auto report = run(bench, "n.beyond");
  EXPECT_THAT(verdicts(report), ElementsAre("n.beyond.a inconclusive", "n.beyond.b inconclusive"));
}

TEST(ConformanceRun, SkipsWhatIsLeftWhenItIsStopped) {
  NumberBench bench;
  const auto report = run(bench, "", {.must_stop = [&bench] { return bench.ran.size() >= 2; }});
  EXPECT_THAT(bench.ran, ElementsAre("passes", "fails"));
  const auto rows = verdicts(report);
  EXPECT_EQ(rows[0], "n.pass pass");
  EXPECT_EQ(rows[1], "n.fail skipped") << "it was under way, so nobody knows what it shows";
  EXPECT_EQ(report.count(Verdict::kSkipped), 14U) << "and each of the others is named";
  EXPECT_EQ(report.rows.size(), 15U);
  EXPECT_THAT(report.rows.back().actual, HasSubstr("interrupted"));
}

TEST(ConformanceRun, SkipsWhatIsNotAllowed) {
  NumberBench bench;
  const auto report =
      run_suite(kSuite, bench, {.selection = {.filter = "n.moves"}}, [](const ReportRow&) {});
  EXPECT_THAT(verdicts(report), ElementsAre("n.moves skipped"));
  EXPECT_EQ(report.rows[0].actual, "needs --allow move");
  EXPECT_EQ(conclusion_of(report), Conclusion::kNothing);
}

constexpr Requirement kFatal[] = {{"d.crash", Level::kMust, "It ends.", "here"},
                                  {"d.look", Level::kMust, "It looks.", "here"},
                                  {"d.hand", Level::kMust, "It feels.", "here"},
                                  {"d.none", Level::kMust, "It dreams.", "here"},
                                  {"d.should", Level::kShould, "It may.", "here"}};
constexpr Case kFatalCases[] = {
    {.requirement = "d.crash", .rule = "r", .run = crashes, .hazard = Hazard::kCrash},
    {.requirement = "d.look", .rule = "r", .run = passes, .start = 1},
    {.requirement = "d.hand", .rule = "r", .run = skips},
    {.requirement = "d.should", .rule = "r", .run = passes_too},
};
const Chapter kFatalChapters[] = {{"Ends",
                                   {std::begin(kFatal), std::end(kFatal)},
                                   {std::begin(kFatalCases), std::end(kFatalCases)}}};
const Suite kFatalSuite{"d", "1", kFatalChapters, kStarts};

Report run_fatal(NumberBench& bench, RunOptions options = {}) {
  options.permissions = Permissions::all();
  return run_suite(kFatalSuite, bench, options, [](const ReportRow&) {});
}

TEST(ConformanceRun, RunsLastWhatEndsTheDevicesProgram) {
  NumberBench bench;
  (void)run_fatal(bench);
  EXPECT_THAT(bench.ran, ElementsAre("passes too", "passes", "crashes"));
}

TEST(ConformanceRun, EndsNoProgramThatNobodyStartsAgain) {
  NumberBench bench;
  bench.has_nobody = true;
  const auto report = run_fatal(bench);
  EXPECT_THAT(bench.ran, ElementsAre("passes too", "passes"));
  EXPECT_THAT(report.rows.back().actual, HasSubstr("--restart"));
}

TEST(ConformanceRun, SaysWhichShareOfTheMustRequirementsItJudged) {
  NumberBench bench;
  const auto coverage = run_fatal(bench).coverage.value();
  EXPECT_EQ(coverage.all, 4U) << "a should is none";
  EXPECT_EQ(coverage.judged, 2U);
  EXPECT_EQ(coverage.within, 2U) << "a hand is missing, and one has no case";
  EXPECT_EQ(coverage.judged_within, 2U);
}

TEST(ConformanceRun, FailsIfTooLittleWasJudged) {
  NumberBench bench;
  int asked = 0;
  const auto stops = [&asked] { return ++asked > 6; };
  const auto report = run_fatal(bench, {.must_stop = stops, .is_time_up = [] { return true; }});
  EXPECT_EQ(report.rows.back().name, "d.judged");
  EXPECT_EQ(report.rows.back().verdict, Verdict::kFail);
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
  EXPECT_THAT(verdicts(report), testing::Contains("d.crash skipped"));
  NumberBench other;
  asked = 0;
  EXPECT_EQ(
      conclusion_of(run_fatal(
          other, {.required_share = 0, .must_stop = stops, .is_time_up = [] { return true; }})),
      Conclusion::kPassed);
  NumberBench interrupted;
  asked = 0;
  EXPECT_EQ(conclusion_of(run_fatal(interrupted, {.must_stop = stops})), Conclusion::kPassed)
      << "who interrupts knows that it is not whole";
}

TEST(ConformanceRun, AnswersThatAreNotUnderstoodAreAFinding) {
  NumberBench bench;
  bench.is_gibberish = true;
  const auto report = run(bench, "n.pass");
  EXPECT_THAT(verdicts(report), ElementsAre("n.alive fail", "n.pass skipped"));
  EXPECT_EQ(report.rows[0].actual, "a letter");
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
}

TEST(ConformanceRun, TellsATargetThatDiedFromOneThatFails) {
  EXPECT_THAT(verdicts(run("n.quiet")), ElementsAre("n.quiet fail")) << "it answers afterwards";
  EXPECT_THAT(verdicts(run("n.d")), ElementsAre("n.alive error", "n.dies error"));
}

TEST(ConformanceRun, WhoeverDiesOfACaseTwiceHasFailedItAndIsBroughtBack) {
  NumberBench bench;
  bench.revivals_left = 2;
  const auto report = run(bench, "n.");
  EXPECT_THAT(verdicts(report), testing::Contains("n.dies fail"));
  EXPECT_THAT(verdicts(report), testing::Not(testing::Contains("n.alive error")));
  EXPECT_THAT(verdicts(report), testing::Contains("n.link error")) << "it goes on";
  const auto row = std::ranges::find(report.rows, "n.dies", &ReportRow::name);
  EXPECT_THAT(row->actual, HasSubstr("silence, twice"));
}

TEST(ConformanceRun, WhoeverDiesOfACaseOnceMayHaveBeenSwitchedOff) {
  NumberBench bench;
  bench.revivals_left = 2;
  bench.deaths_left = 1;
  const auto report = run(bench, "n.d");
  EXPECT_THAT(verdicts(report), testing::Contains("n.dies inconclusive"));
  EXPECT_THAT(report.rows[0].actual, HasSubstr("once"));
}

TEST(ConformanceRun, WhoeverCannotBeBroughtBackTwiceIsGone) {
  NumberBench bench;
  bench.revivals_left = 1;
  EXPECT_THAT(verdicts(run(bench, "n.dies")), ElementsAre("n.alive error", "n.dies error"));
}

TEST(ConformanceRun, RunsNothingMoreOnceTheTargetIsGone) {
  NumberBench bench;
  bench.is_dead = true;
  const auto report = run(bench, "n.pass");
  EXPECT_THAT(verdicts(report), ElementsAre("n.alive error", "n.pass skipped"));
  EXPECT_EQ(conclusion_of(report), Conclusion::kRig);
  EXPECT_EQ(bench.measured, 0);
}

TEST(ConformanceRun, BlamesALinkThatBreaksOnTheRig) {
  const auto report = run("n.link");
  EXPECT_THAT(verdicts(report), ElementsAre("n.link error"));
  EXPECT_EQ(conclusion_of(report), Conclusion::kRig);
}

TEST(ConformanceRun, CallsFlakyWhatIsNotAlwaysTheSame) {
  const auto report = run("n.flaky", {.repeat = 4});
  EXPECT_THAT(verdicts(report), ElementsAre("n.flaky flaky"));
  EXPECT_THAT(report.rows[0].actual, HasSubstr("in 2 of 4 runs"));
  EXPECT_THAT(verdicts(run("n.fail", {.repeat = 3})), ElementsAre("n.fail fail"));
}

RunOptions watching(const NumberBench& bench, int repeat = 1) {
  return {.repeat = repeat, .missed = [&bench] { return bench.missed; }};
}

TEST(ConformanceRun, StartsACaseAgainThatItDidNotWatch) {
  NumberBench bench;
  bench.stops_left = 1;
  const auto report = run(bench, "n.late", watching(bench, 2));
  EXPECT_THAT(verdicts(report), ElementsAre("n.late pass")) << "and not flaky";
  EXPECT_EQ(bench.ran.size(), 3U) << "two runs count";
  EXPECT_EQ(report.facts.back().first, "stopped");
  EXPECT_THAT(report.facts.back().second, HasSubstr("3.000 s"));
}

TEST(ConformanceRun, StartsACaseAgainInWhichASupervisorStoppedTheDevice) {
  NumberBench bench;
  bench.supervisors_left = 2;
  const auto report = run(bench, "n.watched", {});
  EXPECT_THAT(verdicts(report), ElementsAre("n.watched pass"));
  EXPECT_EQ(bench.ran.size(), 3U);
  EXPECT_EQ(report.facts.back().first, "stopped");
}

TEST(ConformanceRun, LetsTheNextCaseMoveAfterOneThatASupervisorStoppedEachTime) {
  NumberBench bench;
  bench.supervisors_left = 3;
  EXPECT_THAT(verdicts(run(bench, "n.watched", {})), ElementsAre("n.watched skipped"));
  EXPECT_THAT(verdicts(run(bench, "n.watched", {})), ElementsAre("n.watched pass"));
}

TEST(ConformanceRun, AccusesNoDeviceThatASupervisorStoppedEachTime) {
  const auto report = run("n.unseen");
  EXPECT_THAT(verdicts(report), ElementsAre("n.unseen inconclusive"));
  EXPECT_THAT(report.rows.front().actual, HasSubstr("want of a sign of life"));
}

TEST(ConformanceRun, SkipsWhatNeedsAHandAlsoIfItDidNotWatch) {
  NumberBench bench;
  bench.stops_left = 9;
  const auto report = run(bench, "n.skips", {.missed = [&bench] { return bench.missed; }});
  EXPECT_THAT(verdicts(report), ElementsAre("n.skips skipped"));
  EXPECT_EQ(report.rows.front().actual, "no hand");
}

TEST(ConformanceRun, LeavesACaseOpenThatItNeverWatches) {
  NumberBench bench;
  bench.stops_left = 100;
  EXPECT_THAT(verdicts(run(bench, "n.late", watching(bench))), ElementsAre("n.late inconclusive"));
  EXPECT_EQ(bench.ran.size(), 3U);
}

TEST(ConformanceRun, CountsFailuresThatItWatched) {
  NumberBench bench;
  bench.stops_left = 1;
  EXPECT_THAT(verdicts(run(bench, "n.late")), ElementsAre("n.late fail"));
  EXPECT_THAT(verdicts(run(bench, "n.fail", watching(bench))), ElementsAre("n.fail fail"));
}

TEST(ConformanceRun, TriesAStartStateAgainThatItDidNotWatch) {
  NumberBench bench;
  bench.stops_in_start = 1;
  EXPECT_THAT(verdicts(run(bench, "n.too", watching(bench))), ElementsAre("n.too pass"));
}

TEST(ConformanceRun, StopsAtTheFirstFailureIfAsked) {
  const auto report = run("n.f", {.stops_at_first_failure = true});
  EXPECT_THAT(verdicts(report),
              ElementsAre("n.fail fail", "n.flaky skipped", "n.firmware skipped"));
}

TEST(ConformanceRun, JudgesByTheProfileThatWasAskedFor) {
  EXPECT_THAT(verdicts(run("n.firmware")), ElementsAre("n.firmware pass"));
  EXPECT_THAT(verdicts(run("n.documented")), IsEmpty());
}

TEST(ConformanceRun, CallsADeviationWhatTheShippedDeviceIsKnownToDo) {
  const RunOptions documented{.profile = Profile::kDocumented};
  EXPECT_THAT(verdicts(run("n.documented", documented)), ElementsAre("n.documented deviation"));
  NumberBench other;
  other.obeys_firmware = false;
  EXPECT_THAT(verdicts(run(other, "n.documented", documented)), ElementsAre("n.documented fail"));
}

TEST(ConformanceRun, GivesACaseTheSameRandomBytesWhateverRunsBesideIt) {
  NumberBench alone;
  NumberBench among_others;
  NumberBench otherwise;
  (void)run(alone, "n.too");
  (void)run(among_others, "o");  // n.moves before it
  (void)run(otherwise, "n.too", {.seed = 2});
  EXPECT_EQ(among_others.ran.size(), 2U);
  EXPECT_EQ(alone.randoms.back(), among_others.randoms.back());
  EXPECT_NE(alone.randoms.back(), otherwise.randoms.back());
}

TEST(ConformanceRun, ExcusesWhatAWaiverNames) {
  const std::vector<Waiver> waivers{{"n.fail", "known since spring", {}}};
  const auto report = run("n.fail", {.waivers = waivers});
  EXPECT_THAT(verdicts(report), ElementsAre("n.fail deviation"));
  EXPECT_THAT(report.rows[0].actual, HasSubstr("known since spring"));
}

TEST(ConformanceRun, ReportsWaiversThatExcuseNothingInAFullRun) {
  const std::vector<Waiver> waivers{{"n.pass", "not needed any more", {}}};
  EXPECT_THAT(verdicts(run("", {.waivers = waivers})), testing::Contains("n.pass.waived error"));
  EXPECT_THAT(verdicts(run("n.pass", {.waivers = waivers})), ElementsAre("n.pass pass"));
}

}  // namespace
}  // namespace armjig
