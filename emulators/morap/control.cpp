// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace armjig::morap::emulation {
namespace {

constexpr float kSupply = 24.0F;
constexpr float kClockHz = 1e6F * kClocksPerMicrosecond;
constexpr float kTwoPi = 6.28318530717958647692F;

/// Sum of filter[i] times the sample i places from the oldest that the filter reaches.
float weighted(const Coefficients& filter,
               const std::array<float, kMostCoefficients>& newest_first) noexcept {
  const std::size_t count = std::min<std::size_t>(filter.count, kMostCoefficients);
  float sum = 0.0F;
  for (std::size_t i = 0; i < count; ++i) sum += filter.values[i] * newest_first[count - 1 - i];
  return sum;
}

void push(std::array<float, kMostCoefficients>& newest_first, float value) noexcept {
  std::shift_right(newest_first.begin(), newest_first.end(), 1);
  newest_first[0] = value;
}

/// A filter with zeros from `numerator` and poles from `denominator`. All terms of the first are
/// added, then those of the second taken off one by one.
float filtered(const Coefficients& numerator, const std::array<float, kMostCoefficients>& samples,
               const Coefficients& denominator,
               const std::array<float, kMostCoefficients>& outputs) noexcept {
  float sum = weighted(numerator, samples);
  const std::size_t count = std::min<std::size_t>(denominator.count, kMostCoefficients);
  for (std::size_t i = 0; i < count; ++i) sum -= denominator.values[i] * outputs[count - 1 - i];
  return sum;
}

float clamp_voltage(float volts, const Law& law) noexcept {
  if (volts > law.voltage_limit) return law.voltage_limit;
  return volts < -law.voltage_limit ? -law.voltage_limit : volts;
}

}  // namespace

Level level_of(float volts, const Law& law) noexcept {
  if (std::isnan(volts)) return kZeroVolts;
  const float duty = 0.5F * clamp_voltage(volts, law) / kSupply + 0.5F;
  return static_cast<Level>(4.0F * duty * 256.0F + law.rounding);
}

float volts_of(Level level) noexcept {
  return (static_cast<float>(level) - static_cast<float>(kZeroVolts)) * kVoltsPerLevel;
}

Scale::Scale(const MotorConstants& motor) noexcept
    : quantum{kTwoPi / (motor.pulses_per_turn * 4.0F)},
      gear_ratio{motor.gear_ratio},
      back_emf{motor.torque_constant * motor.gear_ratio},
      torque_per_amp{motor.efficiency * motor.torque_constant * motor.gear_ratio},
      resistance{motor.resistance},
      rated_current{motor.rated_current},
      limit_voltage{motor.resistance * motor.rated_current} {}

float Scale::angle(std::int32_t count) const noexcept {
  return quantum * static_cast<float>(count) / gear_ratio;
}

std::int32_t Scale::count(float angle) const noexcept {
  const float count = angle * gear_ratio / quantum;
  constexpr float kLimit = 2147483648.0F;
  if (std::isnan(count)) return 0;
  if (count >= kLimit) return std::numeric_limits<std::int32_t>::max();
  if (count < -kLimit) return std::numeric_limits<std::int32_t>::min();
  return static_cast<std::int32_t>(count);
}

float Scale::limit_current(float volts, float speed) const noexcept {
  const float high = back_emf * speed + limit_voltage;
  const float low = back_emf * speed - limit_voltage;
  if (volts > high) return high;
  return volts < low ? low : volts;
}

Cycles tick_period(std::uint16_t rate_hz) noexcept {
  constexpr float kTooMuch = 65535.0F;
  for (const int prescaler : {1, 8, 64, 256}) {
    const float clocks =
        1.0F / static_cast<float>(rate_hz) * (kClockHz / static_cast<float>(prescaler));
    if (clocks < kTooMuch) return (static_cast<Cycles>(clocks) + 1) * prescaler;
  }
  return Cycles{65536} * 256;
}

void FeedbackLoop::reset(ControllerKind kind, float angle, float reference,
                         const Law& law) noexcept {
  *this = FeedbackLoop{};
  if (kind == ControllerKind::kPosition && law.begins_with_angle) y_.fill(angle);
  if (law.begins_with_reference) r_.fill(reference);
  last_angle_ = angle;
}

float FeedbackLoop::step(const ControllerSet& set, const Scale& scale, float angle, float reference,
                         const Law& law) noexcept {
  const float ts = 1.0F / static_cast<float>(set.rate_hz);
  const float turned = (angle - last_angle_) / ts;
  push(y_, set.kind == ControllerKind::kPosition ? angle : turned);
  push(r_, reference);
  const float feedback = filtered(set.d, y_, set.f, feedback_);
  const float feedforward = filtered(set.c, r_, set.f, feedforward_);
  // Both integrators stand still after a sample with a limited output, and for a negative gain.
  const bool is_held = is_saturated_ && law.holds_integrators;
  if ((set.integral > 0.0F || law.integrates_negative_gain) && !is_held) {
    feedforward_integral_ += set.integral * r_[0];
    feedback_integral_ += set.integral * y_[0];
  }
  const float wanted = (feedforward + feedforward_integral_) - (feedback + feedback_integral_);
  speed_ = law.newest_speed_share * turned + law.older_speed_share * speed_;
  const float possible = clamp_voltage(wanted, law);
  const float volts = law.limits_loops ? scale.limit_current(possible, speed_) : possible;
  is_saturated_ = volts != wanted;
  push(feedback_, feedback);
  push(feedforward_, feedforward);
  last_angle_ = angle;
  return volts;
}

}  // namespace armjig::morap::emulation
