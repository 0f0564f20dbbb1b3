// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "emulators/kinovazed/pose.hpp"

/// A JACO 2 with six joints and the curved wrist (j2n6s300), by Kinova's published lengths.
namespace armjig::kinovazed::emulation {

/// As the arm reports them, in degrees; joints 1, 4, 5 and 6 turn without end.
using JointAngles = std::array<double, 6>;

inline constexpr JointAngles kReadyAngles{275.2882, 167.5798, 57.4104, 240.8248, 82.8382, 75.8195};

struct JointRange {
  double least;
  double most;
};
inline constexpr JointRange kJoint2Range{47, 313};
inline constexpr JointRange kJoint3Range{19, 341};

[[nodiscard]] Pose forward(const JointAngles& angles) noexcept;

/// Joint angles for a pose, near `seed` if that leads there; none if the arm cannot reach it.
[[nodiscard]] std::optional<JointAngles> solve(const Pose& pose, const JointAngles& seed) noexcept;

}  // namespace armjig::kinovazed::emulation
