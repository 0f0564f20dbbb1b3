// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/arm/models.hpp"
#include "harness/arm/orientation.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/planner.hpp"

namespace armjig::parol6::planning {
namespace {

using Reason = Refusal::Reason;

/// Steps of whole angles, for starts: the wrist bent, the elbow in the middle.
JointSteps at(const std::array<double, 6>& degrees) {
  JointSteps steps;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    steps[j] = Steps{nearest_step(steps_of_degrees(j, degrees[j]))};
  }
  return steps;
}
JointSteps bent() { return at({20, -80, 170, 10, 40, 180}); }

arm::Pose pose_at(const JointSteps& steps) {
  return forward(arm::parol6_commander(), radians_of(steps));
}

Plan planned(const Move& move, const JointSteps& start, const PlannerSettings& settings = {}) {
  const auto result = plan(move, start, settings);
  EXPECT_TRUE(result.has_value()) << describe(result.error());
  return result.value_or(Plan{});
}
Refusal refused(const Move& move, const JointSteps& start, const PlannerSettings& settings = {}) {
  const auto result = plan(move, start, settings);
  EXPECT_FALSE(result.has_value());
  return result ? Refusal{} : result.error();
}

Move to_joints(const std::array<double, 6>& degrees, Timing timing) {
  return {.kind = Move::Kind::kJoint, .target = degrees, .timing = timing};
}
Move along_tool(double x, double y, double z, Timing timing = {}) {
  return {.kind = Move::Kind::kToolLine, .target = {x, y, z, 0, 0, 0}, .timing = timing};
}

TEST(DocumentedJointMove, BeginsAndEndsOnTheExactStep) {
  for (const auto law : {Law::kPolynomial, Law::kTrapezoid}) {
    const auto move =
        planned(to_joints({0, -60, 200, 30, 45, 90}, {.duration = 4, .law = law}), kStandby);
    ASSERT_EQ(move.set_points.size(), 401U);
    EXPECT_EQ(move.set_points.front(), (SetPoint{kStandby, {}}));
    EXPECT_EQ(move.set_points.back(), (SetPoint{at({0, -60, 200, 30, 45, 90}), {}}));
  }
}

TEST(DocumentedJointMove, ArrivesWithAllJointsAtOnce) {
  const auto move = planned(to_joints({0, -60, 200, 30, 45, 90}, {.duration = 4}), kStandby);
  const auto& middle = move.set_points.at(200);
  const auto goal = at({0, -60, 200, 30, 45, 90});
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_NEAR(middle.position[j].value, (kStandby[j].value + goal[j].value) / 2.0, 1);
  }
}

TEST(DocumentedJointMove, IsAsFastAsTheLeadingJointMay) {
  const auto move =
      planned(to_joints({0, -90, 180, 0, 0, 180}, {.speed = 50, .acceleration = 50}), kStandby);
  EXPECT_EQ(move.leading_joint, 0U);
  int fastest = 0;
  for (const auto& [position, speed] : move.set_points) {
    fastest = std::max(fastest, std::abs(speed[0].value));
  }
  EXPECT_NEAR(fastest, 3300, 1);  // half of 100 to 6500
  EXPECT_NEAR(move.duration, 3.31, 1e-9);
}

TEST(DocumentedJointMove, IsATriangleOnAShortWay) {
  const auto move =
      planned(to_joints({89, -90, 180, 0, 0, 180}, {.speed = 50, .acceleration = 50}), kStandby);
  // 114 steps at 16050 steps/s^2: 2 sqrt(114 / 16050) s, on to the next frame
  EXPECT_NEAR(move.duration, 0.17, 1e-9);
  EXPECT_EQ(move.set_points.back().position, at({89, -90, 180, 0, 0, 180}));
}

TEST(DocumentedJointMove, WithNoWayToGoIsStillAMove) {
  const auto move = planned(to_joints({90, -90, 180.0007, 0, 0, 180}, {}), kStandby);
  ASSERT_FALSE(move.set_points.empty());
  for (const auto& set_point : move.set_points) EXPECT_EQ(set_point, (SetPoint{kStandby, {}}));
}

