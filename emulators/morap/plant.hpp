// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "emulators/morap/cycles.hpp"
#include "emulators/morap/eeprom.hpp"

namespace armjig::morap::emulation {

/// A motor with its gear, its encoder and what hangs on the output shaft, SI units. Not what the
/// node believes (`MotorConstants`) but what is there.
struct PlantParameters {
  Cycles step = 50 * kClocksPerMicrosecond;  ///< positive
  double resistance{};                       ///< ohm
  double inductance{};                       ///< henry
  double torque_constant{};                  ///< V s / rad at the motor
  double gear_ratio{};
  double efficiency{};
  double inertia{};           ///< kg m^2 at the output shaft
  double viscous_friction{};  ///< N m s / rad at the output shaft
  double dry_friction{};      ///< N m
  double load_torque{};       ///< N m, constant; positive turns forwards
  double counts_per_radian{};
};

/// What is known of a joint, from the constants of its node, with an inertia and a friction of
/// one's own.
[[nodiscard]] PlantParameters plant_of(const MotorConstants& motor, double inertia,
                                       double viscous_friction, double dry_friction = 0.0) noexcept;

/// How the bridge connects the motor.
enum class Bridge : std::uint8_t {
  kShorted,  ///< power-on until the first tick; braked
  kDriven,
  kOpen,  ///< disabled or uncalibrated: it turns freely
};

/// The plant of the recordings (captures/morap/README.md): semi-implicit Euler in double precision,
/// one rounding for each operation.
class Plant {
 public:
  explicit Plant(const PlantParameters& parameters) noexcept;

  /// Does all steps that are due up to and including `time`, which never decreases.
  void advance_to(Cycles time) noexcept;
  /// From the next step on.
  void connect(Bridge bridge, double volts) noexcept;

  [[nodiscard]] std::int64_t encoder() const noexcept;                ///< counts since the start
  [[nodiscard]] double current() const noexcept { return current_; }  ///< A
  [[nodiscard]] double speed() const noexcept { return speed_; }      ///< rad/s at the output
  [[nodiscard]] double angle() const noexcept { return angle_; }      ///< rad at the output

  /// A hand on the shaft: changes the torque on it.
  void set_load_torque(double torque) noexcept { load_torque_ = torque; }

 private:
  template <Bridge bridge>
  void run(std::int64_t steps) noexcept;
  void coast(std::int64_t steps, double turn) noexcept;

  // Products of parameters, each rounded as in the source of the recordings.
  Cycles step_;
  double dt_;
  double back_emf_;  ///< K n
  double dt_over_inductance_;
  double current_divisor_;
  double torque_per_amp_;
  double dt_over_inertia_;
  double speed_divisor_;
  double dry_step_;  ///< what dry friction takes off the speed in one step
  double counts_per_radian_;
  double load_torque_;

  Cycles next_step_;
  Bridge bridge_ = Bridge::kShorted;
  double volts_ = 0.0;
  double current_ = 0.0;
  double speed_ = 0.0;
  double angle_ = 0.0;
};

}  // namespace armjig::morap::emulation
