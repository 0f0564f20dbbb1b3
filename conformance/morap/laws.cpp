// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/laws.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/wire/morap/figures.hpp"

namespace armjig::morap::conformance {

/// The one law that counts bits: the period is cut from a number in single precision.
Duration tick_period(std::uint16_t rate_hz) noexcept {
  const auto top = [rate_hz](int scale) {
    const float seconds = 1.0F / static_cast<float>(rate_hz);
    return seconds * (1e6F * kClocksPerMicrosecond / static_cast<float>(scale));
  };
  int scale = 1;
  while (top(scale) >= 65535.0F) scale = scale == 1 ? 8 : scale == 8 ? 64 : 256;
  const auto clocks = (static_cast<std::int64_t>(top(scale)) + 1) * scale;
  return Duration{(clocks * 1000 + kClocksPerMicrosecond - 1) / kClocksPerMicrosecond};
}

int levels_of(double volts) noexcept {
  const double limit{kVoltageLimit};
  return static_cast<int>(
      std::floor(std::clamp(volts, -limit, limit) / double{kVoltsPerLevel} + 0.5));
}

MotorLaw::MotorLaw(const Motor& motor) noexcept
    : resistance_{motor.known.constants.resistance},
      gear_ratio_{motor.known.constants.gear_ratio},
      back_emf_{double{motor.known.constants.torque_constant} * gear_ratio_},
      torque_per_amp_{motor.known.constants.efficiency * back_emf_},
      friction_{motor.known.constants.friction},
      rated_current_{motor.known.constants.rated_current},
      counts_per_turn_{4 * double{motor.known.constants.pulses_per_turn}} {}

double MotorLaw::angle(int counts) const noexcept {
  return 2 * std::numbers::pi * counts / counts_per_turn_ / gear_ratio_;
}

double MotorLaw::current(double torque) const noexcept {
  return std::min(std::fabs(torque) / torque_per_amp_, rated_current_);
}

double MotorLaw::torque_voltage(double torque, double speed) const noexcept {
  const double current = std::clamp(torque / torque_per_amp_, -rated_current_, rated_current_);
  return back_emf_ * speed + resistance_ * current;
}

double MotorLaw::limited(double volts, double speed) const noexcept {
  const double spare = resistance_ * rated_current_;
  return std::clamp(volts, back_emf_ * speed - spare, back_emf_ * speed + spare);
}

double MotorLaw::inertia(double pole) const noexcept {
  return (torque_per_amp_ * back_emf_ / resistance_ + friction_) / pole;
}

LoopLaw::LoopLaw(const Motor& motor, const ControllerSet& set, double angle, double reference)
    : motor_{motor}, set_{set}, last_angle_{angle} {
  const bool is_speed = set.kind == ControllerKind::kSpeed;
  feedback_.samples.assign(kMostCoefficients, is_speed ? 0 : angle);
  feedforward_.samples.assign(kMostCoefficients, reference);
  feedback_.outputs.assign(kMostCoefficients, 0);
  feedforward_.outputs.assign(kMostCoefficients, 0);
}

double LoopLaw::Path::filter(const Coefficients& of_samples, const Coefficients& of_outputs,
                             double sample) {
  samples.push_front(sample);
  samples.pop_back();
  double sum = 0;
  for (std::size_t ago = 0; ago < of_samples.count; ++ago) {
    sum += of_samples.values[of_samples.count - 1 - ago] * samples[ago];
  }
  for (std::size_t ago = 0; ago < of_outputs.count; ++ago) {
    sum -= of_outputs.values[of_outputs.count - 1 - ago] * outputs[ago];
  }
  outputs.push_front(sum);
  outputs.pop_back();
  return sum;
}

double LoopLaw::step(double angle, double reference) {
  const double turned = (angle - last_angle_) * set_.rate_hz;
  last_angle_ = angle;
  const double measured = set_.kind == ControllerKind::kSpeed ? turned : angle;
  const double ufb = feedback_.filter(set_.d, set_.f, measured);
  const double uff = feedforward_.filter(set_.c, set_.f, reference);
  if (set_.integral > 0 && !is_limited_) {
    feedback_.integral += set_.integral * measured;
    feedforward_.integral += set_.integral * reference;
  }
  const double wanted = uff + feedforward_.integral - ufb - feedback_.integral;
  speed_ = 0.2 * turned + 0.8 * speed_;
  const double limit{kVoltageLimit};
  const double volts = motor_.limited(std::clamp(wanted, -limit, limit), speed_);
  is_limited_ = volts != wanted;
  return volts;
}

}  // namespace armjig::morap::conformance
