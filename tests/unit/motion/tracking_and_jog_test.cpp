// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "harness/arm/models.hpp"
#include "harness/motion/parol6/cartesian_jog.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/tracking.hpp"
#include "tests/unit/support/allocations.hpp"

namespace armjig::parol6::planning {
namespace {

TEST(Tracking, AveragesTheSpeedAndThatWhichClosesTheDistanceInATick) {
  // Measured at the board, counters at 0: targets, speeds, and the speeds that it set.
  constexpr std::array kPositions{100, -100, 1, -1, 3, 0};
  constexpr std::array kSpeeds{200, -200, 0, 0, -1, 0};
  constexpr std::array kSet{5100, -5100, 50, -50, 149, 0};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto set = tracking_speed(Tracking::kSpeedAndPosition, Steps{kPositions[j]},
                                    StepsPerSecond{kSpeeds[j]}, Steps{0});
    EXPECT_EQ(set.value, kSet[j]) << "j" << j + 1;
  }
}

TEST(Tracking, OfSpeedsOnlyIsTheSpeed) {
  EXPECT_EQ(tracking_speed(Tracking::kSpeed, Steps{100}, StepsPerSecond{7}, Steps{0}).value, 7);
}

TEST(Tracking, LagsOneTickBehindARightSpeed) {
  constexpr double kSpeed = 1000;  // steps/s, at which a set-point runs away
  double place = 0;
  double target = 0;
  for (int tick = 0; tick < 100; ++tick) {
    target += kSpeed * kTick;
    place += kTick * tracking_speed(Tracking::kSpeedAndPosition, Steps{cut_off(target)},
                                    StepsPerSecond{1000}, Steps{cut_off(place)})
                         .value;
  }
  EXPECT_NEAR(target - place, 0, 1);  // at the tick's end; within it the lag is a tick
}

JointSteps bent_pose() {
  JointSteps steps;
  const arm::SixJoints degrees{20, -80, 170, 10, 40, 180};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    steps[j] = Steps{nearest_step(steps_of_degrees(j, degrees[j]))};
  }
  return steps;
}

/// The tool after a second of these speeds, and before.
struct Journey {
  arm::Pose before{};
  arm::Pose after{};
};
Journey jogged(const CartesianJog& jog, JointSteps start) {
  const CartesianJogger jogger;
  const auto arm = arm::parol6_commander();
  auto joints = radians_of(start);
  const auto before = forward(arm, joints);
  for (int tick = 0; tick < 100; ++tick) {
    JointSteps now;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      now[j] = Steps{nearest_step(steps_of_radians(j, joints[j]))};
    }
    const auto speeds = jogger.speeds(jog, now);
    EXPECT_TRUE(speeds.has_value()) << describe(speeds.error());
    if (!speeds) break;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      joints[j] += (*speeds)[j].value * kTick / steps_of_radians(j, 1);
    }
  }
  return {before, forward(arm, joints)};
}

TEST(CartesianJog, MovesTheToolAlongTheWorldsAxes) {
  for (const arm::Vector3 way : {arm::Vector3{0.02, 0, 0}, {0, 0.02, 0}, {0, 0, -0.02}}) {
    const auto [before, after] = jogged({JogFrame::kWorld, {.linear = way}}, bent_pose());
    EXPECT_LT(norm(after.position - before.position - way), 1e-3);
    EXPECT_LT(angle_between(before.rotation, after.rotation), 0.01);
  }
}

TEST(CartesianJog, MovesTheToolAlongItsOwnAxes) {
  const auto [before, after] = jogged({JogFrame::kTool, {.linear = {0, 0, 0.02}}}, bent_pose());
  const auto way = 0.02 * before.rotation.z_axis();
  EXPECT_LT(norm(after.position - before.position - way), 1e-3);
}

TEST(CartesianJog, TurnsTheToolWhereItIs) {
  for (const auto frame : {JogFrame::kWorld, JogFrame::kTool}) {
    const auto [before, after] = jogged({frame, {.angular = {0, 0, 0.1}}}, bent_pose());
    EXPECT_LT(norm(after.position - before.position), 1e-3);
    const auto turn = frame == JogFrame::kWorld ? after.rotation * inverse(before.rotation)
                                                : inverse(before.rotation) * after.rotation;
    EXPECT_LT(norm(rotation_vector(turn) - arm::Vector3{0, 0, 0.1}), 0.01);
  }
}

TEST(CartesianJog, IsRefusedAtALimit) {
  auto start = bent_pose();
  start[0] = Steps{14000};
  const CartesianJogger jogger;
  const auto arm = arm::parol6_commander();
  const auto around = arm::rotation_z(1.5707963) * forward(arm, radians_of(start)).position;
  const CartesianJog outward{JogFrame::kWorld, {.linear = {around.x / 20, around.y / 20, 0}}};
  const auto refusal = jogger.speeds(outward, start);
  ASSERT_FALSE(refusal.has_value());
  EXPECT_EQ(refusal.error().reason, Refusal::Reason::kOutOfLimits);
  EXPECT_EQ(refusal.error().joint, 0U);
}

TEST(CartesianJog, IsRefusedWhereTheToolCannotMoveThatWay) {
  const auto refusal = CartesianJogger{}.speeds({JogFrame::kWorld, {.angular = {0, 0, 0.1}}},
                                                kStandby);  // the wrist is straight there
  ASSERT_FALSE(refusal.has_value());
  EXPECT_EQ(refusal.error().reason, Refusal::Reason::kSingular);
}

TEST(CartesianJog, IsRefusedTooFast) {
  const auto refusal =
      CartesianJogger{}.speeds({JogFrame::kWorld, {.linear = {0, 0, 0.5}}}, bent_pose());
  ASSERT_FALSE(refusal.has_value());
  EXPECT_EQ(refusal.error().reason, Refusal::Reason::kTooFast);
}

TEST(CartesianJog, TakesNothingFromTheHeap) {
  const CartesianJogger jogger;
  const auto start = bent_pose();
  const auto before = test::allocations();
  const auto speeds = jogger.speeds({JogFrame::kTool, {.linear = {0.01, 0, 0}}}, start);
  EXPECT_EQ(test::allocations(), before);
  EXPECT_TRUE(speeds.has_value());
}

}  // namespace
}  // namespace armjig::parol6::planning
