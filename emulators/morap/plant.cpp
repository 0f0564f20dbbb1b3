// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/plant.hpp"

#include <cmath>
#include <numbers>

namespace armjig::morap::emulation {

PlantParameters plant_of(const MotorConstants& motor, double inertia, double viscous_friction,
                         double dry_friction) noexcept {
  PlantParameters p;
  p.resistance = static_cast<double>(motor.resistance);
  p.inductance = static_cast<double>(motor.inductance);
  p.torque_constant = static_cast<double>(motor.torque_constant);
  p.gear_ratio = static_cast<double>(motor.gear_ratio);
  p.efficiency = static_cast<double>(motor.efficiency);
  p.inertia = inertia;
  p.viscous_friction = viscous_friction;
  p.dry_friction = dry_friction;
  p.counts_per_radian =
      static_cast<double>(motor.pulses_per_turn) * 4.0 * p.gear_ratio / (2.0 * std::numbers::pi);
  return p;
}

Plant::Plant(const PlantParameters& p) noexcept
    : step_{p.step},
      dt_{static_cast<double>(p.step) * 1e-6 / static_cast<double>(kClocksPerMicrosecond)},
      back_emf_{p.torque_constant * p.gear_ratio},
      dt_over_inductance_{dt_ / p.inductance},
      current_divisor_{1.0 + dt_over_inductance_ * p.resistance},
      torque_per_amp_{p.efficiency * p.torque_constant * p.gear_ratio},
      dt_over_inertia_{dt_ / p.inertia},
      speed_divisor_{1.0 + dt_over_inertia_ * p.viscous_friction},
      dry_step_{dt_over_inertia_ * p.dry_friction / speed_divisor_},
      counts_per_radian_{p.counts_per_radian},
      load_torque_{p.load_torque},
      next_step_{p.step} {}

void Plant::advance_to(Cycles time) noexcept {
  if (time < next_step_) return;
  const auto steps = (time - next_step_) / step_ + 1;
  next_step_ += steps * step_;
  if (bridge_ == Bridge::kOpen) {
    run<Bridge::kOpen>(steps);
  } else {
    run<Bridge::kDriven>(steps);  // a short is a drive with 0 V
  }
}

void Plant::connect(Bridge bridge, double volts) noexcept {
  bridge_ = bridge;
  volts_ = bridge == Bridge::kDriven ? volts : 0.0;
}

std::int64_t Plant::encoder() const noexcept {
  return static_cast<std::int64_t>(std::floor(angle_ * counts_per_radian_ + 0.5));
}

template <Bridge bridge>
void Plant::run(std::int64_t steps) noexcept {
  double current = bridge == Bridge::kOpen ? 0.0 : current_;
  double speed = speed_;
  for (; steps > 0; --steps) {
    const double last_current = current;
    const double last_speed = speed;
    if constexpr (bridge != Bridge::kOpen) {
      const double induced = volts_ - back_emf_ * speed;
      current = (current + dt_over_inductance_ * induced) / current_divisor_;
    }
    const double torque = torque_per_amp_ * current + load_torque_;
    const double free_speed = (speed + dt_over_inertia_ * torque) / speed_divisor_;
    if (free_speed > dry_step_) {
      speed = free_speed - dry_step_;
    } else if (free_speed < -dry_step_) {
      speed = free_speed + dry_step_;
    } else {
      speed = 0.0;
    }
    angle_ = angle_ + dt_ * speed;
    if (current == last_current && speed == last_speed) {
      coast(steps - 1, dt_ * speed);
      break;
    }
  }
  current_ = current;
  speed_ = speed;
}

/// Current and speed have settled, so that all further steps turn the shaft by the same.
void Plant::coast(std::int64_t steps, double turn) noexcept {
  if (turn == 0.0) return;
  for (; steps > 0; --steps) angle_ = angle_ + turn;
}

}  // namespace armjig::morap::emulation
