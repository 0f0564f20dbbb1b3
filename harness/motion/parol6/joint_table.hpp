// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "harness/core/quantity.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::planning {

/// What a joint of PAROL6 may do, as the vendor's host programs have it.
struct JointRange {
  Degrees lower{};
  Degrees upper{};
  StepsPerSecond max_speed{};      ///< of the commander; the API has another table
  StepsPerSecond max_jog_speed{};  ///< of the commander
  double max_acceleration{};       ///< steps/s^2: the larger of the API's and the commander's
  Steps standby{};                 ///< what homing ends with
  Degrees commander_seed{};        ///< where the commander's inverse kinematics begins
};

inline constexpr std::array<JointRange, kJointCount> kJointRanges{{
    {Degrees{-123.046875}, Degrees{123.046875}, StepsPerSecond{6500}, StepsPerSecond{1500}, 45'000,
     Steps{10'240}, Degrees{0}},
    {Degrees{-145.0088}, Degrees{-3.375}, StepsPerSecond{18'000}, StepsPerSecond{3000}, 75'000,
     Steps{-32'000}, Degrees{-90}},
    {Degrees{107.866}, Degrees{287.8675}, StepsPerSecond{20'000}, StepsPerSecond{3600}, 96'000,
     Steps{57'905}, Degrees{180}},
    {Degrees{-105.46975}, Degrees{105.46975}, StepsPerSecond{22'000}, StepsPerSecond{7000}, 32'000,
     Steps{0}, Degrees{0}},
    {Degrees{-90}, Degrees{90}, StepsPerSecond{22'000}, StepsPerSecond{7000}, 32'000, Steps{0},
     Degrees{0}},
    {Degrees{0}, Degrees{360}, StepsPerSecond{22'000}, StepsPerSecond{18'000}, 81'000,
     Steps{32'000}, Degrees{180}},
}};

/// The slowest speed that the hosts command, of every joint.
inline constexpr StepsPerSecond kMinSpeed{100};

/// The commander's range of accelerations in scripts, steps/s^2, one for all joints.
inline constexpr double kMinAcceleration = 100;
inline constexpr double kMaxAcceleration = 32'000;

/// One frame every 10 ms.
inline constexpr double kTick = 0.01;

/// Seconds; a longer move is a slip of the pen.
inline constexpr double kLongestMove = 3600;

[[nodiscard]] constexpr JointSteps standby() noexcept {
  JointSteps steps;
  for (std::size_t j = 0; j < kJointCount; ++j) steps[j] = kJointRanges[j].standby;
  return steps;
}

}  // namespace armjig::parol6::planning
