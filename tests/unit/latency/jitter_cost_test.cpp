// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/jitter_cost.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "harness/latency/latency_run.hpp"
#include "tests/unit/report/validity.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

constexpr double kReach = 1'000;
/// Half of the reach, to and fro every two seconds.
constexpr double kFastest = kReach / 2 * std::numbers::pi;

/// A joint that is where the last set-point wanted it, at once.
class Jumper final : public Follower {
 public:
  [[nodiscard]] std::string_view unit() const noexcept override { return "steps"; }
  [[nodiscard]] double reach() const noexcept override { return kReach; }
  [[nodiscard]] Instant now() const override { return now_; }
  void wait_until(Instant time) override { now_ = std::max(now_, time); }
  [[nodiscard]] Result<double> lead(double position, double /*speed*/) override {
    return std::exchange(position_, position);
  }

 private:
  Instant now_{};
  double position_ = 0;
};

Outcome<std::unique_ptr<Follower>> make_jumper() { return std::make_unique<Jumper>(); }

Measured answers(Duration usual, std::uint64_t stalls = 0, Duration stall = 50ms) {
  Measured measured;
  measured.round_trips.record(usual, 1'000 - stalls);
  measured.round_trips.record(stall, stalls);
  return measured;
}

JitterCost cost(const Measured& measured, const JitterCostHow& how = {}) {
  return cost_of(measured, make_jumper, how).value();
}

TEST(JitterCost, OfSteadyDelaysIsTheirWay) {
  // When a set-point arrives, the joint stands where the one before wanted it to be: a period and
  // half a round trip ago.
  const auto none = cost(answers(0ns));
  EXPECT_NEAR(none.steady.most, kFastest * 0.010, 0.1);
  EXPECT_NEAR(none.measured.most, none.steady.most, 1e-9);
  const auto some = cost(answers(4ms));
  EXPECT_NEAR(some.steady.most, kFastest * 0.012, 0.1);
  EXPECT_NEAR(some.steady.rms, some.steady.most / std::numbers::sqrt2, 0.2);
}

TEST(JitterCost, GrowsWithStalls) {
  // One of a hundred takes 50 ms: 25 ms to the joint, and then four deadlines pass by.
  const auto stalled = cost(answers(1ms, 10));
  EXPECT_NEAR(stalled.steady.most, kFastest * 0.0105, 0.1);
  EXPECT_GT(stalled.measured.p99, 1.5 * stalled.steady.p99);
  EXPECT_NEAR(stalled.measured.most, kFastest * 0.060, kFastest * 0.012);
  EXPECT_NEAR(stalled.measured.skipped, 0.04, 0.02);
}

TEST(JitterCost, CountsHowLateRequestsLeave) {
  auto measured = answers(0ns);
  measured.lateness.record(5ms);
  EXPECT_NEAR(cost(measured).measured.most, kFastest * 0.015, 0.1);
}

TEST(JitterCost, NamesTheHighestRateThatKeepsItsDeadlinesAndTheLimit) {
  // An answer takes 4 ms, so 250 set-points a second are the most.
  EXPECT_EQ(cost(answers(4ms), {.limit = 1e6}).highest_rate, 200);
  EXPECT_EQ(cost(answers(0ns), {.limit = 1e6}).highest_rate, 1'000);
  EXPECT_EQ(cost(answers(0ns), {.limit = 0.1}).highest_rate, std::nullopt);
  EXPECT_EQ(cost(answers(0ns), {.rate = 130}).rates[4].rate, 130);
}

TEST(JitterCost, IsTheSameForTheSameSeed) {
  const auto measured = answers(1ms, 100, 15ms);
  const auto figures = [&measured](std::uint64_t seed) {
    const auto told = cost(measured, {.seed = seed}).measured;
    return std::array{told.rms, told.p99, told.most, told.skipped};
  };
  EXPECT_EQ(figures(7), figures(7));
  EXPECT_NE(figures(7), figures(8));
}

TEST(JitterCost, IsToldWhenTheDeviceEnds) {
  const auto ended = cost_of(answers(1ms),
                             []() -> Outcome<std::unique_ptr<Follower>> {
                               return problem(ErrorCode::kTimedOut, "bus", "nobody");
                             },
                             {});
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().where, "bus");
}

TEST(JitterCost, IsInReportAndJson) {
  LatencyRun run{.device = "jumper", .target = "emulated:", .measured = answers(1ms, 10)};
  run.cost = cost(run.measured, {.limit = 30});
  EXPECT_TRUE(test::is_valid_json(to_latency_json(run), "docs/schemas/latency.schema.json"));
  EXPECT_THAT(to_text(report_of(run)), testing::HasSubstr("keeps it below 30.0"));
}

}  // namespace
}  // namespace armjig
