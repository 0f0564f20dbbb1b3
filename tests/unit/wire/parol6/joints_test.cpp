// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/joints.hpp"

#include <gtest/gtest.h>

#include <array>

#include "harness/wire/parol6/joint_bounds.hpp"

namespace armjig::parol6 {
namespace {

// The standby position: 90 -90 180 0 0 180 degrees are 10240 -32000 57905 0 0 32000 steps on the
// board, which rounds 57904.76 (reference: homing, constants).
constexpr std::array kStandbyDegrees{90.0, -90.0, 180.0, 0.0, 0.0, 180.0};
constexpr std::array kStandbySteps{10240, -32000, 57905, 0, 0, 32000};

TEST(Joint, KnowsTheStepsOfTheStandbyPosition) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(kJoints[j].position(Degrees{kStandbyDegrees[j]}).value, kStandbySteps[j]) << j;
    EXPECT_EQ(kStandby[j].value, kStandbySteps[j]) << j;
  }
}

TEST(Joint, KnowsTheDegreesOfAStep) {
  // 360 / (6400 * reduction)
  constexpr std::array kDegrees{0.0087890625, 0.0028125, 0.00310855263,
                                0.0140625,    0.0140625, 0.005625};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_NEAR(kJoints[j].angle(Steps{1}).value, kDegrees[j], 1e-11) << j;
    EXPECT_NEAR(kJoints[j].speed(StepsPerSecond{-1}).value, -kDegrees[j], 1e-11) << j;
  }
}

TEST(Joint, HasTheRangesAndSpeedsOfTheGui) {
  // Reference, limits: the GUI cuts its degrees off to these steps.
  constexpr std::array kLower{-14000, -51558, 34699, -7500, -6400, 0};
  constexpr std::array kUpper{14000, -1200, 92604, 7500, 6400, 64000};
  constexpr std::array kMaxSpeed{6500, 18000, 20000, 22000, 22000, 22000};
  constexpr std::array kMaxJog{1500, 3000, 3600, 7000, 7000, 18000};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(kJointBounds[j].lower.value, kLower[j]) << j;
    EXPECT_EQ(kJointBounds[j].upper.value, kUpper[j]) << j;
    EXPECT_EQ(kJoints[j].max_speed.value, kMaxSpeed[j]) << j;
    EXPECT_EQ(kJoints[j].max_jog.value, kMaxJog[j]) << j;
  }
}

TEST(Joint, GivesBackTheStepsOfEachAngle) {
  for (const auto& joint : kJoints) {
    for (const int steps : {-8388608, -57905, -1, 0, 1, 2, 14000, 8388607}) {
      EXPECT_EQ(joint.position(joint.angle(Steps{steps})), Steps{steps});
      EXPECT_EQ(joint.speed(joint.speed(StepsPerSecond{steps})), StepsPerSecond{steps});
    }
  }
}

TEST(Joint, RoundsToTheNearestStepOnBothSidesOfZero) {
  const auto& j4 = kJoints[3];  // 0.0140625 degrees a step
  EXPECT_EQ(j4.position(Degrees{0.007}).value, 0);
  EXPECT_EQ(j4.position(Degrees{0.0071}).value, 1);
  EXPECT_EQ(j4.position(Degrees{-0.007}).value, 0);
  EXPECT_EQ(j4.position(Degrees{-0.0071}).value, -1);
}

}  // namespace
}  // namespace armjig::parol6
