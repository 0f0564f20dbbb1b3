// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "harness/core/quantity.hpp"

namespace armjig::parol6::emulation {

/// The board's free-running microsecond clock; it wraps after 71.6 minutes.
struct Micros {
  std::uint32_t value{};
};

/// A stretch of the main loop: passes at `first`, `first + period`, ... up to `last`, in
/// microseconds of virtual time. The microsecond clock reads `time + clock_offset`.
struct PassSpan {
  std::int64_t first{};
  std::int64_t last{};
  std::uint32_t period{};
  std::uint32_t clock_offset{};

  [[nodiscard]] Micros clock(std::int64_t time) const noexcept {
    return {static_cast<std::uint32_t>(time) + clock_offset};
  }
};

/// No pass: what a function that looks for one answers when there is none in the span.
inline constexpr std::int64_t kNoPass = INT64_MAX;

/// The step generator of one joint, as the board's library computes it: state in single precision,
/// ramp formulas in double, truncation toward zero, 32-bit wrapping clocks and counters. A ramp is
/// a speed that changes by a recurrence with each step; `ramp_index` counts along it and is
/// negative while slowing down (docs/spec/parol6.md, "Stepping").
///
/// Operations named like the library's act on one pass of the main loop. The `coast_…` ones do the
/// same for a whole span of passes in which nothing else happens to the joint; a property test
/// holds both together.
class Stepper {
 public:
  Stepper() noexcept;

  [[nodiscard]] Steps position() const noexcept { return Steps{position_}; }
  [[nodiscard]] Steps target() const noexcept { return Steps{target_}; }
  /// Negative backward. Set, not measured.
  [[nodiscard]] StepRate speed() const noexcept { return StepRate{speed_}; }
  /// Of the next step: +1 or -1. Not always the sign of the speed.
  [[nodiscard]] std::int32_t direction() const noexcept { return direction_; }
  [[nodiscard]] std::uint32_t interval_us() const noexcept { return interval_; }
  [[nodiscard]] std::int32_t ramp_index() const noexcept { return ramp_index_; }
  [[nodiscard]] bool is_running() const noexcept { return speed_ != 0.0F || target_ != position_; }

  void set_max_speed(StepRate speed) noexcept;
  void set_acceleration(StepsPerSecond2 acceleration) noexcept;
  /// Sets a constant speed, clamped to the maximum. Asking for the speed that is set already does
  /// nothing at all, not even to the direction (parol6.step.same-speed-keeps-direction).
  void set_speed(StepRate speed) noexcept;
  void move_to(Steps target) noexcept;
  /// Re-defines the counter; the joint stands still afterwards.
  void set_position(Steps position) noexcept;

  /// Takes a step if one is due. True if it did.
  bool run_speed(Micros now) noexcept;
  /// The same, toward the target and not beyond.
  bool run_speed_to_position(Micros now) noexcept;
  /// Takes a step of the ramp toward the target if one is due, then computes the next interval.
  bool run(Micros now) noexcept;

  /// `run_speed` in each pass of the span, at most `most` steps. Answers the pass in which the
  /// step after those is due; `kNoPass` if that is behind the span.
  std::int64_t coast_speed(const PassSpan& span, std::int64_t most = kNoLimit) noexcept;
  /// `run_speed_to_position` in each pass, stopping in front of the step that arrives: the answer.
  std::int64_t coast_to_position(const PassSpan& span) noexcept;
  /// `run` in each pass, stopping in front of a step that lands on the target: the answer.
  std::int64_t coast_ramp(const PassSpan& span) noexcept;
  /// `set_speed(go_to_speed(…))` and `run_speed` in each pass.
  void coast_go_to(const PassSpan& span, Steps goal, StepsPerSecond feed) noexcept;

  friend bool operator==(const Stepper&, const Stepper&) = default;

 private:
  static constexpr std::int64_t kNoLimit = INT64_MAX;

  [[nodiscard]] std::int32_t steps_to_stop() const noexcept;
  void compute_new_speed() noexcept;
  void step(Micros now) noexcept;
  [[nodiscard]] std::int64_t next_due(const PassSpan& span, std::int64_t pass) const noexcept;

  std::int32_t position_ = 0;
  std::int32_t target_ = 0;
  std::int32_t ramp_index_ = 0;
  std::int32_t direction_ = -1;
  std::uint32_t interval_ = 0;   ///< microseconds; 0: no steps
  std::uint32_t last_step_ = 0;  ///< microsecond clock
  float speed_ = 0.0F;
  float max_speed_ = 0.0F;
  float acceleration_ = 0.0F;
  float first_interval_ = 0.0F;  ///< of a ramp from rest
  float ramp_interval_ = 0.0F;   ///< current one, before truncation
  float min_interval_ = 1.0F;
};

/// The board's go-to law: the mean of the feed speed and of the speed that would close the
/// distance in 10 ms, in wrapping 32-bit integers, halved toward zero.
[[nodiscard]] StepRate go_to_speed(Steps position, Steps goal, StepsPerSecond feed) noexcept;

}  // namespace armjig::parol6::emulation
