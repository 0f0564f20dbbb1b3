// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/paced_clock.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace armjig {
namespace {

using namespace std::chrono_literals;

constexpr PacedClock::Wall::time_point kStart{1h};

TEST(PacedClock, StartsAtZero) { EXPECT_EQ(PacedClock(1, kStart).virtual_time(kStart), at(0ns)); }

TEST(PacedClock, RunsAtItsSpeed) {
  EXPECT_EQ(PacedClock(1, kStart).virtual_time(kStart + 10ms), at(10ms));
  EXPECT_EQ(PacedClock(50, kStart).virtual_time(kStart + 10ms), at(500ms));
  EXPECT_EQ(PacedClock(0.5, kStart).virtual_time(kStart + 10ms), at(5ms));
}

TEST(PacedClock, KnowsWhenAnInstantComes) {
  const PacedClock clock{10, kStart};
  EXPECT_EQ(clock.wall_time(at(1s), kStart), kStart + 100ms);
  EXPECT_EQ(clock.wall_time(at(1s), kStart + 60ms), kStart + 100ms);
}

TEST(PacedClock, NamesThePastForAnInstantThatIsOverdue) {
  const PacedClock clock{1, kStart};
  EXPECT_LE(clock.wall_time(at(1s), kStart + 2s), kStart + 2s);
}

TEST(PacedClock, NeverWaitsBeyondAnHour) {
  const PacedClock clock{PacedClock::kSlowest, kStart};
  EXPECT_EQ(clock.wall_time(Instant::max(), kStart), kStart + 1h);
}

TEST(PacedClock, GoesBackByWhatItLoses) {
  PacedClock clock{2, kStart};
  clock.lose(3s);
  EXPECT_EQ(clock.virtual_time(kStart + 10s), at(17s));
  EXPECT_EQ(clock.wall_time(at(17s), kStart + 9s), kStart + 10s);
  EXPECT_EQ(clock.lost(), 3s);
}

TEST(PacedClock, RefusesSpeedsThatAreNone) {
  EXPECT_TRUE(PacedClock::is_speed(1));
  EXPECT_FALSE(PacedClock::is_speed(0));
  EXPECT_FALSE(PacedClock::is_speed(-1));
  EXPECT_FALSE(PacedClock::is_speed(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(PacedClock::is_speed(std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace armjig