TEST(DocumentedJointMove, ReachesTheLimitsThemselves) {
  const auto move = planned(to_joints({90, -90, 180, 0, 90, 360}, {.duration = 4}), kStandby);
  EXPECT_EQ(move.set_points.back().position[4], Steps{6400});
  EXPECT_EQ(move.set_points.back().position[5], Steps{64000});
}

TEST(DocumentedJointMove, IsRefusedBeyondALimit) {
  const auto refusal = refused(to_joints({90, -90, 180, 0, 90.1, 180}, {.duration = 4}), kStandby);
  EXPECT_EQ(refusal.reason, Reason::kOutOfLimits);
  EXPECT_EQ(refusal.joint, 4U);
  EXPECT_EQ(refusal.limit, 90);
}

TEST(DocumentedJointMove, IsRefusedTooFast) {
  const auto refusal = refused(to_joints({0, -90, 180, 0, 0, 180}, {.duration = 2}), kStandby);
  EXPECT_EQ(refusal.reason, Reason::kTooFast);
  EXPECT_EQ(refusal.joint, 0U);
  EXPECT_NEAR(std::abs(refusal.value), 1.875 * 10240 / 2, 1e-6);
}

TEST(DocumentedJointMove, IsRefusedTooHard) {
  // 1067 steps in 0.4 s: at most 5000 steps/s, but 5.77 * 1067 / 0.16 steps/s^2 of joint 5
  const auto refusal = refused(to_joints({90, -90, 180, 0, 15, 180}, {.duration = 0.4}), kStandby);
  EXPECT_EQ(refusal.reason, Reason::kTooMuchAcceleration);
  EXPECT_EQ(refusal.joint, 4U);
}

TEST(DocumentedJointMove, IsRefusedInNoTime) {
  for (const double seconds : {0.0, -1.0, 0.004, 1e9}) {
    const auto refusal =
        refused(to_joints({0, -90, 180, 0, 0, 180}, {.duration = seconds}), kStandby);
    EXPECT_EQ(refusal.reason, Reason::kImpossibleDuration) << seconds;
  }
}

TEST(DocumentedJointMove, IsRefusedAbove100Percent) {
  for (const auto& timing : {Timing{.speed = 101}, Timing{.acceleration = -1}}) {
    const auto refusal = refused(to_joints({0, -90, 180, 0, 0, 180}, timing), kStandby);
    EXPECT_EQ(refusal.reason, Reason::kPercentOutOfRange);
  }
}

TEST(DocumentedPoseMove, EndsAtThePose) {
  const Move move{.kind = Move::Kind::kPose,
                  .target = {81.565, 262.804, 161.047, -90.135, -0.029, -89.578},
                  .timing = {.duration = 4}};
  const auto end = pose_at(planned(move, kStandby).set_points.back().position);
  EXPECT_NEAR(1000 * end.position.x, 81.565, 0.1);
  EXPECT_NEAR(1000 * end.position.y, 262.804, 0.1);
  EXPECT_NEAR(1000 * end.position.z, 161.047, 0.1);
  const auto angles = angles_of(end.rotation, arm::Convention::kCommander);
  EXPECT_NEAR(to_degrees(angles.rx), -90.135, 0.05);
  EXPECT_NEAR(to_degrees(angles.ry), -0.029, 0.05);
  EXPECT_NEAR(to_degrees(angles.rz), -89.578, 0.05);
}

TEST(DocumentedPoseMove, ReadsItsAnglesInTheConventionAskedFor) {
  const Move move{.kind = Move::Kind::kPose,
                  .target = {0, 263.23, 161.241, -89.499, 0, -90},
                  .timing = {.duration = 4}};
  const auto end = pose_at(
      planned(move, kStandby, {.convention = arm::Convention::kXyz}).set_points.back().position);
  const auto angles = angles_of(end.rotation, arm::Convention::kXyz);
  EXPECT_NEAR(to_degrees(angles.rx), -89.499, 0.05);
}

TEST(DocumentedPoseMove, IsRefusedOutOfReach) {
  const Move move{.kind = Move::Kind::kPose, .target = {600, 0, 200, 0, 0, 0}};
  EXPECT_EQ(refused(move, kStandby).reason, Reason::kUnreachable);
}

