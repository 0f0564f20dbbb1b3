// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "harness/core/time.hpp"

/// The figures of MORAP nodes that more than one room has to know. What a node computes from them
/// is not here: that stands in emulators/morap and, once more, in conformance/morap. Source:
/// docs/spec/morap.md.
namespace armjig::morap {

/// Motor and gear as a node believes them to be.
struct MotorConstants {
  float resistance{};       ///< ohm, driver included
  float inductance{};       ///< henry; stored, never used
  float torque_constant{};  ///< N m / A and V s, at the motor
  float gear_ratio{};
  float friction{};  ///< N m s, at the output shaft
  float efficiency{};
  float rated_current{};    ///< A
  float pulses_per_turn{};  ///< of the encoder; four counts each
};

/// A joint that was built: a Maxon DCX22L with gear 231:1, or a DCX26L with 149:1.
struct KnownMotor {
  std::string_view name;
  MotorConstants constants;
};
inline constexpr KnownMotor kDcx22l{
    "dcx22l", {2.16F, 0.000192F, 0.0229F, 231.20308F, 0.1F, 0.74F, 1.5F, 128.0F}};
inline constexpr KnownMotor kDcx26l{
    "dcx26l", {1.07F, 0.000129F, 0.0214F, 149.0F, 0.05F, 0.75F, 1.5F, 128.0F}};

inline constexpr std::int64_t kClocksPerMicrosecond = 16;
inline constexpr std::uint16_t kIdleRateHz = 200;      ///< of the tick without a feedback loop
inline constexpr std::uint16_t kHighestRateHz = 1500;  ///< beyond it a node has no time left
inline constexpr float kVoltageLimit = 20.0F;          ///< of the output, V
inline constexpr float kVoltsPerLevel = 0.046875F;     ///< 48 V in 1024 levels
inline constexpr float kLargestInertia = 10.0F;        ///< of a tuning request, kg m^2
inline constexpr float kFastestPole = -200.0F;         ///< likewise, 1/s

/// Time for a tick to pass, between a message that changes parameters and what depends on it:
/// longer than the slowest control period in use. Rates under 200 Hz need more.
inline constexpr Duration kProgrammingPause = std::chrono::milliseconds{10};

}  // namespace armjig::morap
