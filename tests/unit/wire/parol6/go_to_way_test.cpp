// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/go_to_way.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace armjig::parol6 {
namespace {

using namespace std::chrono_literals;

/// Each joint may go 10 steps in 10 ms, and so be told 20 steps at once.
constexpr GoToWay::Limits kTop{StepsPerSecond{1000}, StepsPerSecond{1000}, StepsPerSecond{1000},
                               StepsPerSecond{1000}, StepsPerSecond{1000}, StepsPerSecond{1000}};

/// Joint 1 is led; it stands at 0 before.
class Led {
 public:
  bool to(Duration time, std::int32_t place, std::int32_t speed = 0) {
    CommandFrame frame{.command = Command::kGoTo};
    frame.position[0] = Steps{place};
    frame.speed[0] = StepsPerSecond{speed};
    return way.go_on(Instant{} + time, frame, {}).empty();
  }

  GoToWay way{kTop};
};

JointSteps seen_at(std::int32_t place) { return {Steps{place}}; }

TEST(GoToWay, BeginsWithinReachOfTheTopSpeed) {
  EXPECT_TRUE(Led{}.to(0ms, 20)) << "the board closes it at 50 times 20 steps a second";
  EXPECT_FALSE(Led{}.to(0ms, 21));
  EXPECT_TRUE(Led{}.to(0ms, -10, -1000)) << "and counts half of the speed";
  EXPECT_FALSE(Led{}.to(0ms, -10, -1100));
}

TEST(GoToWay, GoesOnAtTopSpeedWhereverTelemetryIs) {
  Led led;
  for (int i = 1; i <= 1000; ++i) ASSERT_TRUE(led.to(i * 10ms, 10 * i, 1000)) << i;
}

TEST(GoToWay, ForgivesALateFrameAndALostOne) {
  Led led;
  for (int i = 1; i <= 1000; ++i) {
    const auto late = i % 7 == 0 ? 9ms : 0ms;
    ASSERT_TRUE(i % 49 == 25 || led.to(i * 10ms + late, 10 * i)) << i;
  }
}

TEST(GoToWay, DoesNotGoOnFasterThanThat) {
  Led led;
  int allowed = 0;
  while (allowed < 100 && led.to((allowed + 1) * 10ms, 12 * (allowed + 1))) ++allowed;
  EXPECT_LT(allowed, 10) << "a fifth too fast";
}

TEST(GoToWay, MakesNoLeapOnTheWay) {
  Led led;
  for (int i = 1; i <= 20; ++i) ASSERT_TRUE(led.to(i * 10ms, i));
  EXPECT_FALSE(led.to(210ms, 45));
  EXPECT_TRUE(led.to(220ms, 46)) << "told once";
}

TEST(GoToWay, CannotBeHurriedByMoreFrames) {
  Led led;
  int allowed = 0;
  while (allowed < 100 && led.to((allowed + 1) * 5ms, 10 * (allowed + 1))) ++allowed;
  EXPECT_LT(allowed, 10);
}

TEST(GoToWay, BeginsAgainAtTelemetryAfterAnotherCommand) {
  Led led;
  for (int i = 1; i <= 20; ++i) ASSERT_TRUE(led.to(i * 10ms, 10 * i));
  led.way.end();
  EXPECT_FALSE(led.to(210ms, 210)) << "telemetry says 0";
}

TEST(GoToWay, KnowsTheWayBackFromBeyondTheBounds) {
  constexpr JointBounds kBounds{Steps{0}, Steps{100}};
  const GoToWay way{kTop};
  const auto leads_out = [&](std::int32_t place, std::int32_t known) {
    return way.leads_out(0, kBounds, Steps{place}, Steps{known});
  };
  EXPECT_FALSE(leads_out(100, 50));
  EXPECT_TRUE(leads_out(101, 50));
  EXPECT_FALSE(leads_out(120, 130)) << "back";
  EXPECT_FALSE(leads_out(130, 130)) << "stays";
  EXPECT_TRUE(leads_out(131, 130)) << "further out";
  EXPECT_TRUE(leads_out(-1, 130)) << "and out at the other end";
}

TEST(GoToWay, AJointThatFollowsLateIsNoStray) {
  Led led;
  for (int i = 1; i <= 100; ++i) {
    ASSERT_TRUE(led.to(i * 10ms, 10 * i));
    ASSERT_FALSE(led.way.stray(Instant{} + i * 10ms, seen_at(std::max(0, 10 * (i - 8))))) << i;
  }
}

TEST(GoToWay, AJointThatStandsOrLeavesIsAStray) {
  Led led;
  for (int i = 1; i <= 100; ++i) ASSERT_TRUE(led.to(i * 10ms, 10 * i));
  const auto now = Instant{} + 1s;
  EXPECT_EQ(led.way.stray(now, seen_at(0)), 0U);
  EXPECT_EQ(led.way.stray(now, seen_at(1100)), 0U);
  EXPECT_FALSE(led.way.stray(now, seen_at(1000)));
  led.way.end();
  EXPECT_FALSE(led.way.stray(now, seen_at(0))) << "nobody leads it";
}

TEST(GoToWay, SaysWhatWasAsked) {
  EXPECT_EQ(describe({0, 131, std::nullopt}), "go 131 steps at once, which is 6550 steps/s");
  EXPECT_EQ(describe({0, 181, 10ms}), "go 181 steps 10.0 ms after the frame before");
}

}  // namespace
}  // namespace armjig::parol6
