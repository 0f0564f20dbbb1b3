// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/numeric_ik.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "harness/arm/models.hpp"
#include "tests/unit/arm/degrees.hpp"
#include "tests/unit/support/allocations.hpp"

namespace armjig::arm {
namespace {

using test::rad;

double draw_between(std::mt19937_64& engine, double lower, double upper) {
  return lower + (upper - lower) * (static_cast<double>(engine() >> 11U) * 0x1p-53);
}

JointVector drawn_posture(const Arm& arm, std::mt19937_64& engine) {
  JointVector joints(arm.joint_count());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    joints[j] = draw_between(engine, std::max(arm.joints[j].lower, -std::numbers::pi),
                             std::min(arm.joints[j].upper, std::numbers::pi));
  }
  return joints;
}

JointVector ready() {
  JointVector joints(6);
  const std::array degrees{275.2882, 167.5798, 57.4104, 240.8248, 82.8382, 75.8195};
  for (std::size_t j = 0; j < 6; ++j) joints[j] = rad(degrees[j]);
  return joints;
}

TEST(NumericIk, FindsPosturesOfTheJaco) {
  const auto arm = jaco(JacoVariant::kJaco2Curved);
  std::mt19937_64 engine{11};
  constexpr int kPoses = 300;
  int reached = 0;
  for (int i = 0; i < kPoses; ++i) {
    const auto pose = forward(arm, drawn_posture(arm, engine));
    const auto answer = numeric_ik(arm, pose, ready());
    const auto there = forward(arm, answer.joints);
    const bool is_there = norm(there.position - pose.position) < 2e-9 &&
                          angle_between(there.rotation, pose.rotation) < 2e-9 &&
                          first_outside(arm, answer.joints) == arm.joint_count();
    ASSERT_EQ(answer.is_reached, is_there) << "pose " << i;
    reached += answer.is_reached ? 1 : 0;
  }
  EXPECT_EQ(reached, kPoses);
}

TEST(NumericIk, FindsThePosturesOfTheReference) {
  const auto arm = jaco(JacoVariant::kJaco2Curved);
  const auto pose = forward(arm, ready());
  auto seed = ready();
  for (auto& q : seed) q += rad(15);
  const auto answer = numeric_ik(arm, pose, seed);
  ASSERT_TRUE(answer.is_reached);
  EXPECT_EQ(answer.attempts, 1);
  for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(answer.joints[j], ready()[j], 1e-6);
}

TEST(NumericIk, SaysThatAPoseIsOutOfReach) {
  const auto arm = jaco(JacoVariant::kJaco2Curved);
  const auto answer = numeric_ik(arm, translation({1.5, 0, 0.5}), ready(), {.attempts = 5});
  EXPECT_FALSE(answer.is_reached);
  EXPECT_EQ(answer.attempts, 5);
  EXPECT_GT(answer.error_m, 0.4);  // of 0.98 m reach
}

TEST(NumericIk, DoesNotLeaveTheLimitsForAPose) {
  auto arm = jaco(JacoVariant::kJaco2Curved);
  const auto pose = forward(arm, ready());
  arm.joints[1].lower = rad(200);  // ready has 167
  arm.joints[1].upper = rad(201);
  arm.joints[2].lower = rad(100);
  arm.joints[2].upper = rad(101);
  const auto answer = numeric_ik(arm, pose, ready(), {.attempts = 5});
  EXPECT_FALSE(answer.is_reached);
  EXPECT_EQ(first_outside(arm, answer.joints), arm.joint_count());
}

TEST(NumericIk, SolvesArmsThatSlide) {
  Arm arm{.name = "gantry"};
  for (const Vector3 axis : {Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}}) {
    arm.joints.push_back({.kind = Joint::Kind::kPrismatic, .axis = axis, .lower = 0, .upper = 2});
  }
  for (const Vector3 axis : {Vector3{0, 0, 1}, Vector3{0, 1, 0}, Vector3{0, 0, 1}}) {
    arm.joints.push_back({.axis = axis});
  }
  JointVector joints(6);
  std::ranges::copy(std::array{0.3, 1.2, 0.7, 0.4, 1.0, -0.8}, joints.begin());
  const auto answer = numeric_ik(arm, forward(arm, joints), JointVector(6));
  EXPECT_TRUE(answer.is_reached);
  for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(answer.joints[j], joints[j], 1e-8);
}

TEST(NumericIk, TakesNothingFromTheHeap) {
  const auto arm = jaco(JacoVariant::kJaco2Curved);
  const auto pose = forward(arm, ready());
  const auto before = test::allocations();
  const auto answer = numeric_ik(arm, pose, JointVector(6));
  EXPECT_EQ(test::allocations(), before);
  EXPECT_TRUE(answer.is_reached);
}

}  // namespace
}  // namespace armjig::arm
