// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

#include "harness/arm/spherical_wrist.hpp"
#include "harness/motion/parol6/planner.hpp"

/// Moves in which the joints lead, by either rules. `plan` in planner.hpp is their caller.
namespace armjig::parol6::planning {

/// To the step nearest to each angle (radians). `defaults` has what `timing` may leave out.
[[nodiscard]] tl::expected<Plan, Refusal> plan_documented_joints(const arm::SixJoints& target,
                                                                 const JointSteps& start,
                                                                 const Timing& timing,
                                                                 Tracking tracking,
                                                                 LimitCheck limits);

/// The target of a commander's move: what it compares and interpolates, and what it counts.
struct CommanderTarget {
  arm::SixJoints radians{};       ///< 1e-7 beyond what was asked for
  JointSteps steps{};             ///< fractions cut off
  double default_speed{};         ///< percent
  double default_acceleration{};  ///< percent
};
[[nodiscard]] tl::expected<Plan, Refusal> plan_commander_joints(const CommanderTarget& target,
                                                                const JointSteps& start,
                                                                const Timing& timing,
                                                                Tracking tracking,
                                                                LimitCheck limits);

}  // namespace armjig::parol6::planning
