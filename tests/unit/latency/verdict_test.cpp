// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emulators/parol6/arm.hpp"
#include "harness/latency/latency_run.hpp"
#include "harness/latency/load.hpp"
#include "harness/latency/parol6_probe.hpp"
#include "harness/link/impaired_stream.hpp"
#include "harness/link/memory_stream.hpp"
#include "harness/timing/histogram_log.hpp"
#include "tests/unit/latency/delayed_echo.hpp"
#include "tests/unit/latency/slices.hpp"
#include "tests/unit/report/validity.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

bool is_kept(std::string_view limit, const Measured& measured) {
  return check(parse_limits(limit).value().front(), measured).is_kept;
}

/// 99 answers after 1 ms, one after 5 ms.
Measured hundred() {
  Measured measured;
  measured.corrected.record(1ms, 99);
  measured.corrected.record(5ms);
  return measured;
}

TEST(Limit, IsKeptBelowAndBrokenAt) {
  EXPECT_TRUE(is_kept("p99<1.002ms", hundred()));
  EXPECT_FALSE(is_kept("p99<1ms", hundred()));
  EXPECT_FALSE(is_kept("p99.5<2ms", hundred()));
  EXPECT_TRUE(is_kept("max<5.1ms", hundred()));
  EXPECT_FALSE(is_kept("max<5ms", hundred()));
  EXPECT_TRUE(is_kept("mean<1041us", hundred()));
  EXPECT_FALSE(is_kept("mean<1040us", hundred()));
}

TEST(Limit, CountsALostAnswerAsLongerThanAny) {
  auto measured = hundred();
  measured.lost = 2;  // of 102: the last 1.96 %
  EXPECT_TRUE(is_kept("p98<6ms", measured));
  EXPECT_FALSE(is_kept("p99<1s", measured));
  EXPECT_FALSE(is_kept("max<10s", measured));
  EXPECT_FALSE(is_kept("mean<10s", measured));
  EXPECT_FALSE(is_kept("lost<2", measured));
  EXPECT_TRUE(is_kept("lost<3", measured));
}

TEST(Limit, OfNoAnswerAtAllIsNotKept) {
  EXPECT_FALSE(is_kept("max<10s", {}));
  EXPECT_FALSE(is_kept("mean<10s", {}));
  EXPECT_FALSE(is_kept("p50<10s", {}));
}

TEST(Limit, RefusesWhatIsNone) {
  for (const auto* text :
       {"", "p99", "p99<", "p99<2", "p0<1ms", "p101<1ms", "max<-1ms", "max<nanms", "lost<1ms",
        "p99>1ms", "p99<1ms,", "mode<1ms", "p99x<1ms"}) {
    EXPECT_FALSE(parse_limits(text)) << text;
  }
  EXPECT_EQ(parse_limits("p99.9<2ms,lost<1")->size(), 2U);
}

TEST(LoadPlan, IsReadOrRefused) {
  const auto plan = parse_load("io=1,cpu=2").value();
  EXPECT_EQ(plan.cpu, 2U);
  EXPECT_EQ(plan.io, 1U);
  for (const auto* text :
       {"", "cpu", "cpu=", "cpu=0", "cpu=65", "cpu=1,cpu=1", "gpu=1", "cpu=1,"}) {
    EXPECT_FALSE(parse_load(text)) << text;
  }
}

// Two echoes on virtual time, whose delays waver by a third: dice with a fixed seed.

