// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "emulators/morap/cycles.hpp"
#include "emulators/morap/eeprom.hpp"
#include "harness/wire/morap/controller_set.hpp"

/// The arithmetic of a node: single precision, one rounding for each operation, in the order of
/// docs/spec/morap.md. Values that the firmware computes anew at each tick from the same constants
/// are computed once.
namespace armjig::morap {

/// Of the output, V. The power stage could do 24.
inline constexpr float kVoltageLimit = 20.0F;

/// A duty cycle as the node sets it: 0 to 1024, 512 is 0 V, a step 46.875 mV.
using Level = std::uint16_t;
inline constexpr Level kZeroVolts = 512;

/// Limits to 20 V and rounds to a level. A voltage that is no number gives 0 V; what a real node
/// makes of one is not known.
[[nodiscard]] Level level_of(float volts) noexcept;
[[nodiscard]] float volts_of(Level level) noexcept;

/// The figures that a node derives from its motor.
struct Scale {
  explicit Scale(const MotorConstants& motor) noexcept;

  float quantum;  ///< of the encoder, rad at the motor
  float gear_ratio;
  float back_emf;        ///< K n, V s / rad at the output
  float torque_per_amp;  ///< at the output
  float resistance;
  float rated_current;
  float limit_voltage;  ///< that drives the rated current at standstill

  [[nodiscard]] float angle(std::int32_t count) const noexcept;
  /// Towards zero. Outside of 32 bits the nearest that there is; a real node is not known there.
  [[nodiscard]] std::int32_t count(float angle) const noexcept;
  /// Keeps the current at that speed within the rated one: raises, too.
  [[nodiscard]] float limit_current(float volts, float speed) const noexcept;
};

/// The period of the tick for a rate: the smallest prescaler with which it fits, or the slowest.
[[nodiscard]] Cycles tick_period(std::uint16_t rate_hz) noexcept;

/// The loop of the position and speed modes.
class FeedbackLoop {
 public:
  /// Forgets everything; the shaft is at `angle`.
  void reset(ControllerKind kind, float angle, float reference) noexcept;

  /// One sample. The voltage before rounding; counts above four in `set` act as four.
  [[nodiscard]] float step(const ControllerSet& set, const Scale& scale, float angle,
                           float reference) noexcept;

 private:
  using History = std::array<float, kMostCoefficients>;  ///< newest first

  History y_{};
  History r_{};
  History feedback_{};     ///< outputs of the filter of `y_`, without the integral
  History feedforward_{};  ///< of `r_`
  float feedback_integral_ = 0.0F;
  float feedforward_integral_ = 0.0F;
  float last_angle_ = 0.0F;
  float speed_ = 0.0F;  ///< filtered
  bool is_saturated_ = false;
};

}  // namespace armjig::morap
