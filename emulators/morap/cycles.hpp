// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "harness/core/time.hpp"
#include "harness/wire/morap/figures.hpp"

namespace armjig::morap::emulation {

/// Time as a node counts it: clocks of 62.5 ns since its power-on, which nanoseconds cannot say.
using Cycles = std::int64_t;

inline constexpr Cycles kNever = std::numeric_limits<Cycles>::max() / 128;

/// The last clock that is not after `time`.
[[nodiscard]] constexpr Cycles cycles_at(Instant time) noexcept {
  const auto ns = time.time_since_epoch().count();
  return ns / 125 * 2 + ns % 125 * 2 / 125;  // 125 ns are two clocks
}

/// The first nanosecond that is not before the clock `cycles`.
[[nodiscard]] constexpr Instant instant_of(Cycles cycles) noexcept {
  if (cycles >= kNever) return Instant::max();
  return at(Duration{cycles / 2 * 125 + (cycles % 2 != 0 ? 63 : 0)});
}

}  // namespace armjig::morap::emulation
