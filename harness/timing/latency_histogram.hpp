// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/core/time.hpp"

namespace armjig {

/// Counts durations in the layout of HdrHistogram with three significant digits: each value is
/// known to one part in a thousand or better, from 1 ns to an hour. Its memory, a quarter of a
/// megabyte, is taken when it is made, so that recording costs nothing in a cycle loop. Smallest
/// and largest are exact.
class LatencyHistogram {
 public:
  static constexpr int kDigits = 3;
  /// Longer durations count as this long, but for the largest.
  static constexpr Duration kLongest = std::chrono::hours{1};

  LatencyHistogram() : counts_(kBuckets) {}

  /// Negative durations count as 0.
  void record(Duration duration) noexcept { record(duration, 1); }
  void record(Duration duration, std::uint64_t times) noexcept;

  /// Also what those would have seen who had to wait meanwhile: one was due each `period`, and
  /// while an answer took longer nobody asked (coordinated omission). So a stall of five periods
  /// also counts as one of four, three, two and one. Requires `period > 0`.
  void record_corrected(Duration duration, Duration period) noexcept;

  void add(const LatencyHistogram& other) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// 0 if nothing was recorded; so are the following.
  [[nodiscard]] Duration min() const noexcept { return count_ == 0 ? Duration{} : min_; }
  [[nodiscard]] Duration max() const noexcept { return max_; }
  [[nodiscard]] Duration mean() const noexcept;
  /// The least value that is not exceeded by that share of the values, `percent` from 0 to 100.
  [[nodiscard]] Duration percentile(double percent) const noexcept {
    return at_rank(rank_of(percent, count_));
  }
  /// The value at that place among all in their order, the least at 1.
  [[nodiscard]] Duration at_rank(std::uint64_t rank) const noexcept;
  /// Where the value of a percentile stands among `count` of them, from 1; 99.9 % of 10,000 is
  /// 9,990 although 99.9 is no number of a computer.
  [[nodiscard]] static std::uint64_t rank_of(double percent, std::uint64_t count) noexcept;
  /// `0.123 / 0.456 / 1.789 ms` at 50 %, 99 % and the most.
  [[nodiscard]] std::string summary() const;

  /// How many values each bucket has.
  [[nodiscard]] std::span<const std::uint64_t> counts() const noexcept { return counts_; }
  /// Counts values in the bucket of that index as its largest one. Requires an index of `counts`.
  void record_bucket(std::size_t index, std::uint64_t times) noexcept {
    record(last_of(index), times);
  }

  // The buckets: values that are told apart from no other value in there.
  [[nodiscard]] static std::size_t bucket_of(Duration duration) noexcept;
  [[nodiscard]] static Duration first_of(std::size_t bucket) noexcept;
  [[nodiscard]] static Duration last_of(std::size_t bucket) noexcept;

 private:
  /// 2,000 values are told apart by one, hence 2,048; each further power of two has half of that.
  static constexpr unsigned kFineBits = 11;
  static constexpr std::size_t kHalf = std::size_t{1} << (kFineBits - 1);
  static constexpr unsigned kLargestBit = 42;  ///< an hour has so many
  static constexpr std::size_t kBuckets = (kLargestBit - kFineBits + 2) * kHalf;

  std::vector<std::uint64_t> counts_;
  std::uint64_t count_ = 0;
  double sum_ = 0;  ///< of an hour each, 64 bits would be full after five million
  Duration min_ = Duration::max();
  Duration max_{};
};

}  // namespace armjig