TEST(DocumentedPoseMove, NamesTheJointWhoseLimitIsInTheWay) {
  // Standby turned half around: joint 1 would have to be at 180 degrees.
  const Move move{.kind = Move::Kind::kPose, .target = {-262.57, 0, 288.75, 0, -90, 0}};
  const auto refusal = refused(move, kStandby);
  EXPECT_EQ(refusal.reason, Reason::kOutOfLimits);
  EXPECT_TRUE(refusal.joint.has_value());
}

/// How far a plan's postures are from the straight line between its ends.
struct Deviation {
  double mm{};
  double degrees{};
};
Deviation deviation(const Plan& line) {
  const auto from = pose_at(line.set_points.front().position);
  const auto to = pose_at(line.set_points.back().position);
  const auto way = to.position - from.position;
  const auto turn = rotation_vector(to.rotation * inverse(from.rotation));
  Deviation most;
  for (const auto& set_point : line.set_points) {
    const auto pose = pose_at(set_point.position);
    const auto here = pose.position - from.position;
    const double share = dot(here, way) / dot(way, way);
    most.mm = std::max(most.mm, 1000 * norm(here - share * way));
    const double angle = norm(turn);
    const auto straight = angle < 1e-9
                              ? from.rotation
                              : rotation_about(1 / angle * turn, share * angle) * from.rotation;
    most.degrees = std::max(most.degrees, to_degrees(angle_between(straight, pose.rotation)));
  }
  return most;
}

TEST(DocumentedLine, IsStraightToTheStep) {
  for (const auto law : {Law::kPolynomial, Law::kTrapezoid}) {
    const auto line = planned(along_tool(30, -40, 50, {.duration = 4, .law = law}), bent());
    const auto most = deviation(line);
    EXPECT_LT(most.mm, 0.1);
    EXPECT_LT(most.degrees, 0.1);
  }
}

TEST(DocumentedLine, TurnsTheToolInProportion) {
  const Move move{
      .kind = Move::Kind::kToolLine, .target = {20, 0, 30, 15, -10, 25}, .timing = {.duration = 4}};
  EXPECT_LT(deviation(planned(move, bent())).degrees, 0.1);
}

TEST(DocumentedLine, GoesAlongTheToolsOwnAxes) {
  // From x up: 80 mm back along the tool's x axis is 80 mm down.
  const auto start = at({90, -90, 180, 0, 20, 180});
  const auto before = pose_at(start);
  const auto after = pose_at(planned(along_tool(-40, 0, 0), start).set_points.back().position);
  const auto expected = before.position - 0.04 * before.rotation.x_axis();
  EXPECT_LT(norm(after.position - expected), 1e-4);
  EXPECT_LT(angle_between(before.rotation, after.rotation), to_radians(0.05));
}

TEST(DocumentedLine, HasTheSpeedsOfItsPath) {
  const auto line = planned(along_tool(0, 0, 50, {.duration = 3}), bent());
  EXPECT_EQ(line.set_points.front().speed, JointSpeeds{});
  EXPECT_EQ(line.set_points.back().speed, JointSpeeds{});
  for (std::size_t j = 0; j < kJointCount; ++j) {
    double way = 0;
    for (const auto& set_point : line.set_points) way += kTick * set_point.speed[j].value;
    const double expected =
        line.set_points.back().position[j].value - line.set_points.front().position[j].value;
    EXPECT_NEAR(way, expected, 3) << "j" << j + 1;
  }
}

TEST(DocumentedLine, OfSpeedsHoldsThePositions) {
  auto move = along_tool(0, 0, 50);
  move.tracking = Tracking::kSpeed;
  for (const auto& set_point : planned(move, bent()).set_points) {
    EXPECT_EQ(set_point.position, bent());
  }
}

TEST(DocumentedLine, LeavesAStraightWristIfItMayAsItIs) {
  const Move move{.kind = Move::Kind::kLine, .target = {0, 263.23, 161.241, -90, 0, -89.499}};
  const auto line = planned(move, kStandby);
  EXPECT_FALSE(line.stop);
  ASSERT_FALSE(line.singularities.empty());
  EXPECT_EQ(line.singularities.front().kind, SingularityNote::Kind::kWrist);
  EXPECT_EQ(line.singularities.front().nearest, 0U);
}

