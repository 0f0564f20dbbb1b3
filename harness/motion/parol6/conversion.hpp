// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "harness/arm/spherical_wrist.hpp"
#include "harness/core/quantity.hpp"
#include "harness/motion/parol6/joint_table.hpp"

/// Angles and steps as the host programs convert them, operation by operation: where a fraction is
/// cut off, the last bit of a double decides about a step.
namespace armjig::parol6::planning {

inline constexpr double kDegreesPerMotorStep = 360.0 / kMotorStepsPerTurn;
inline constexpr double kRadiansPerMotorStep = 2 * std::numbers::pi / kMotorStepsPerTurn;

[[nodiscard]] constexpr double to_degrees(double radians) noexcept {
  return radians * (180.0 / std::numbers::pi);
}
[[nodiscard]] constexpr double to_radians(double degrees) noexcept {
  return degrees * (std::numbers::pi / 180.0);
}

[[nodiscard]] constexpr double steps_of_degrees(std::size_t joint, double degrees) noexcept {
  return degrees / kDegreesPerMotorStep * kJoints[joint].reduction;
}
[[nodiscard]] constexpr double steps_of_radians(std::size_t joint, double radians) noexcept {
  return steps_of_degrees(joint, to_degrees(radians));
}
/// Of speeds, rad/s to steps/s.
[[nodiscard]] constexpr double step_rate_of(std::size_t joint, double radians) noexcept {
  return radians / kRadiansPerMotorStep * kJoints[joint].reduction;
}
[[nodiscard]] constexpr double degrees_of(std::size_t joint, Steps position) noexcept {
  return position.value * kDegreesPerMotorStep / kJoints[joint].reduction;
}
[[nodiscard]] constexpr double radians_of(std::size_t joint, Steps position) noexcept {
  return to_radians(degrees_of(joint, position));
}
[[nodiscard]] constexpr arm::SixJoints radians_of(const JointSteps& positions) noexcept {
  arm::SixJoints joints{};
  for (std::size_t j = 0; j < kJointCount; ++j) joints[j] = radians_of(j, positions[j]);
  return joints;
}

/// What a set-point has: an integer number, the rest cut off toward zero. Beyond what a frame can
/// hold, the most that it can.
[[nodiscard]] constexpr std::int32_t cut_off(double steps) noexcept {
  return static_cast<std::int32_t>(std::clamp<double>(steps, -kMostSteps, kMostSteps));
}
/// The nearest step, of two equally near the even one: what the board's own constants and the
/// Python API have.
[[nodiscard]] inline std::int32_t nearest_step(double steps) noexcept {
  return cut_off(std::nearbyint(steps));
}

}  // namespace armjig::parol6::planning
