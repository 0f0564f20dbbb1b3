// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/arm/pose.hpp"
#include "harness/arm/spherical_wrist.hpp"

namespace armjig::parol6::planning {

/// What the commander's inverse kinematics ends with. Not a good one: it knows no limits, does not
/// start again, mixes metres with radians and may stop 10 um beside the pose. Lines of the
/// commander are made of it; everything else has arm/spherical_wrist.hpp and arm/numeric_ik.hpp.
struct CommanderIkAnswer {
  arm::SixJoints joints{};  ///< in (-pi, pi], but for a seed that was good already
  bool has_converged{};
  int iterations{};
};
inline constexpr int kCommanderIkIterations = 60;

[[nodiscard]] CommanderIkAnswer commander_ik(const arm::Arm& arm, const arm::Pose& pose,
                                             const arm::SixJoints& seed,
                                             int iterations = kCommanderIkIterations) noexcept;

}  // namespace armjig::parol6::planning
