// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "harness/arm/models.hpp"
#include "harness/arm/orientation.hpp"
#include "harness/motion/parol6/commander_ik.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/line.hpp"
#include "harness/motion/parol6/planner.hpp"

// The figures are those of the reference, with its tolerances.
namespace armjig::parol6::planning {
namespace {

constexpr PlannerSettings kCommanderLine{.rules = Rules::kCommander};

arm::SixJoints commander_seed() {
  arm::SixJoints seed{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    seed[j] = to_radians(kPlannedJoints[j].commander_seed.value);
  }
  return seed;
}

CommanderIkAnswer solved(arm::Vector3 mm, arm::Angles degrees) {
  const arm::Angles angles{to_radians(degrees.rx), to_radians(degrees.ry), to_radians(degrees.rz)};
  return commander_ik(arm::parol6_commander(),
                      {rotation_of(angles, arm::Convention::kCommander), 0.001 * mm},
                      commander_seed());
}

void expect_degrees(const CommanderIkAnswer& answer, const arm::SixJoints& expected) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double apart = std::remainder(to_degrees(answer.joints[j]) - expected[j], 360.0);
    EXPECT_NEAR(apart, 0, 0.002) << "j" << j + 1;
  }
}

TEST(CommanderIk, TakesTheStepsOfTheReference) {
  const auto first = solved({0, 263.23, 161.241}, {-90, 0, -89.499});
  EXPECT_TRUE(first.has_converged);
  EXPECT_EQ(first.iterations, 8);
  expect_degrees(first, {90.000, -85.0572, 143.5804, 0, 41.8634, -180.000});
  const auto second = solved({81.565, 262.804, 161.047}, {-90.135, -0.029, -89.578});
  EXPECT_EQ(second.iterations, 10);
  expect_degrees(second, {67.7989, -80.3335, 148.9335, 31.8237, 45.8443, 156.5831});
  const auto third = solved({262.57, 0, 250}, {0, 90, 180});
  EXPECT_EQ(third.iterations, 5);
  expect_degrees(third, {0, -91.6621, 166.0042, 0, 12.3337, 180});
}

TEST(CommanderIk, GivesUpOutOfReach) {
  const auto answer = solved({900, 0, 200}, {0, 90, 180});
  EXPECT_FALSE(answer.has_converged);
  EXPECT_EQ(answer.iterations, kCommanderIkIterations);
}

TEST(CommanderIk, LeavesAGoodSeedUnwrapped) {
  const auto arm = arm::parol6_commander();
  arm::SixJoints seed = commander_seed();
  seed[5] = to_radians(350);
  const auto answer = commander_ik(arm, forward(arm, seed), seed);
  EXPECT_EQ(answer.joints, seed);
}

TEST(CommanderPoseMove, RefusesANegativeJointSix) {
  const Move move{.kind = Move::Kind::kPose, .target = {0, 263.23, 161.241, -90, 0, -89.499}};
  const auto result = plan(move, kStandby, kCommanderLine);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().reason, Refusal::Reason::kOutOfLimits);
  EXPECT_EQ(result.error().joint, 5U);
}

TEST(CommanderPoseMove, EndsWithinAStepOfItsPosture) {
  const Move move{.kind = Move::Kind::kPose,
                  .target = {81.565, 262.804, 161.047, -90.135, -0.029, -89.578},
                  .timing = {.duration = 4}};
  const auto result = plan(move, kStandby, kCommanderLine);
  ASSERT_TRUE(result.has_value());
  const arm::SixJoints expected{67.7989, -80.3335, 148.9335, 31.8237, 45.8443, 156.5831};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_NEAR(degrees_of(j, result->set_points.back().position[j]), expected[j], 0.02);
  }
}

struct Expected {
  std::size_t k{};
  std::array<int, kJointCount> positions{};
  std::array<int, kJointCount> speeds{};
};

TEST(CommanderLine, IsTheReferencesLineFromStandby) {
  const Move move{.kind = Move::Kind::kLine, .target = {0, 263.23, 161.241, -90, 0, -89.499}};
  const auto result = plan(move, kStandby, kCommanderLine);
  ASSERT_TRUE(result.has_value());
  EXPECT_FALSE(result->stop);
  ASSERT_EQ(result->set_points.size(), 359U);
  const std::array expected{
      Expected{1, {10239, -32003, 57902, 0, 0, 31989}, {0, 0, 0, 0, 0, 0}},
      Expected{60, {10239, -32033, 57756, 0, 25, 31989}, {0, -196, -946, 0, 172, 0}},
      Expected{180, {10239, -32448, 50917, 0, 1472, 31994}, {0, 1054, -7264, 0, 1839, 7}},
      Expected{300, {10239, -30302, 46251, 0, 2950, 31999}, {0, 415, -435, 0, 181, 0}},
      Expected{359, {10239, -30242, 46189, 0, 2976, 31999}, {0, 0, 0, 0, 0, 0}},
  };
  for (const auto& [k, positions, speeds] : expected) {
    const auto& set_point = result->set_points[k - 1];
    for (std::size_t j = 0; j < kJointCount; ++j) {
      EXPECT_NEAR(set_point.position[j].value, positions[j], 2) << "k=" << k << " j" << j + 1;
      EXPECT_NEAR(set_point.speed[j].value, speeds[j], 0.03 * std::abs(speeds[j]) + 2)
          << "k=" << k << " j" << j + 1;
    }
  }
}

