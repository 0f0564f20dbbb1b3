// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "harness/motion/parol6/joint_table.hpp"
#include "harness/motion/parol6/planner.hpp"

// The figures are those of the reference, worked out from the shipped program's arithmetic. Moves
// begin where homing ends: 10240 -32000 57905 0 0 32000.
namespace armjig::parol6::planning {
namespace {

using testing::ElementsAre;

constexpr PlannerSettings kCommander{.rules = Rules::kCommander};

Move joint_move(std::array<double, 6> degrees, Timing timing) {
  return {.kind = Move::Kind::kJoint, .target = degrees, .timing = timing};
}

Timing in_time(double seconds, Law law = Law::kPolynomial) {
  return {.duration = seconds, .law = law};
}
Timing at_pace(double speed, double acceleration) {
  return {.speed = speed, .acceleration = acceleration};
}

Plan planned(std::array<double, 6> degrees, Timing timing, JointSteps start = kStandby) {
  const auto result = plan(joint_move(degrees, timing), start, kCommander);
  EXPECT_TRUE(result.has_value());
  return result.value_or(Plan{});
}

/// What the k-th set-point, counted from 1, tells a joint.
struct Told {
  int position{};
  int speed{};
  friend bool operator==(const Told&, const Told&) = default;
};
void PrintTo(const Told& told, std::ostream* out) {
  *out << '(' << told.position << ", " << told.speed << ')';
}
Told told(const Plan& plan, std::size_t k, std::size_t joint) {
  const auto& set_point = plan.set_points.at(k - 1);
  return {set_point.position[joint].value, set_point.speed[joint].value};
}

TEST(CommanderJointMove, SendsAllSamplesOfAPolynomialButTheFirst) {
  const auto move = planned({0, -90, 180, 0, 0, 180}, in_time(4));
  ASSERT_EQ(move.set_points.size(), 399U);
  EXPECT_EQ(told(move, 1, 0), (Told{10239, 0}));
  EXPECT_EQ(told(move, 2, 0), (Told{10239, -1}));
  EXPECT_EQ(told(move, 10, 0), (Told{10238, -45}));
  EXPECT_EQ(told(move, 100, 0), (Told{9173, -2715}));
  EXPECT_EQ(told(move, 199, 0), (Told{5144, -4811}));
  EXPECT_EQ(told(move, 200, 0), (Told{5095, -4811}));
  EXPECT_EQ(told(move, 300, 0), (Told{1039, -2679}));
  EXPECT_EQ(told(move, 398, 0), (Told{0, 0}));
  EXPECT_EQ(told(move, 399, 0), (Told{0, 0}));
}

TEST(CommanderJointMove, TakesAStepFromJointsThatShallStand) {
  const auto move = planned({0, -90, 180, 0, 0, 180}, in_time(4));
  for (std::size_t k = 1; k <= move.set_points.size(); ++k) {
    EXPECT_EQ(told(move, k, 1).position, -31999) << k;
    EXPECT_EQ(told(move, k, 2).position, 57904) << k;
  }
}

TEST(CommanderJointMove, CutsSpeedsOfATimedTrapezoidToMultiplesOfItsSamples) {
  const auto move = planned({0, -90, 180, 0, 0, 180}, in_time(4, Law::kTrapezoid));
  ASSERT_EQ(move.set_points.size(), 399U);
  EXPECT_EQ(told(move, 10, 0).position, 10225);
  EXPECT_EQ(told(move, 100, 0), (Told{8792, -2793}));
  EXPECT_EQ(told(move, 133, 0), (Told{7680, -3591}));
  EXPECT_EQ(told(move, 200, 0), (Told{5100, -3591}));
  EXPECT_EQ(told(move, 266, 0), (Told{2560, -3591}));
  EXPECT_EQ(told(move, 300, 0), (Told{1418, -2793}));
  EXPECT_EQ(told(move, 399, 0), (Told{0, 0}));
  for (std::size_t k = 1; k <= 399; ++k) EXPECT_EQ(told(move, k, 0).speed % 399, 0) << k;
}

TEST(CommanderJointMove, PlaysTheDocumentsExperiment) {
  auto start = kStandby;
  start[5] = Steps{46222};
  const auto polynomial = planned({90, -90, 180, 0, 0, 180}, in_time(2), start);
  EXPECT_EQ(told(polynomial, 1, 5), (Told{46221, -5}));
  EXPECT_EQ(told(polynomial, 50, 5), (Told{44730, -7588}));
  EXPECT_EQ(told(polynomial, 100, 5), (Told{39044, -13399}));
  EXPECT_EQ(told(polynomial, 150, 5), (Told{33416, -7385}));
  EXPECT_EQ(told(polynomial, 199, 5), (Told{32000, 0}));
  const auto trapezoid = planned({90, -90, 180, 0, 0, 180}, in_time(2, Law::kTrapezoid), start);
  EXPECT_EQ(told(trapezoid, 50, 5), (Told{44201, -7960}));
  for (std::size_t k = 66; k <= 133; ++k) EXPECT_EQ(told(trapezoid, k, 5).speed, -10547) << k;
  EXPECT_EQ(told(trapezoid, 100, 5).position, 39057);
  EXPECT_EQ(told(trapezoid, 150, 5), (Told{33940, -7761}));
  EXPECT_EQ(told(trapezoid, 199, 5), (Told{32000, 0}));
}

TEST(CommanderJointMove, LetsTheLeadingJointSetThePace) {
  const auto move = planned({0, -90, 180, 0, 0, 180}, at_pace(50, 50));
  EXPECT_EQ(move.leading_joint, 0U);
  EXPECT_NEAR(move.duration, 3.308637780, 1e-9);
  ASSERT_EQ(move.set_points.size(), 329U);
  EXPECT_EQ(told(move, 1, 0), (Told{10239, -167}));
  EXPECT_EQ(told(move, 165, 0).speed, -3300);
  EXPECT_EQ(told(move, 329, 0), (Told{0, -167}));
  EXPECT_EQ(told(move, 165, 1), (Told{-32000, 0}));  // held
  EXPECT_EQ(told(move, 165, 5), (Told{32000, 0}));
}

TEST(CommanderJointMove, GivesEveryJointAnIntegerCruiseSpeed) {
  const auto move = planned({0, -60, 200, 30, 0, 90}, at_pace(50, 50));
  std::vector<int> cruise;
  std::vector<int> end;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    cruise.push_back(std::abs(told(move, 165, j).speed));
    end.push_back(told(move, 329, j).position);
  }
  EXPECT_THAT(cruise, ElementsAre(3300, 3437, 2073, 687, 0, 5156));
  EXPECT_THAT(end, ElementsAre(0, -21333, 64337, 2132, 0, 16001));
}

TEST(CommanderJointMove, FallsBackToThirdsOnAShortWay) {
  const auto move = planned({89, -90, 180, 0, 0, 180}, at_pace(50, 50));
  EXPECT_NEAR(move.duration, 0.240152931, 1e-9);
  EXPECT_EQ(move.set_points.size(), 23U);
  EXPECT_EQ(told(move, 12, 0).speed, -712);  // 712.5 cut off
}

TEST(CommanderJointMove, HasDefaultsForSpeedAndAccelerationTogetherOnly) {
  const auto without = planned({0, -90, 180, 0, 0, 180}, {});
  EXPECT_NEAR(without.duration, 3.778259285, 1e-9);
  ASSERT_EQ(without.set_points.size(), 376U);
  EXPECT_EQ(told(without, 1, 0), (Told{10239, -89}));
  EXPECT_EQ(told(without, 188, 0).speed, -2980);
  EXPECT_EQ(told(without, 376, 0), (Told{0, -89}));
  const auto half = planned({0, -90, 180, 0, 0, 180}, {.speed = 50});
  EXPECT_EQ(half.set_points, without.set_points);
}

constexpr std::array<double, 6> kAside{80, -90, 180, 0, 0, 180};

Refusal refused(std::array<double, 6> degrees, Timing timing) {
  const auto result = plan(joint_move(degrees, timing), kStandby, kCommander);
  EXPECT_FALSE(result.has_value());
  return result.has_value() ? Refusal{} : result.error();
}

TEST(CommanderJointMove, DoesNotLookAtPercentsIfATimeIsThere) {
  auto timing = in_time(1);
  timing.speed = 101;
  timing.acceleration = -1;
  EXPECT_EQ(planned(kAside, timing).set_points, planned(kAside, in_time(1)).set_points);
}

TEST(CommanderJointMove, RefusesPercentsOnlyIfBothAreThere) {
  EXPECT_EQ(refused(kAside, at_pace(101, 50)).reason, Refusal::Reason::kPercentOutOfRange);
  EXPECT_EQ(refused(kAside, at_pace(50, -0.1)).reason, Refusal::Reason::kPercentOutOfRange);
  EXPECT_EQ(planned(kAside, {.speed = 101}).set_points, planned(kAside, {}).set_points);
}

TEST(CommanderJointMove, TakesATimeOfZeroForNone) {
  EXPECT_EQ(planned(kAside, {.duration = 0}).set_points, planned(kAside, {}).set_points);
  EXPECT_EQ(planned(kAside, {.duration = -1}).set_points, planned(kAside, {}).set_points);
  auto timing = at_pace(50, 50);
  timing.duration = 0;
  EXPECT_EQ(planned(kAside, timing).set_points, planned(kAside, at_pace(50, 50)).set_points);
  timing.duration = -1;
  EXPECT_EQ(refused(kAside, timing).reason, Refusal::Reason::kImpossibleDuration);
}

TEST(CommanderJointMove, SendsNothingInOneSampleAndCannotPlanLess) {
  EXPECT_TRUE(planned(kAside, in_time(0.01)).set_points.empty());
  EXPECT_EQ(refused(kAside, in_time(0.009)).reason, Refusal::Reason::kImpossibleDuration);
}

TEST(CommanderJointMove, HoldsJointsThatAreThere) {
  const auto move = planned({90, -90, 180, 0, 0, 170}, at_pace(50, 50));
  for (const auto& set_point : move.set_points) {
    EXPECT_EQ(set_point.position[0], Steps{10240});
    EXPECT_EQ(set_point.speed[0], StepsPerSecond{0});
  }
}

TEST(CommanderJointMove, LooksAtSpeedsOfItsPaceOnly) {
  // Joint 4 leads and is three times as fast as joint 1 may be.
  const auto refusal = refused({30, -90, 180, 61, 0, 180}, at_pace(100, 100));
  EXPECT_EQ(refusal.reason, Refusal::Reason::kTooFast);
  EXPECT_EQ(refusal.joint, 0U);
  EXPECT_EQ(planned({30, -90, 180, 61, 0, 180}, in_time(0.1)).set_points.size(), 9U);
}

TEST(CommanderJointMove, RefusesTheLimitsThemselves) {
  EXPECT_EQ(refused({90, -90, 180, 0, 90, 180}, in_time(4)).joint, 4U);
  EXPECT_EQ(planned({90, -90, 180, 0, 89.99, 180}, in_time(4)).set_points.size(), 399U);
  // A 1e-7 degree beyond its lower limit a joint is within.
  EXPECT_EQ(planned({90, -90, 180, 0, -90, 180}, in_time(4)).set_points.size(), 399U);
  EXPECT_EQ(planned({90, -90, 180, 0, 0, 0}, in_time(4)).set_points.size(), 399U);
}

TEST(CommanderJointMove, CutsTheNumberOfSamplesOff) {
  const auto count = [](double seconds) {
    return planned({80, -90, 180, 0, 0, 180}, in_time(seconds)).set_points.size() + 1;
  };
  EXPECT_EQ(count(0.29), 28U);
  EXPECT_EQ(count(0.57), 56U);
  EXPECT_EQ(count(2.3), 229U);
  EXPECT_EQ(count(1.1), 110U);
  EXPECT_EQ(count(3.6), 360U);
}

}  // namespace
}  // namespace armjig::parol6::planning
