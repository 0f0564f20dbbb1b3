// SPDX-License-Identifier: Apache-2.0
#include "harness/timing/latency_histogram.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

namespace armjig {

std::size_t LatencyHistogram::bucket_of(std::uint64_t nanoseconds) noexcept {
  const auto bits = static_cast<unsigned>(std::bit_width(nanoseconds));
  if (bits <= kFineBits) return nanoseconds;
  if (bits > kLargestBit) return kBuckets - 1;
  const unsigned shift = bits - kFineBits - 1;
  // The leading bit picks the group, the six bits behind it the bucket.
  return (std::size_t{shift} << kFineBits) + (nanoseconds >> shift);
}

std::uint64_t LatencyHistogram::upper_end(std::size_t bucket) noexcept {
  constexpr std::size_t kFine = std::size_t{1} << kFineBits;
  if (bucket < 2 * kFine) return bucket;
  const auto shift = (bucket >> kFineBits) - 1;
  return ((kFine + bucket % kFine + 1) << shift) - 1;
}

void LatencyHistogram::record(Duration duration) noexcept {
  const auto value = std::max(duration, Duration{});
  const auto nanoseconds = static_cast<std::uint64_t>(value.count());
  ++buckets_[bucket_of(nanoseconds)];
  ++count_;
  sum_ += nanoseconds;
  min_ = std::min(min_, value);
  max_ = std::max(max_, value);
}

Duration LatencyHistogram::mean() const noexcept {
  return count_ == 0 ? Duration{} : Duration{static_cast<Duration::rep>(sum_ / count_)};
}

Duration LatencyHistogram::percentile(double percent) const noexcept {
  if (count_ == 0) return {};
  const auto share = std::clamp(percent, 0.0, 100.0) / 100.0;
  const auto wanted = std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_))));
  std::uint64_t seen = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    seen += buckets_[bucket];
    if (seen < wanted) continue;
    if (seen == count_) break;  // the largest is known exactly
    return std::clamp(Duration{static_cast<Duration::rep>(upper_end(bucket))}, min_, max_);
  }
  return max_;
}

std::string LatencyHistogram::summary() const {
  const auto milliseconds = [](Duration duration) {
    return std::chrono::duration<double, std::milli>{duration}.count();
  };
  return fmt::format("{:.3f} / {:.3f} / {:.3f} ms", milliseconds(percentile(50)),
                     milliseconds(percentile(99)), milliseconds(max()));
}

}  // namespace armjig
