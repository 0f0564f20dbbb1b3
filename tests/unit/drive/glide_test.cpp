// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/glide.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

namespace armjig::parol6::drive {
namespace {

using namespace std::chrono_literals;

constexpr JointSteps kStart{Steps{0}, Steps{-1000}, Steps{0}, Steps{5}, Steps{0}, Steps{0}};
constexpr JointSteps kGoal{Steps{3000}, Steps{-1001}, Steps{0}, Steps{-5}, Steps{0}, Steps{700}};

JointSpeeds all_at(std::int32_t speed) {
  JointSpeeds speeds;
  speeds.fill(StepsPerSecond{speed});
  return speeds;
}

TEST(Glide, TakesAsLongAsItsSlowestJoint) {
  // The peak is 1.5 times the mean speed: 3000 steps at 1000 steps/s take 4.5 s.
  EXPECT_EQ((Glide{kStart, kGoal, all_at(1000)}.duration()), 4500ms);
  auto speeds = all_at(1000);
  speeds[5] = StepsPerSecond{100};  // 700 steps: 10.5 s
  EXPECT_EQ((Glide{kStart, kGoal, speeds}.duration()), 10500ms);
}

TEST(Glide, BeginsAndEndsInPlace) {
  const Glide glide{kStart, kGoal, all_at(1000)};
  EXPECT_EQ(glide.at(0ns).position, kStart);
  EXPECT_EQ(glide.at(0ns).feed, JointSpeeds{});
  for (const Duration time : {Duration{4500ms}, Duration{1h}}) {
    EXPECT_EQ(glide.at(time).position, kGoal);
    EXPECT_EQ(glide.at(time).feed, JointSpeeds{});
  }
}

TEST(Glide, NeverGoesFasterThanItMayNorBack) {
  const Glide glide{kStart, kGoal, all_at(1000)};
  auto before = glide.at(0ns);
  for (Duration time = 10ms; time <= glide.duration(); time += 10ms) {
    const auto now = glide.at(time);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto way = (now.position[j] - before.position[j]).value;
      const auto whole = (kGoal[j] - kStart[j]).value;
      EXPECT_LE(std::abs(way), 11) << "10 steps in 10 ms, and one of rounding";
      EXPECT_LE(std::abs(now.feed[j].value), 1000);
      EXPECT_GE(way * whole, 0) << "the right way";
    }
    before = now;
  }
}

TEST(Glide, WithoutAWayToGoIsOverAtOnce) {
  const Glide glide{kStart, kStart, {}};
  EXPECT_EQ(glide.duration(), 0ns);
  EXPECT_EQ(glide.at(0ns).position, kStart);
}

}  // namespace
}  // namespace armjig::parol6::drive
