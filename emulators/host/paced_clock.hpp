// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "harness/core/time.hpp"

namespace armjig {

/// Virtual time at the pace of the wall clock: `speed` times as fast, `begin` at `start`. It loses
/// time only where it is told to.
class PacedClock {
 public:
  using Wall = std::chrono::steady_clock;
  static constexpr double kSlowest = 0.001;
  static constexpr double kFastest = 10'000;

  /// Whether a clock can have that speed; not-a-number cannot.
  [[nodiscard]] static constexpr bool is_speed(double speed) noexcept {
    return speed >= kSlowest && speed <= kFastest;
  }

  /// Requires `is_speed(speed)`.
  PacedClock(double speed, Wall::time_point start, Instant begin = {}) noexcept
      : speed_{speed}, start_{start}, begin_{begin} {}

  [[nodiscard]] Instant virtual_time(Wall::time_point wall) const noexcept {
    const std::chrono::duration<double, std::nano> elapsed = wall - start_;
    return begin_ + std::chrono::duration_cast<Duration>(elapsed * speed_) - lost_;
  }

  /// The wall time at which `virtual_time` reaches `time`, but at most an hour after `now`.
  [[nodiscard]] Wall::time_point wall_time(Instant time, Wall::time_point now) const noexcept {
    const std::chrono::duration<double, std::nano> wait{time - virtual_time(now)};
    constexpr std::chrono::duration<double, std::nano> kLongest = std::chrono::hours{1};
    const auto shortened = std::min(wait / speed_, kLongest);
    return now + std::chrono::ceil<Wall::duration>(shortened);
  }

  /// Puts the clock back, because its owner cannot keep up.
  void lose(Duration behind) noexcept { lost_ += behind; }
  [[nodiscard]] Duration lost() const noexcept { return lost_; }

 private:
  double speed_;
  Wall::time_point start_;
  Instant begin_;
  Duration lost_{};
};

}  // namespace armjig
