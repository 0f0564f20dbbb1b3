// SPDX-License-Identifier: Apache-2.0
#include "harness/motion/parol6/planner.hpp"

#include <fmt/core.h>

#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/joint_move.hpp"

namespace armjig::parol6 {
namespace {

/// What the commander adds to every target, so that none is exactly where the joint is: degrees.
constexpr double kNudge = 1e-7;

tl::expected<Plan, Refusal> plan_joints(const Move& move, const JointSteps& start,
                                        const PlannerSettings& settings) {
  if (settings.rules == Rules::kDocumented) {
    arm::SixJoints target{};
    for (std::size_t j = 0; j < kJointCount; ++j) target[j] = to_radians(move.target[j]);
    return plan_documented_joints(target, start, move.timing, move.tracking, settings.limits);
  }
  CommanderTarget target{.default_speed = 45, .default_acceleration = 27};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    target.radians[j] = to_radians(move.target[j] + kNudge);
    target.steps[j] = Steps{cut_off(steps_of_degrees(j, move.target[j]))};
  }
  return plan_commander_joints(target, start, move.timing, move.tracking, settings.limits);
}

}  // namespace

tl::expected<Plan, Refusal> plan(const Move& move, const JointSteps& start,
                                 const PlannerSettings& settings) {
  return plan_joints(move, start, settings);
}

}  // namespace armjig::parol6
