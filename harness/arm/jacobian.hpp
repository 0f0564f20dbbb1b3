// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "harness/arm/arm.hpp"

namespace armjig::arm {

/// How a tool moves: its origin's velocity and its angular velocity, in the base's frame.
struct Twist {
  Vector3 linear{};
  Vector3 angular{};
};

/// The tool's twist for one unit per second of each joint: a column for each joint.
using Jacobian = PerJoint<Twist>;
[[nodiscard]] Jacobian jacobian(const Arm& arm, std::span<const double> joints) noexcept;

/// What an arm can still do in a posture.
struct Dexterity {
  /// Yoshikawa's measure, sqrt(det(J J^T)), of metres and radians mixed: 0 at a singularity.
  double manipulability{};
  /// The smallest singular value of J: how fast the tool still moves in its worst direction. The
  /// distance to the nearest singular Jacobian.
  double smallest_singular_value{};
  double condition{};  ///< largest by smallest singular value; infinite at a singularity
};
/// Lengths are divided by `unit_length` metres first, to compare them with angles.
[[nodiscard]] Dexterity dexterity(const Jacobian& jacobian, double unit_length = 1.0) noexcept;

}  // namespace armjig::arm
