// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "harness/core/time.hpp"

namespace armjig {

/// A period on absolute deadlines: a late cycle does not move the ones behind it, and whole periods
/// that passed by are skipped and counted, never made up for in a burst. No I/O and no clock of its
/// own.
class PeriodicSchedule {
 public:
  struct Cycle {
    Instant deadline{};
    Duration lateness{};      ///< of this cycle, at least 0
    std::uint64_t skipped{};  ///< deadlines before this one that nobody served
  };

  /// The first deadline is `first`. Requires `period > 0`.
  PeriodicSchedule(Instant first, Duration period) noexcept : next_{first}, period_{period} {}

  [[nodiscard]] Instant next() const noexcept { return next_; }
  [[nodiscard]] Duration period() const noexcept { return period_; }

  /// Begins the cycle that is due. Requires `now >= next()`.
  Cycle begin(Instant now) noexcept {
    const auto skipped = (now - next_) / period_;
    const auto deadline = next_ + skipped * period_;
    next_ = deadline + period_;
    return {deadline, now - deadline, static_cast<std::uint64_t>(skipped)};
  }

  /// Skips what came due while the cycle was served, which would be served in a burst. How many.
  std::uint64_t skip_until(Instant now) noexcept {
    if (now < next_) return 0;
    const auto skipped = (now - next_) / period_ + 1;
    next_ += skipped * period_;
    return static_cast<std::uint64_t>(skipped);
  }

 private:
  Instant next_;
  Duration period_;
};

}  // namespace armjig
