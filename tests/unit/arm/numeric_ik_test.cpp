// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/numeric_ik.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "harness/arm/models.hpp"
#include "harness/arm/orientation.hpp"
#include "tests/unit/support/allocations.hpp"

namespace armjig::arm {
namespace {

constexpr double rad(double degrees) { return degrees * (std::numbers::pi / 180); }

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

}  // namespace
}  // namespace armjig::arm
