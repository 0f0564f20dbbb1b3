// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "harness/core/time.hpp"

namespace armjig {

/// Counts durations in log-linear buckets: within 1.6 % of the value up to 18 minutes, in fixed
/// memory, so that recording costs nothing in a cycle loop. Smallest and largest are exact.
class LatencyHistogram {
 public:
  /// Negative durations count as 0, those beyond the range as the largest.
  void record(Duration duration) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// 0 if nothing was recorded; so are the following.
  [[nodiscard]] Duration min() const noexcept { return count_ == 0 ? Duration{} : min_; }
  [[nodiscard]] Duration max() const noexcept { return max_; }
  [[nodiscard]] Duration mean() const noexcept;
  /// The least value that is not exceeded by that share of the values, `percent` from 0 to 100.
  [[nodiscard]] Duration percentile(double percent) const noexcept;
  /// `0.123 / 0.456 / 1.789 ms` at 50 %, 99 % and the most.
  [[nodiscard]] std::string summary() const;

 private:
  static constexpr unsigned kFineBits = 6;  ///< each power of two has 64 buckets
  static constexpr unsigned kLargestBit = 40;
  static constexpr std::size_t kBuckets = std::size_t{kLargestBit - kFineBits + 2} << kFineBits;

  [[nodiscard]] static std::size_t bucket_of(std::uint64_t nanoseconds) noexcept;
  [[nodiscard]] static std::uint64_t upper_end(std::size_t bucket) noexcept;

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::uint64_t sum_ = 0;
  Duration min_ = Duration::max();
  Duration max_{};
};

}  // namespace armjig
