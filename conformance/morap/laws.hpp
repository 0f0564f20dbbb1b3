// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

#include "conformance/morap/motors.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/morap/controller_set.hpp"

/// What a node computes, as the suite reads docs/spec/morap.md: in double precision, as plain as
/// the formulas there. The emulator computes by itself (emulators/morap), and nothing is shared but
/// figures and codecs; tests/unit/conformance/morap/laws_test.cpp compares the two.
namespace armjig::morap::conformance {

/// From one tick to the next, rounded up to nanoseconds. Requires a rate above 0.
[[nodiscard]] Duration tick_period(std::uint16_t rate_hz) noexcept;

/// The nearest level to a voltage within the limit of the output.
[[nodiscard]] int levels_of(double volts) noexcept;

/// What follows from the figures of a motor. SI units, at the output shaft.
class MotorLaw {
 public:
  explicit MotorLaw(const Motor& motor) noexcept;

  /// Of a shaft that has turned by so many counts.
  [[nodiscard]] double angle(int counts) const noexcept;
  /// The amount of that for a torque.
  [[nodiscard]] double current(double torque) const noexcept;
  /// The voltage for a torque, whose current is limited.
  [[nodiscard]] double torque_voltage(double torque, double speed) const noexcept;
  /// Keeps the current of a voltage within the rated one.
  [[nodiscard]] double limited(double volts, double speed) const noexcept;
  /// That of a load with which the motor's own pole is at `-pole`.
  [[nodiscard]] double inertia(double pole) const noexcept;

 private:
  double resistance_;
  double gear_ratio_;
  double back_emf_;        ///< K n
  double torque_per_amp_;  ///< eta K n
  double friction_;
  double rated_current_;
  double counts_per_turn_;  ///< of the motor
};

/// A feedback loop that begins again where the shaft stands.
class LoopLaw {
 public:
  LoopLaw(const Motor& motor, const ControllerSet& set, double angle, double reference);

  /// The voltage that follows from the next sample; it is applied one tick later.
  [[nodiscard]] double step(double angle, double reference);

 private:
  /// From the measured value, or from the reference, to the output. Newest first.
  struct Path {
    std::deque<double> samples;
    std::deque<double> outputs;
    double integral = 0;

    [[nodiscard]] double filter(const Coefficients& of_samples, const Coefficients& of_outputs,
                                double sample);
  };

  MotorLaw motor_;
  ControllerSet set_;
  Path feedback_;
  Path feedforward_;
  double last_angle_;
  double speed_ = 0;
  bool is_limited_ = false;
};

}  // namespace armjig::morap::conformance
