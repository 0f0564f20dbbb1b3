// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace armjig::parol6::emulation {
namespace {

constexpr double kMicrosPerSecond = 1'000'000.0;
constexpr double kFirstStepCorrection = 0.676;

std::uint32_t interval_of(float speed) noexcept {
  return static_cast<std::uint32_t>(std::abs(kMicrosPerSecond / static_cast<double>(speed)));
}

/// Toward zero; what does not fit saturates, as the conversion on the board does.
std::int32_t truncated(double value) noexcept {
  if (value >= 2147483647.0) return INT32_MAX;
  if (value <= -2147483648.0) return INT32_MIN;
  return static_cast<std::int32_t>(value);
}

/// Counters wrap as on the board, where overflow is what the processor does.
std::int32_t wrapping_add(std::int32_t a, std::int32_t b) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
std::int32_t wrapping_sub(std::int32_t a, std::int32_t b) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
std::int32_t wrapping_mul(std::int32_t a, std::int32_t b) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b));
}

}  // namespace

StepRate go_to_speed(Steps position, Steps goal, StepsPerSecond feed) noexcept {
  constexpr std::int32_t kPerSecond = 100;  // close the distance in 10 ms
  const auto closing = wrapping_mul(kPerSecond, wrapping_sub(goal.value, position.value));
  return to_rate(StepsPerSecond{wrapping_add(feed.value, closing) / 2});
}

Stepper::Stepper() noexcept {
  set_acceleration(StepsPerSecond2{1.0F});
  set_max_speed(StepRate{1.0F});
}

std::int32_t Stepper::steps_to_stop() const noexcept {
  // The square is rounded to single precision before the division in double.
  const float square = speed_ * speed_;
  return truncated(static_cast<double>(square) / (2.0 * static_cast<double>(acceleration_)));
}

void Stepper::compute_new_speed() noexcept {
  const auto distance = wrapping_sub(target_, position_);
  const auto stop = steps_to_stop();
  if (distance == 0 && stop <= 1) {
    interval_ = 0;
    speed_ = 0.0F;
    ramp_index_ = 0;
    return;
  }
  if (distance > 0) {
    if (ramp_index_ > 0) {
      if (stop >= distance || direction_ < 0) ramp_index_ = -stop;
    } else if (ramp_index_ < 0) {
      if (stop < distance && direction_ > 0) ramp_index_ = -ramp_index_;
    }
  } else if (distance < 0) {
    const auto back = wrapping_sub(0, distance);
    if (ramp_index_ > 0) {
      if (stop >= back || direction_ > 0) ramp_index_ = -stop;
    } else if (ramp_index_ < 0) {
      if (stop < back && direction_ < 0) ramp_index_ = -ramp_index_;
    }
  }
  if (ramp_index_ == 0) {
    ramp_interval_ = first_interval_;
    direction_ = distance > 0 ? 1 : -1;
  } else {
    const auto interval = static_cast<double>(ramp_interval_);
    ramp_interval_ = static_cast<float>(interval - 2.0 * interval / (4.0 * ramp_index_ + 1.0));
    ramp_interval_ = std::max(ramp_interval_, min_interval_);
  }
  ramp_index_ = wrapping_add(ramp_index_, 1);
  interval_ = static_cast<std::uint32_t>(ramp_interval_);
  speed_ = static_cast<float>(kMicrosPerSecond / static_cast<double>(ramp_interval_));
  if (direction_ < 0) speed_ = -speed_;
}

void Stepper::set_max_speed(StepRate speed) noexcept {
  const float wanted = std::abs(speed.value);
  if (wanted == max_speed_) return;
  max_speed_ = wanted;
  min_interval_ = static_cast<float>(kMicrosPerSecond / static_cast<double>(wanted));
  if (ramp_index_ > 0) {
    ramp_index_ = steps_to_stop();
    compute_new_speed();
  }
}

