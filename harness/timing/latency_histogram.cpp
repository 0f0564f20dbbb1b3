// SPDX-License-Identifier: Apache-2.0
#include "harness/timing/latency_histogram.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

namespace armjig {

std::size_t LatencyHistogram::bucket_of(Duration duration) noexcept {
  const auto value = static_cast<std::uint64_t>(std::clamp(duration, Duration{}, kLongest).count());
  const auto bits = static_cast<unsigned>(std::bit_width(value));
  const unsigned shift = bits <= kFineBits ? 0 : bits - kFineBits;
  return shift * kHalf + static_cast<std::size_t>(value >> shift);
}

Duration LatencyHistogram::first_of(std::size_t bucket) noexcept {
  if (bucket < 2 * kHalf) return Duration{static_cast<Duration::rep>(bucket)};
  const auto shift = bucket / kHalf - 1;
  return Duration{static_cast<Duration::rep>((bucket - shift * kHalf) << shift)};
}

Duration LatencyHistogram::last_of(std::size_t bucket) noexcept {
  const auto shift = bucket < 2 * kHalf ? 0 : bucket / kHalf - 1;
  return first_of(bucket) + Duration{(Duration::rep{1} << shift) - 1};
}

void LatencyHistogram::record(Duration duration, std::uint64_t times) noexcept {
  if (times == 0) return;
  const auto value = std::max(duration, Duration{});
  counts_[bucket_of(value)] += times;
  count_ += times;
  sum_ += static_cast<double>(value.count()) * static_cast<double>(times);
  min_ = std::min(min_, value);
  max_ = std::max(max_, value);
}

void LatencyHistogram::record_corrected(Duration duration, Duration period) noexcept {
  record(duration);
  for (auto missed = duration - period; missed >= period; missed -= period) record(missed);
}

void LatencyHistogram::add(const LatencyHistogram& other) noexcept {
  for (std::size_t i = 0; i < kBuckets; ++i) counts_[i] += other.counts_[i];
  count_ += other.count_;
  sum_ += other.sum_;
  min_ = std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
}

Duration LatencyHistogram::mean() const noexcept {
  if (count_ == 0) return {};
  return std::clamp(Duration{static_cast<Duration::rep>(sum_ / static_cast<double>(count_))}, min_,
                    max_);
}

std::uint64_t LatencyHistogram::rank_of(double percent, std::uint64_t count) noexcept {
  const auto below = std::nextafter(std::clamp(percent, 0.0, 100.0), 0.0);
  const auto rank = std::ceil(below * static_cast<double>(count) / 100.0);
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(rank));
}

Duration LatencyHistogram::at_rank(std::uint64_t rank) const noexcept {
  if (count_ == 0) return {};
  std::uint64_t seen = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    seen += counts_[bucket];
    if (seen < rank) continue;
    if (seen == count_) break;  // the largest is known exactly
    return std::clamp(last_of(bucket), min_, max_);
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
