// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

#include "harness/arm/pose.hpp"
#include "harness/motion/parol6/planner.hpp"

/// Moves in which the tool leads, by either rules. `plan` in planner.hpp is their caller.
namespace armjig::parol6::planning {

/// What a line takes if its command does not say it: the commander's figure, seconds.
inline constexpr double kDefaultLineDuration = 3.6;

/// Where a line ends, seen from where it begins: metres.
struct LineTarget {
  arm::Pose pose{};
  bool is_relative{};  ///< to the tool as it is at the start

  [[nodiscard]] arm::Pose from(const arm::Pose& start) const noexcept {
    return is_relative ? start * pose : pose;
  }
};

[[nodiscard]] tl::expected<Plan, Refusal> plan_documented_line(const LineTarget& target,
                                                               const JointSteps& start,
                                                               const Timing& timing,
                                                               Tracking tracking,
                                                               const PlannerSettings& settings);

/// The share of the commander's way, 0 to 1, at `t` seconds of `last`. The program passes its
/// profile where its kinematics library expects times, and so gets a trapezoid on top.
[[nodiscard]] double commander_path_share(Law law, double t, double last) noexcept;

[[nodiscard]] tl::expected<Plan, Refusal> plan_commander_line(const LineTarget& target,
                                                              const JointSteps& start,
                                                              const Timing& timing,
                                                              Tracking tracking);

}  // namespace armjig::parol6::planning
