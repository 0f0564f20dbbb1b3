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
namespace armjig::morap::emulation {

/// The figures and habits by which a node controls its motor. These are the firmware's; a node with
/// others is a faulty one (defects/).
struct Law {
  float voltage_limit = kVoltageLimit;
  float rounding = 0.5F;            ///< levels added before the fraction is cut off
  float newest_speed_share = 0.2F;  ///< in the speed that limits the current of a loop
  float older_speed_share = 0.8F;
  std::uint16_t idle_rate_hz = kIdleRateHz;
  bool delays_output = true;              ///< of a loop, by one tick
  bool limits_loops = true;               ///< to the rated current
  bool bounds_voltage_above = true;       ///< likewise
  bool bounds_voltage_below = true;       ///< where a lower voltage would brake too hard
  bool limits_torque = true;              ///< to the rated current
  bool limits_direct_voltage = false;     ///< the direct mode has no current limit
  bool compensates_motion = true;         ///< in torque mode adds the back-EMF
  bool holds_integrators = true;          ///< after a sample with a limited output
  bool integrates_negative_gain = false;  ///< a negative gain is none
  bool resets_with_mode = true;           ///< a loop begins anew when the mode changes
  bool resets_with_parameters = true;     ///< and when parameters were installed
  bool resets_with_reference = false;     ///< but not with a new reference
  bool begins_with_reference = true;      ///< as if it had always been there
  bool begins_with_angle = true;          ///< as if the shaft had always stood there
  bool runs_uncalibrated = false;         ///< without calibration nothing is driven
  bool waits_with_parameters = true;      ///< new ones are used from the next tick on
  bool acts_at_ticks = true;              ///< and so is a new reference or mode
  bool changes_rate = true;               ///< the tick follows the rate of the loop
};

/// A duty cycle as the node sets it: 0 to 1024, 512 is 0 V.
using Level = std::uint16_t;
inline constexpr Level kZeroVolts = 512;

/// Limits to 20 V and rounds to a level. A voltage that is no number gives 0 V; what a real node
/// makes of one is not known.
[[nodiscard]] Level level_of(float volts, const Law& law = {}) noexcept;
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
  void reset(ControllerKind kind, float angle, float reference, const Law& law = {}) noexcept;

  /// One sample. The voltage before rounding; counts above four in `set` act as four.
  [[nodiscard]] float step(const ControllerSet& set, const Scale& scale, float angle,
                           float reference, const Law& law = {}) noexcept;

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

}  // namespace armjig::morap::emulation
