// SPDX-License-Identifier: Apache-2.0
// The truth: a delay that is known is measured on virtual time, and has to come back.
#include "harness/latency/meter.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "harness/latency/latency_run.hpp"
#include "harness/link/memory_stream.hpp"
#include "tests/unit/latency/delayed_echo.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using test::DelayedEcho;

/// Values of that size are told apart by less than this.
constexpr double kResolution = 0.001;

bool never() { return false; }

struct Jig {
  explicit Jig(DelayedEcho::Delay delay) : port{DelayedEcho{std::move(delay)}} {}

  Measured measure(const MeterPlan& plan, std::uint64_t count) {
    Meter meter{*path, probe, plan, never};
    EXPECT_TRUE(meter.run({.count = count}).value());
    return meter.measured();
  }

  MemoryStream<DelayedEcho> port;
  test::EchoProbe probe;
  std::unique_ptr<Path> path = path_through(port);
};

void expect_about(Duration actual, Duration wanted) {
  const auto exact = static_cast<double>(wanted.count());
  EXPECT_NEAR(static_cast<double>(actual.count()), exact, exact * kResolution);
}

TEST(Meter, GivesAConstantDelayBack) {
  const auto measured = Jig{[](auto) { return 1'234'567ns; }}.measure({}, 1'000);
  EXPECT_EQ(measured.sent, 1'000U);
  EXPECT_EQ(measured.round_trips.count(), 1'000U);
  EXPECT_EQ(measured.round_trips.min(), 1'234'567ns);
  EXPECT_EQ(measured.round_trips.max(), 1'234'567ns);
  EXPECT_EQ(measured.lateness.max(), 0ns);
  EXPECT_EQ(measured.skipped + measured.lost + measured.surplus, 0U);
  const auto rows = percentiles_of(measured);
  EXPECT_EQ(rows.front().interval, (ConfidenceInterval{1'234'567ns, 1'234'567ns}));
}

TEST(Meter, GivesBothHumpsOfABimodalDelayBack) {
  // Of ten answers, three take 4 ms.
  const auto measured = Jig{[](auto n) { return n % 10 < 3 ? 4ms : 1ms; }}.measure({}, 10'000);
  expect_about(measured.round_trips.percentile(70), 1ms);
  expect_about(measured.round_trips.percentile(70.01), 4ms);
  expect_about(measured.round_trips.percentile(99.99), 4ms);
  EXPECT_EQ(measured.round_trips.counts()[LatencyHistogram::bucket_of(1ms)], 7'000U);
  EXPECT_EQ(measured.round_trips.counts()[LatencyHistogram::bucket_of(4ms)], 3'000U);
}

TEST(Meter, DoesNotHideAStallOfOneInAThousand) {
  const auto measured =
      Jig{[](auto n) { return n % 1'000 == 999 ? 50ms : 1ms; }}.measure({}, 10'000);
  // As they were: ten of 10,000. Corrected: each of these ten also stands for the four requests
  // that were due meanwhile, and would have waited 40, 30, 20 and 10 ms.
  EXPECT_EQ(measured.round_trips.counts()[LatencyHistogram::bucket_of(50ms)], 10U);
  EXPECT_EQ(measured.corrected.count(), 10'040U);
  for (const auto late : {10ms, 20ms, 30ms, 40ms, 50ms}) {
    EXPECT_EQ(measured.corrected.counts()[LatencyHistogram::bucket_of(late)], 10U);
  }
  EXPECT_EQ(measured.skipped, 9 * 4U) << "after the last one nobody looks";
  EXPECT_EQ(measured.round_trips.max(), 50ms);
  expect_about(measured.round_trips.percentile(99.9), 1ms);
  expect_about(measured.corrected.percentile(99.9), 40ms);
  ASSERT_EQ(measured.outliers.size(), Meter::kOutliers);
  for (const auto& outlier : measured.outliers) EXPECT_EQ(outlier.trip.duration, 50ms);
}

TEST(Meter, GivesADriftBack) {
  const auto measured = Jig{[](auto n) { return 1ms + Duration{n * 100}; }}.measure({}, 10'000);
  for (const int percent : {1, 25, 50, 75, 99}) {
    expect_about(measured.round_trips.percentile(percent), 1ms + Duration{percent * 10'000});
  }
}

TEST(Meter, KeepsTheLastEventsAroundTheWorst) {
  const auto measured = Jig{[](auto n) { return n == 50 ? 7ms : 1ms; }}.measure({}, 100);
  const auto& worst = measured.outliers.front();
  EXPECT_EQ(worst.trip.duration, 7ms);
  ASSERT_EQ(worst.event_count, Outlier::kEvents);
  using Kind = MeterEvent::Kind;
  const std::array kinds{Kind::kDue, Kind::kSent, Kind::kCame, Kind::kAnswered};
  for (std::size_t i = 0; i < Outlier::kEvents; ++i) {
    EXPECT_EQ(worst.events[i].kind, kinds[i % kinds.size()]);
  }
  EXPECT_EQ(worst.events.back().time, worst.trip.sent + 7ms);
}

TEST(Meter, CountsWhatIsLostAndTakesNoLateAnswerForAnothers) {
  // The answer to the fifth comes after it was given up, that to the eighth never.
  const auto measured = Jig{[](auto n) -> std::optional<Duration> {
                          if (n == 7) return std::nullopt;
                          return n == 4 ? 1'050ms : 1ms;
                        }}.measure({}, 20);
  EXPECT_EQ(measured.lost, 2U);
  EXPECT_EQ(measured.surplus, 1U);
  EXPECT_EQ(measured.round_trips.count(), 18U);
  EXPECT_EQ(measured.round_trips.max(), 1ms);
}

TEST(Meter, SendsBurstsAndMatchesAnswersInTheirOrder) {
  const auto measured = Jig{[](auto n) { return (n % 4 + 1) * 1ms; }}.measure({.burst = 4}, 400);
  EXPECT_EQ(measured.round_trips.count(), 400U);
  for (const auto time : {1ms, 2ms, 3ms, 4ms}) {
    EXPECT_EQ(measured.round_trips.counts()[LatencyHistogram::bucket_of(time)], 100U);
  }
}

TEST(Meter, AsksAtOnceInAClosedLoop) {
  Jig jig{[](auto) { return 2ms; }};
  const auto measured = jig.measure({.period = std::nullopt}, 500);
  EXPECT_EQ(measured.time, 1s);
  EXPECT_EQ(measured.lateness.count(), 0U);
  EXPECT_EQ(measured.corrected.count(), 500U);
}

TEST(Meter, EndsWhenSomebodyWantsItAndKeepsWhatItHas) {
  Jig jig{[](auto) { return 1ms; }};
  int asked = 0;
  Meter meter{*jig.path, jig.probe, {}, [&asked] { return ++asked > 100; }};
  EXPECT_FALSE(meter.run({}).value());
  EXPECT_GT(meter.measured().round_trips.count(), 10U);
}

TEST(Meter, CountsNoDeadlineAfterItsEnd) {
  // The ninth answer comes 40 ms after the last of ten deadlines.
  Jig jig{[](auto n) { return n == 8 ? 50ms : 1ms; }};
  Meter meter{*jig.path, jig.probe, {}, never};
  EXPECT_TRUE(meter.run({.time = 100ms}).value());
  EXPECT_EQ(meter.measured().sent, 9U);
  EXPECT_EQ(meter.measured().skipped, 1U);
}

TEST(Meter, EndsAfterTheTimeThatWasGiven) {
  Jig jig{[](auto) { return 1ms; }};
  Meter meter{*jig.path, jig.probe, {}, never};
  EXPECT_TRUE(meter.run({.time = 2s}).value());
  EXPECT_EQ(meter.measured().sent, 200U);
}

}  // namespace
}  // namespace armjig
