// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace armjig {

using Duration = std::chrono::nanoseconds;

/// The clock of everything that does no I/O: it stands still until somebody advances it. It has no
/// `now()` on purpose; time is always an argument.
struct VirtualClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<VirtualClock>;
  static constexpr bool is_steady = true;
};

/// A moment of virtual time; zero is the moment a device enters its main loop. Reaches 292 years.
using Instant = VirtualClock::time_point;

[[nodiscard]] constexpr Instant at(Duration since_start) noexcept { return Instant{since_start}; }

/// Whole microseconds since the start, the unit of golden-trace files, rounded down.
[[nodiscard]] constexpr std::int64_t microseconds(Instant t) noexcept {
  return std::chrono::floor<std::chrono::microseconds>(t.time_since_epoch()).count();
}

/// Since the start, for people.
[[nodiscard]] constexpr double seconds(Instant t) noexcept {
  return std::chrono::duration<double>{t.time_since_epoch()}.count();
}

}  // namespace armjig