TEST(DocumentedLine, IsRefusedToWhereNoPostureIs) {
  const Move move{.kind = Move::Kind::kLine, .target = {700, 0, 300, 0, 90, 180}};
  EXPECT_EQ(refused(move, kStandby).reason, Reason::kUnreachable);
}

/// Turns the tool so that the wrist passes straight at a distance of half a degree, where joint 4
/// would have to turn round at once.
Move past_a_straight_wrist() {
  return {.kind = Move::Kind::kToolLine, .target = {0, 0, 0, 1, -40, 0}, .timing = {.duration = 4}};
}
JointSteps before_a_straight_wrist() { return at({20, -80, 170, 0, 20, 180}); }

TEST(DocumentedLine, StopsAtASingularityItCannotPass) {
  const auto line = planned(past_a_straight_wrist(), before_a_straight_wrist());
  ASSERT_TRUE(line.stop);
  EXPECT_EQ(line.stop->reason, Reason::kSingular);
  EXPECT_NEAR(line.stop->time, kTick * static_cast<double>(line.set_points.size()), 1e-9);
  EXPECT_NEAR(line.stop->time, 2.0, 0.5);  // straight at 2.0
  ASSERT_FALSE(line.singularities.empty());
  EXPECT_EQ(line.singularities.front().kind, SingularityNote::Kind::kWrist);
  EXPECT_EQ(line.singularities.front().last + 1, line.set_points.size());
}

TEST(DocumentedLine, NamesTheLimitThatItWouldPassAndNotTheLeapAroundIt) {
  // Joint 4 is led out of its range; another posture within all ranges is far away.
  const Move move{
      .kind = Move::Kind::kLine, .target = {60, 262, 200, -90, 40, -90}, .timing = {.duration = 6}};
  const auto refusal = refused(move, at({90, -90, 180, 0, -20, 180}));
  EXPECT_EQ(refusal.reason, Reason::kOutOfLimits);
  EXPECT_EQ(refusal.joint, 3U);
  EXPECT_NEAR(std::abs(refusal.value), 105.47, 5);
}

TEST(DocumentedLine, IsRefusedAtASingularityIfAskedTo) {
  const auto refusal = refused(past_a_straight_wrist(), before_a_straight_wrist(),
                               {.on_singularity = OnSingularity::kRefuse});
  EXPECT_EQ(refusal.reason, Reason::kSingular);
}

TEST(DocumentedLine, TriesToPassASingularityIfAskedTo) {
  const auto start = before_a_straight_wrist();
  const auto line =
      planned(past_a_straight_wrist(), start, {.on_singularity = OnSingularity::kTry});
  EXPECT_FALSE(line.stop);
  ASSERT_EQ(line.set_points.size(), 401U);
  const auto expected = pose_at(start).rotation *
                        rotation_of({to_radians(1), to_radians(-40), 0}, arm::Convention::kXyz);
  const auto end = pose_at(line.set_points.back().position);
  EXPECT_LT(angle_between(expected, end.rotation), to_radians(0.1));
  for (std::size_t k = 1; k < line.set_points.size(); ++k) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const int step =
          line.set_points[k].position[j].value - line.set_points[k - 1].position[j].value;
      EXPECT_LE(std::abs(step), kJoints[j].max_speed.value * kTick + 1);
    }
  }
}

TEST(DocumentedLine, IsRefusedTooFast) {
  const auto start = at({-20, -80, 170, 0, 40, 180});
  const auto aside = inverse(pose_at(start).rotation) * arm::Vector3{0, 180, 0};
  const auto refusal = refused(along_tool(aside.x, aside.y, aside.z, {.duration = 1}), start);
  EXPECT_EQ(refusal.reason, Reason::kTooFast);
  EXPECT_EQ(refusal.joint, 0U);
}

TEST(DocumentedLine, IsRefusedTooHard) {
  const auto refusal = refused(along_tool(0, 0, 60, {.duration = 0.2}), bent());
  EXPECT_EQ(refusal.reason, Reason::kTooMuchAcceleration);
}

}  // namespace
}  // namespace armjig::parol6::planning