void Stepper::set_acceleration(StepsPerSecond2 acceleration) noexcept {
  const float wanted = std::abs(acceleration.value);
  if (wanted == 0.0F || wanted == acceleration_) return;
  const float ratio = acceleration_ / wanted;
  ramp_index_ = truncated(static_cast<double>(static_cast<float>(ramp_index_) * ratio));
  first_interval_ = static_cast<float>(
      kFirstStepCorrection * std::sqrt(2.0 / static_cast<double>(wanted)) * kMicrosPerSecond);
  acceleration_ = wanted;
  compute_new_speed();
}

void Stepper::set_speed(StepRate speed) noexcept {
  if (speed.value == speed_) return;
  const float clamped = std::clamp(speed.value, -max_speed_, max_speed_);
  if (clamped == 0.0F) {
    interval_ = 0;
  } else {
    interval_ = interval_of(clamped);
    direction_ = clamped > 0.0F ? 1 : -1;
  }
  speed_ = clamped;
}

void Stepper::move_to(Steps target) noexcept {
  if (target_ == target.value) return;
  target_ = target.value;
  compute_new_speed();
}

void Stepper::set_position(Steps position) noexcept {
  target_ = position_ = position.value;
  ramp_index_ = 0;
  interval_ = 0;
  speed_ = 0.0F;
}

void Stepper::step(Micros now) noexcept {
  position_ = wrapping_add(position_, direction_);
  last_step_ = now.value;  // the interval restarts from now: lateness is not made up for
}

bool Stepper::run_speed(Micros now) noexcept {
  if (interval_ == 0 || now.value - last_step_ < interval_) return false;
  step(now);
  return true;
}

bool Stepper::run_speed_to_position(Micros now) noexcept {
  if (target_ == position_) return false;
  direction_ = target_ > position_ ? 1 : -1;
  return run_speed(now);
}

bool Stepper::run(Micros now) noexcept {
  const bool stepped = run_speed(now);
  if (stepped) compute_new_speed();
  return stepped;
}

/// The first pass from `pass` on in which `run_speed` takes a step; may lie behind the span.
std::int64_t Stepper::next_due(const PassSpan& span, std::int64_t pass) const noexcept {
  if (interval_ == 0) return kNoPass;
  const std::uint32_t elapsed = span.clock(pass).value - last_step_;
  if (elapsed >= interval_) return pass;
  const std::uint32_t passes = (interval_ - elapsed - 1) / span.period + 1;
  return pass + std::int64_t{passes} * span.period;
}

std::int64_t Stepper::coast_speed(const PassSpan& span, std::int64_t most) noexcept {
  const auto due = next_due(span, span.first);
  if (due > span.last) return kNoPass;
  if (most == 0) return due;
  const std::int64_t stride = std::int64_t{(interval_ - 1) / span.period + 1} * span.period;
  const auto possible = (span.last - due) / stride + 1;
  const auto steps = std::min(possible, most);
  position_ = static_cast<std::int32_t>(static_cast<std::uint32_t>(position_) +
                                        static_cast<std::uint32_t>(direction_) *
                                            static_cast<std::uint32_t>(steps));
  const auto last = due + (steps - 1) * stride;
  last_step_ = span.clock(last).value;
  return steps < possible ? last + stride : kNoPass;
}

std::int64_t Stepper::coast_to_position(const PassSpan& span) noexcept {
  if (target_ == position_) return kNoPass;
  direction_ = target_ > position_ ? 1 : -1;
  const auto distance = static_cast<std::uint32_t>(wrapping_sub(target_, position_)) *
                        static_cast<std::uint32_t>(direction_);
  return coast_speed(span, std::int64_t{distance} - 1);
}

std::int64_t Stepper::coast_ramp(const PassSpan& span) noexcept {
  for (auto pass = next_due(span, span.first); pass <= span.last;
       pass = next_due(span, pass + span.period)) {
    if (wrapping_add(position_, direction_) == target_) return pass;
    step(span.clock(pass));
    compute_new_speed();
  }
  return kNoPass;
}

void Stepper::coast_go_to(const PassSpan& span, Steps goal, StepsPerSecond feed) noexcept {
  for (auto pass = span.first; pass <= span.last; pass += span.period) {
    set_speed(go_to_speed(Steps{position_}, goal, feed));
    pass = next_due(span, pass);
    if (pass > span.last) return;
    step(span.clock(pass));
  }
}

}  // namespace armjig::parol6::emulation
