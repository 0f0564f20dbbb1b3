// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

#include "harness/core/quantity.hpp"
#include "harness/wire/parol6/joints.hpp"

namespace armjig::parol6::planning {

/// What planning needs of a joint beside `kJoints`.
struct PlannedJoint {
  double max_acceleration{};  ///< steps/s^2: the larger of the API's and the commander's
  Degrees commander_seed{};   ///< where the commander's inverse kinematics begins
};

inline constexpr std::array<PlannedJoint, kJointCount> kPlannedJoints{{
    {45'000, Degrees{0}},
    {75'000, Degrees{-90}},
    {96'000, Degrees{180}},
    {32'000, Degrees{0}},
    {32'000, Degrees{0}},
    {81'000, Degrees{180}},
}};

/// The slowest speed that the hosts command, of every joint.
inline constexpr StepsPerSecond kMinSpeed{100};

/// The commander's range of accelerations in scripts, steps/s^2, one for all joints.
inline constexpr double kMinAcceleration = 100;
inline constexpr double kMaxAcceleration = 32'000;

/// From frame to frame, in seconds.
inline constexpr double kTick = std::chrono::duration<double>{kFramePeriod}.count();

/// Seconds; a longer move is a slip of the pen.
inline constexpr double kLongestMove = 3600;

}  // namespace armjig::parol6::planning
