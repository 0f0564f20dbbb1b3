// SPDX-License-Identifier: Apache-2.0
#include "harness/motion/parol6/planner.hpp"

#include <cstdlib>
#include <optional>

#include "harness/arm/models.hpp"
#include "harness/motion/parol6/checks.hpp"
#include "harness/motion/parol6/commander_ik.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/joint_move.hpp"
#include "harness/motion/parol6/line.hpp"

namespace armjig::parol6::planning {
namespace {

using Planned = tl::expected<Plan, Refusal>;

/// What the commander adds to every target, so that none is exactly where the joint is: degrees in
/// MoveJoint, radians in MovePose.
constexpr double kNudge = 1e-7;

/// Of six numbers as people write them: mm and degrees.
arm::Pose pose_of(const std::array<double, 6>& numbers, arm::Convention convention) noexcept {
  const auto [x, y, z, rx, ry, rz] = numbers;
  return {rotation_of({to_radians(rx), to_radians(ry), to_radians(rz)}, convention),
          {x / 1000, y / 1000, z / 1000}};
}

/// Where the commander sends a joint; it cuts off fractions of a step.
struct JointGoal {
  double radians{};
  double steps{};
};

template <class GoalOf>
Planned plan_commander_joints(const Move& move, const JointSteps& start,
                              const PlannerSettings& settings, CommanderTarget target,
                              GoalOf goal_of) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const JointGoal goal = goal_of(j);
    target.radians[j] = goal.radians;
    target.steps[j] = Steps{cut_off(goal.steps)};
  }
  return plan_commander_joints(target, start, move.timing, move.tracking, settings.limits);
}

Planned plan_joints(const Move& move, const JointSteps& start, const PlannerSettings& settings) {
  if (settings.rules == Rules::kDocumented) {
    arm::SixJoints target{};
    for (std::size_t j = 0; j < kJointCount; ++j) target[j] = to_radians(move.target[j]);
    return plan_documented_joints(target, start, move.timing, move.tracking, settings.limits);
  }
  const CommanderTarget target{.default_speed = 45, .default_acceleration = 27};
  return plan_commander_joints(move, start, settings, target, [&](std::size_t j) {
    return JointGoal{to_radians(move.target[j] + kNudge), steps_of_degrees(j, move.target[j])};
  });
}

/// The commander begins its search at the same posture wherever the arm is, and takes what it finds
/// for found.
Planned plan_commander_pose(const Move& move, const JointSteps& start,
                            const PlannerSettings& settings) {
  arm::SixJoints seed{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    seed[j] = to_radians(kPlannedJoints[j].commander_seed.value);
  }
  const auto pose = pose_of(move.target, settings.convention);
  const auto answer = commander_ik(arm::parol6_commander(), pose, seed);
  const CommanderTarget target{.default_speed = 50, .default_acceleration = 30};
  return plan_commander_joints(move, start, settings, target, [&](std::size_t j) {
    return JointGoal{answer.joints[j] + kNudge, steps_of_radians(j, answer.joints[j])};
  });
}

Planned plan_documented_pose(const Move& move, const JointSteps& start,
                             const PlannerSettings& settings) {
  const auto arm = arm::parol6_commander();
  const auto pose = pose_of(move.target, settings.convention);
  const auto target = reach(arm, *arm::SphericalWrist::of(arm), pose, radians_of(start), 0);
  if (!target) return tl::unexpected{target.error()};
  return plan_documented_joints(*target, start, move.timing, move.tracking, settings.limits);
}

Planned plan_line(const Move& move, const JointSteps& start, const PlannerSettings& settings) {
  const bool is_relative = move.kind == Move::Kind::kToolLine;
  const auto convention = is_relative ? arm::Convention::kXyz : settings.convention;
  const LineTarget target{pose_of(move.target, convention), is_relative};
  return settings.rules == Rules::kDocumented
             ? plan_documented_line(target, start, move.timing, move.tracking, settings)
             : plan_commander_line(target, start, move.timing, move.tracking);
}

Planned plan_unchecked(const Move& move, const JointSteps& start, const PlannerSettings& settings) {
  switch (move.kind) {
    case Move::Kind::kJoint:
      return plan_joints(move, start, settings);
    case Move::Kind::kPose:
      return settings.rules == Rules::kDocumented ? plan_documented_pose(move, start, settings)
                                                  : plan_commander_pose(move, start, settings);
    case Move::Kind::kLine:
    case Move::Kind::kToolLine:
      break;
  }
  return plan_line(move, start, settings);
}

/// Numbers that were cut to what a frame holds. The commander's are masked: a speed beyond becomes
/// another one, the other way round perhaps.
std::optional<Refusal> beyond_frame(const Plan& plan) {
  const auto is_beyond = [](std::int32_t value) { return std::abs(value) >= kMostSteps; };
  for (std::size_t i = 0; i < plan.set_points.size(); ++i) {
    const auto& [position, speed] = plan.set_points[i];
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!is_beyond(position[j].value) && !is_beyond(speed[j].value)) continue;
      return Refusal{.reason = Refusal::Reason::kBeyondFrame,
                     .joint = j,
                     .time = kTick * static_cast<double>(i + 1)};
    }
  }
  return std::nullopt;
}

}  // namespace

Planned plan(const Move& move, const JointSteps& start, const PlannerSettings& settings) {
  auto planned = plan_unchecked(move, start, settings);
  if (!planned) return planned;
  if (const auto refusal = beyond_frame(*planned)) return tl::unexpected{*refusal};
  return planned;
}

}  // namespace armjig::parol6::planning