std::vector<Slice> slices_of(std::uint64_t seed, double slower, Duration added) {
  test::Dice dice{seed};
  return test::slices_of(240, [&](auto) {
    const auto delay = static_cast<double>(dice.between(800'000, 1'200'000)) * slower;
    return Duration{static_cast<Duration::rep>(delay)} + added;
  });
}

TEST(Against, FlagsATenthAndTwentyMicrosecondsMoreAndNotTheSame) {
  const auto first = slices_of(1, 1, 0ns);
  const auto verdict = [&first](const std::vector<Slice>& second) {
    return compare_alternated(first, second, 1).difference;
  };
  EXPECT_EQ(verdict(slices_of(2, 1, 0ns)), Difference::kNone);
  EXPECT_EQ(verdict(slices_of(3, 1.1, 0ns)), Difference::kSlower);
  EXPECT_EQ(verdict(slices_of(4, 1, 20us)), Difference::kSlower);
  EXPECT_EQ(verdict(slices_of(5, 0.9, 0ns)), Difference::kFaster);
  EXPECT_EQ(compare_alternated(std::span{first}.first(9), first, 1).difference,
            Difference::kUnclear);
}

TEST(Against, FlagsTwentyMicrosecondsAlsoIfTheMachineWasBusyInAFewSlices) {
  auto first = slices_of(1, 1, 0ns);
  auto second = slices_of(2, 1, 20us);
  auto same = slices_of(3, 1, 0ns);
  for (const std::size_t i : {5U, 17U, 40U}) {
    first[i] = {3ms, 4ms};
    same[i + 1] = second[i + 1] = {2ms, 3ms};
  }
  EXPECT_EQ(compare_alternated(first, second, 1).difference, Difference::kSlower);
  EXPECT_EQ(compare_alternated(first, same, 1).difference, Difference::kNone);
}

LatencyRun run_of(Duration delay) {
  MemoryStream<test::DelayedEcho> port{test::DelayedEcho{[delay](auto) { return delay; }}};
  test::EchoProbe probe;
  const auto path = path_through(port);
  Meter meter{*path, probe, {}, [] { return false; }};
  EXPECT_TRUE(meter.run({.count = 300}).value());
  return {.device = "echo", .target = "emulated:", .measured = meter.measured()};
}

TEST(LatencyJson, IsABaselineForTheNextRun) {
  const auto baseline = parse_baseline(to_latency_json(run_of(2ms)), "file").value();
  EXPECT_EQ(baseline.median, 2ms);
  const auto compare = [&baseline](Duration delay) {
    const auto measured = run_of(delay).measured;
    const auto median = percentiles_of(measured).front().raw;
    return compare_with(baseline, median, noise_floor_of(measured).value()).difference;
  };
  EXPECT_EQ(compare(2ms), Difference::kNone);
  EXPECT_EQ(compare(2200us), Difference::kSlower);
  EXPECT_EQ(compare(1800us), Difference::kFaster);
}

TEST(LatencyJson, IsABaselineThatKnowsHowItsRunDrifted) {
  const auto measured_of = [](Duration drift) {
    Measured measured;
    for (int i = 0; i < 1'000; ++i) {
      measured.trips.push_back({.sent = at(i * 10ms), .duration = 2ms + i * drift});
      measured.round_trips.record(measured.trips.back().duration);
    }
    return measured;
  };
  const auto steady = measured_of(0ns);
  const auto drifting = measured_of(400ns);
  const auto flagged = [](const Measured& first, Duration second) {
    const LatencyRun run{.device = "echo", .target = "emulated:", .measured = first};
    const auto baseline = parse_baseline(to_latency_json(run), "file").value();
    return compare_with(baseline, second, {second - 1us, second + 1us}).difference;
  };
  EXPECT_EQ(flagged(steady, 2050us), Difference::kSlower);
  EXPECT_EQ(flagged(drifting, 2450us), Difference::kNone) << "the run itself came as far";
  EXPECT_EQ(flagged(drifting, 2600us), Difference::kSlower);
}

TEST(LatencyJson, IsValidAgainstItsSchema) {
  auto run = run_of(2ms);
  run.limits = {check(parse_limits("p99<1ms").value().front(), run.measured)};
  run.figures = {{"clock", 0.5, "%", "arithmetic"}};
  const std::vector<Slice> slices(12, Slice{1ms, 1ms});
  run.comparison = compare_alternated(slices, slices, 1);
  EXPECT_TRUE(test::is_valid_json(to_latency_json(run), "docs/schemas/latency.schema.json"));
  EXPECT_TRUE(
      test::is_valid_json(to_latency_json(LatencyRun{}), "docs/schemas/latency.schema.json"));
  run.started = std::chrono::sys_seconds{};
  run.witness.emplace();
  run.privileges = {{"memory", true, "locked"}};
  EXPECT_TRUE(test::is_valid_json(to_latency_json(run), "docs/schemas/latency.schema.json"));
}

TEST(LatencyJson, IsRefusedAsABaselineWhenSomethingIsMissing) {
  for (const auto* text :
       {"", "[]", "{}", R"({"schema": 5})", R"({"schema": "armjig.report/1"})",
        R"({"schema": "armjig.latency/1"})",
        R"({"schema": "armjig.latency/1", "round_trip": {"percentiles": []}})"}) {
    EXPECT_FALSE(parse_baseline(text, "file")) << text;
  }
}

TEST(LatencyLog, HasBothFigures) {
  const auto log = parse_histogram_log(to_latency_log(run_of(2ms))).value();
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[0].tag, "raw");
  EXPECT_EQ(log[1].tag, "corrected");
  EXPECT_EQ(log[0].histogram.count(), 300U);
}

TEST(Blame, IsTheHostsIfTheSentinelOversleptInThatStretch) {
  auto run = run_of(1ms);
  run.started = std::chrono::sys_seconds{};
  const Outlier outlier{.trip = {.sent = at(1s), .duration = 101ms}};
  run.witness.emplace();
  EXPECT_THAT(blame_of(outlier, run), HasSubstr("device or link"));
  run.witness->oversleeps = {{at(500ms), 100ms}};
  EXPECT_THAT(blame_of(outlier, run), HasSubstr("device or link")) << "that was before";
  run.witness->oversleeps = {{at(1001ms), 99ms}};
  EXPECT_THAT(blame_of(outlier, run), testing::StartsWith("host"));
}

/// Whom the worst is blamed on, of a board whose link stands still for 5 ms now and then.
std::string blamed_behind(const char* impairment) {
  ImpairedStream port{
      std::make_unique<MemoryStream<parol6::emulation::Arm>>(parol6::emulation::Arm{}),
      parse_impairment(impairment).value()};
  const auto probe = parol6::latency::make_probe(port, "").value();
  const auto path = path_through(port);
  Meter meter{*path, *probe, {}, [] { return false; }};
  EXPECT_TRUE(meter.run({.count = 1'000}).value());
  LatencyRun run{.measured = meter.measured()};
  EXPECT_GT(run.measured.outliers.front().trip.duration, 5ms);
  return blame_of(run.measured.outliers.back(), run);
}

TEST(Blame, TellsTheWayToADeviceThatCountsTimeFromAllElse) {
  EXPECT_THAT(blamed_behind("out.stall=1%:5ms,seed=4"), testing::StartsWith("link"));
  EXPECT_THAT(blamed_behind("in.stall=1%:5ms,seed=4"),
              testing::StartsWith("device, or the link from it"));
}

TEST(LatencyReport, OpensTheWorstFromTheirDots) {
  auto first = run_of(2ms);
  first.name = "rate=50";
  auto second = run_of(1ms);
  second.name = "rate=100";
  const auto one = to_html(report_of(run_of(2ms)));
  const auto both = to_html(report_of(std::vector{first, second}));
  for (const auto* row : {"worst-1", "worst-5"}) {
    EXPECT_THAT(one, HasSubstr(fmt::format("href=\"#{}\"", row)));
    EXPECT_THAT(one, HasSubstr(fmt::format("<tr id=\"{}\">", row)));
  }
  for (const auto* row : {"worst-rate-50-1", "worst-rate-100-5"}) {
    EXPECT_THAT(both, HasSubstr(fmt::format("href=\"#{}\"", row)));
    EXPECT_THAT(both, HasSubstr(fmt::format("<tr id=\"{}\">", row)));
  }
}

TEST(LatencyReport, HasTheVerdictInItsFirstLines) {
  auto run = run_of(2ms);
  run.limits = {check(parse_limits("p99<1ms").value().front(), run.measured)};
  const auto text = to_text(report_of(run));
  EXPECT_LT(text.find("FAIL"), text.find("Round trips"));
  EXPECT_THAT(text, HasSubstr("2.000 ms"));
  EXPECT_EQ(conclusion_of(report_of(run)), Conclusion::kFindings);
}

TEST(LatencyReport, HasSeveralRunsSideBySide) {
  std::vector<LatencyRun> runs{run_of(2ms), run_of(3ms)};
  runs[0].name = "rate=50";
  runs[1].name = "rate=100";
  runs[1].limits = {check(parse_limits("p99<1ms").value().front(), runs[1].measured)};
  const auto report = report_of(runs);
  EXPECT_EQ(report.sections.front().table.rows.size(), 2U);
  EXPECT_EQ(report.sections.front().plots.front().series.size(), 2U);
  EXPECT_EQ(report.rows.front().name, "limit.p99<1ms.rate=100");
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
  EXPECT_TRUE(test::is_valid_json(to_latency_json(runs), "docs/schemas/latency-runs.schema.json"));
}

}  // namespace
}  // namespace armjig
