// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "harness/core/time.hpp"

namespace armjig::cli {

/// Keeps virtual time from running ahead of a person who looks on.
class Pace {
 public:
  enum class By : std::uint8_t {
    kPort,  ///< the port waits by itself, or nobody looks on
    kWallClock,
  };

  /// From now on, which is `start` on the port.
  Pace(By by, Instant start) : by_{by}, start_{start} {}

  /// How long to wait before the port's time may reach `time`; at least 0.
  [[nodiscard]] Duration until(Instant time) const {
    if (by_ == By::kPort) return {};
    const auto passed = std::chrono::steady_clock::now() - wall_start_;
    return std::max(time - start_ - std::chrono::duration_cast<Duration>(passed), Duration{});
  }

 private:
  By by_;
  Instant start_;
  std::chrono::steady_clock::time_point wall_start_ = std::chrono::steady_clock::now();
};

}  // namespace armjig::cli
