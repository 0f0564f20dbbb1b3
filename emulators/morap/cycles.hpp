// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "harness/core/time.hpp"

namespace armjig::morap {

/// Time as a node counts it: clocks of 62.5 ns since its power-on, which nanoseconds cannot say.
using Cycles = std::int64_t;

inline constexpr Cycles kCyclesPerMicrosecond = 16;
inline constexpr float kClockHz = 16e6F;

/// The last clock that is not after `time`.
[[nodiscard]] constexpr Cycles cycles_at(Instant time) noexcept {
  const auto ns = time.time_since_epoch().count();
  return ns / 125 * 2 + ns % 125 * 2 / 125;  // 125 ns are two clocks
}

}  // namespace armjig::morap
