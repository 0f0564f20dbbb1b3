// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/sending.hpp"

#include <gtest/gtest.h>

#include "harness/latency/latency_run.hpp"
#include "harness/link/memory_stream.hpp"
#include "tests/unit/latency/delayed_echo.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

constexpr SendingPlan kPlan{.count = 20, .period = 10ms, .patience = 1s};

bool goes_on() { return false; }

/// A port whose kernel says that each message left after that time.
class StampedPath final : public Path {
 public:
  StampedPath(StreamPort& port, std::optional<Duration> stamp)
      : port_{path_through(port)}, stamp_{stamp} {}

  Instant now() const override { return port_->now(); }
  Result<Arrival> drain(std::span<std::byte> into) override { return port_->drain(into); }
  Result<void> send(Bytes message) override { return port_->send(message); }
  Result<std::optional<Duration>> time_send(Bytes message) override {
    return send(message).map([this] { return stamp_; });
  }
  Result<Arrival> receive(std::span<std::byte> into, Instant deadline) override {
    return port_->receive(into, deadline);
  }
  std::string_view name() const noexcept override { return "stamped"; }

 private:
  std::unique_ptr<Path> port_;
  std::optional<Duration> stamp_;
};

struct Asked {
  LatencyHistogram taken;
  std::vector<Instant> requests;
};

Asked ask(std::optional<Duration> stamp, std::optional<Duration> delay,
          const std::function<bool()>& must_end = goes_on) {
  Asked asked;
  MemoryStream<test::DelayedEcho>* clock = nullptr;
  MemoryStream<test::DelayedEcho> port{test::DelayedEcho{[&](std::uint64_t) {
    asked.requests.push_back(clock->now());
    return delay;
  }}};
  clock = &port;
  StampedPath path{port, stamp};
  test::EchoProbe probe;
  asked.taken = time_sending(path, probe, kPlan, must_end).value();
  return asked;
}

TEST(TimeSending, AsksTheKernelOfEachRequestInTheRunsPeriod) {
  const auto asked = ask(7us, 2ms);
  EXPECT_EQ(asked.taken.count(), 20U);
  EXPECT_EQ(asked.taken.min(), 7us);
  EXPECT_EQ(asked.taken.max(), 7us);
  ASSERT_EQ(asked.requests.size(), 20U);
  EXPECT_EQ(asked.requests[19] - asked.requests[0], 190ms);
}

TEST(TimeSending, WaitsForEachAnswerAndNoLongerThanItMay) {
  EXPECT_EQ(ask(7us, 25ms).requests[1], at(25ms));
  EXPECT_EQ(ask(7us, std::nullopt).requests[1], at(1s));
}

TEST(TimeSending, EndsWhereNobodyTells) {
  const auto asked = ask(std::nullopt, 2ms);
  EXPECT_EQ(asked.taken.count(), 0U);
  EXPECT_EQ(asked.requests.size(), 1U);
}

TEST(TimeSending, EndsWhenItMust) {
  int left = 30;
  EXPECT_LT(ask(7us, 2ms, [&] { return left-- <= 0; }).requests.size(), 20U);
}

TEST(TimeSending, IsAShareOfItsOwn) {
  LatencyRun run;
  run.measured.round_trips.record(100us, 10);
  for (int i = 0; i < 10; ++i)
    run.measured.trips.push_back({.sent = at(i * 10ms), .duration = 100us});
  run.sending.emplace().record(8us, 10);
  const auto shares = shares_of(run);
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_EQ(shares[0].of, "host, sending");
  EXPECT_EQ(shares[0].median, 8us);
  EXPECT_EQ(shares[1].of, "device or link");
  EXPECT_EQ(shares[1].median, 92us);
}

}  // namespace
}  // namespace armjig
