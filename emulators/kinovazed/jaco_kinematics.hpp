// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "emulators/kinovazed/pose.hpp"

/// A JACO 2 with six joints and the curved wrist (j2n6s300): `arm::JacoVariant::kJaco2Curved` in
/// the server's words.
namespace armjig::kinovazed::emulation {

/// As the arm reports them, in degrees; joints 1, 4, 5 and 6 turn without end.
using JointAngles = std::array<double, 6>;

inline constexpr JointAngles kReadyAngles{275.2882, 167.5798, 57.4104, 240.8248, 82.8382, 75.8195};

[[nodiscard]] Pose forward(const JointAngles& angles) noexcept;

/// Turned for so long at shares of their greatest speeds, as far as the joints go.
[[nodiscard]] JointAngles turned(JointAngles angles, const std::array<double, 6>& speeds,
                                 double seconds) noexcept;

/// Joint angles for a pose, near `seed` if that leads there; none if the arm cannot reach it.
[[nodiscard]] std::optional<JointAngles> solve(const Pose& pose, const JointAngles& seed) noexcept;

}  // namespace armjig::kinovazed::emulation