// P8 of the reference: 3.6 s, of which the last point of the grid is at 3.59 s.
TEST(CommanderLine, PutsASecondTrapezoidOnTopOfItsProfile) {
  struct Share {
    std::size_t k{};
    double trapezoid{};
    double polynomial{};
  };
  for (const auto& [k, trapezoid, polynomial] :
       {Share{60, 0.008887, 0.002878}, Share{120, 0.142196, 0.100414},
        Share{180, 0.503134, 0.503917}, Share{240, 0.862483, 0.903466},
        Share{300, 0.991690, 0.997374}, Share{358, 1.000000, 1.000000}}) {
    const double t = kTick * static_cast<double>(k);
    EXPECT_NEAR(commander_path_share(Law::kTrapezoid, t, 3.59), trapezoid, 1e-6) << k;
    EXPECT_NEAR(commander_path_share(Law::kPolynomial, t, 3.59), polynomial, 1e-6) << k;
  }
}

TEST(CommanderLine, LooksAtPercentsOnlyIfBothAreThereAndNoTimeIs) {
  const auto result = [](Timing timing) {
    const Move move{.kind = Move::Kind::kToolLine, .timing = timing};
    return plan(move, kStandby, kCommanderLine);
  };
  EXPECT_EQ(result({.speed = 101, .acceleration = 50}).error().reason,
            Refusal::Reason::kPercentOutOfRange);
  EXPECT_EQ(result({.speed = 50, .acceleration = 50})->set_points.size(), 359U);
  EXPECT_EQ(result({.speed = 101})->set_points.size(), 359U);
  EXPECT_EQ(result({.speed = 101, .acceleration = 50, .duration = 1})->set_points.size(), 99U);
  EXPECT_EQ(result({.duration = -1})->set_points.size(), 359U);
  EXPECT_EQ(result({.speed = 50, .acceleration = 50, .duration = -1}).error().reason,
            Refusal::Reason::kImpossibleDuration);
}

// K6: along the tool's x axis, which points up there.
TEST(CommanderLine, GoesAlongTheAxesOfTheTool) {
  const Move move{.kind = Move::Kind::kToolLine, .target = {-80, 0, 0, 0, 0, 0}};
  const auto result = plan(move, kStandby, kCommanderLine);
  ASSERT_TRUE(result.has_value());
  ASSERT_FALSE(result->stop);
  const auto end = forward(arm::parol6_commander(), radians_of(result->set_points.back().position));
  EXPECT_NEAR(1000 * end.position.x, 0, 0.3);  // begins beside standby by up to 1e-3 rad
  EXPECT_NEAR(1000 * end.position.y, 262.57, 0.3);
  EXPECT_NEAR(1000 * end.position.z, 208.75, 0.3);
}

TEST(CommanderLine, CountsItsSamplesOnTheGridOfItsDuration) {
  const auto count = [](double seconds) {
    const Move move{.kind = Move::Kind::kToolLine, .timing = {.duration = seconds}};
    return plan(move, kStandby, kCommanderLine)->set_points.size() + 1;
  };
  EXPECT_EQ(count(0.29), 28U);
  EXPECT_EQ(count(0.57), 56U);
  EXPECT_EQ(count(1.1), 110U);
}

TEST(CommanderLine, SendsTheSetPointThatDidNotConvergeAndStops) {
  const Move move{.kind = Move::Kind::kLine, .target = {900, 0, 200, 0, 90, 180}};
  const auto result = plan(move, kStandby, kCommanderLine);
  ASSERT_TRUE(result.has_value());
  ASSERT_TRUE(result->stop);
  EXPECT_EQ(result->stop->reason, Refusal::Reason::kNotConverged);
  EXPECT_NEAR(result->stop->time, 0.01 * static_cast<double>(result->set_points.size()), 1e-9);
}

TEST(CommanderLine, StopsWhereAJointChangesItsSign) {
  // Joint 1 at 1.8 degrees, the wrist bent; across to the other side of 0.
  const JointSteps start{Steps{200}, Steps{-32000}, Steps{51471},
                         Steps{0},   Steps{1422},   Steps{32000}};
  const Move move{.kind = Move::Kind::kToolLine, .target = {0, 40, 0, 0, 0, 0}};
  const auto result = plan(move, start, kCommanderLine);
  ASSERT_TRUE(result.has_value());
  ASSERT_TRUE(result->stop);
  EXPECT_EQ(result->stop->reason, Refusal::Reason::kSignFlip);
  EXPECT_LT(result->set_points.size(), 359U);
}

/// A line from the seed's pose to where the tool has turned about its own z axis.
tl::expected<Plan, Refusal> turned(double degrees) {
  const Move move{.kind = Move::Kind::kToolLine,
                  .target = {0, 0, 0, 0, 0, degrees},
                  .timing = {.duration = 4.0}};
  return plan(move, kStandby, kCommanderLine);
}

TEST(CommanderLine, TellsOfTheLongWayRoundAndRefusesAWholeTurn) {
  bool has_turned_long = false;
  for (int degrees = -170; degrees <= 170; degrees += 5) {
    const auto planned = turned(degrees);
    if (planned && planned->turns_long_way) has_turned_long = true;
    EXPECT_TRUE(planned || planned.error().reason == Refusal::Reason::kNoTurn) << degrees;
  }
  EXPECT_TRUE(has_turned_long);
}

TEST(CommanderJointMove, RefusesNumbersThatNoFrameHolds) {
  const Move move{.kind = Move::Kind::kJoint,
                  .target = {1000, -90, 180, 0, 0, 180},
                  .timing = {.duration = 0.03}};
  auto settings = kCommanderLine;
  settings.limits = LimitCheck::kIgnored;
  const auto planned = plan(move, kStandby, settings);
  ASSERT_FALSE(planned);
  EXPECT_EQ(planned.error().reason, Refusal::Reason::kBeyondFrame);
  EXPECT_EQ(describe(planned.error()),
            "j1 would be told more at 0.01 s than the 24 bits of a frame hold");
}

}  // namespace
}  // namespace armjig::parol6::planning
