// SPDX-License-Identifier: Apache-2.0
#include "harness/timing/block_bootstrap.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "harness/timing/latency_histogram.hpp"

namespace armjig {
namespace {

constexpr std::size_t kDraws = 20'000'000;  ///< of values, in all
constexpr std::size_t kFewestRounds = 200;  ///< the ends of 99 % need some beyond them
constexpr std::size_t kMostRounds = 2'000;

/// SplitMix64: public domain arithmetic, the same on every machine, unlike the standard library's
/// distributions.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) noexcept : state_{seed} {}
  /// From 0 to `count` - 1.
  std::size_t below(std::size_t count) noexcept {
    state_ += 0x9E3779B97F4A7C15U;
    auto word = state_;
    word = (word ^ word >> 30U) * 0xBF58476D1CE4E5B9U;
    word = (word ^ word >> 27U) * 0x94D049BB133111EBU;
    return static_cast<std::size_t>((word ^ word >> 31U) % count);
  }

 private:
  std::uint64_t state_;
};

/// What lies between the shares at both ends that are not wanted. Sorts it.
ConfidenceInterval middle_of(std::vector<Duration>& found, double confidence) {
  std::ranges::sort(found);
  const auto last = static_cast<double>(found.size() - 1);
  const auto tail = (1 - confidence) / 2;
  return {found[static_cast<std::size_t>(std::floor(tail * last))],
          found[static_cast<std::size_t>(std::ceil((1 - tail) * last))]};
}

}  // namespace

std::vector<ConfidenceInterval> percentile_intervals(std::span<const Duration> values,
                                                     std::span<const double> percents,
                                                     const BootstrapHow& how) {
  assert(!values.empty());
  const auto count = values.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&values](std::size_t i) { return values[i]; });
  std::vector<std::size_t> place(count);  // of each value among the sorted ones
  for (std::size_t i = 0; i < count; ++i) place[order[i]] = i;

  const auto root = static_cast<std::size_t>(std::sqrt(static_cast<double>(count)));
  const auto block = std::clamp<std::size_t>(how.block == 0 ? root : how.block, 1, count);
  const auto rounds = std::clamp(kDraws / count, kFewestRounds, kMostRounds);
  std::vector<std::vector<Duration>> found(percents.size());
  std::vector<std::uint32_t> times(count);
  Draw draw{how.seed};
  for (std::size_t round = 0; round < rounds; ++round) {
    std::ranges::fill(times, 0);
    for (std::size_t drawn = 0; drawn < count;) {
      const auto first = draw.below(count);
      const auto size = std::min(block, count - drawn);
      // A block at the end goes on at the beginning, so that no value is drawn less often.
      for (std::size_t i = 0; i < size; ++i) ++times[place[(first + i) % count]];
      drawn += size;
    }
    for (std::size_t p = 0; p < percents.size(); ++p) {
      const auto wanted = LatencyHistogram::rank_of(percents[p], count);
      std::size_t seen = 0;
      std::size_t i = 0;
      while ((seen += times[i]) < wanted) ++i;
      found[p].push_back(values[order[i]]);
    }
  }
  std::vector<ConfidenceInterval> intervals;
  for (auto& one : found) intervals.push_back(middle_of(one, how.confidence));
  return intervals;
}

ConfidenceInterval mean_interval(std::span<const Duration> differences, const BootstrapHow& how) {
  assert(!differences.empty());
  std::vector<Duration> found;
  Draw draw{how.seed};
  for (std::size_t round = 0; round < kMostRounds; ++round) {
    Duration sum{};
    for (std::size_t i = 0; i < differences.size(); ++i) {
      sum += differences[draw.below(differences.size())];
    }
    found.push_back(sum / static_cast<Duration::rep>(differences.size()));
  }
  return middle_of(found, how.confidence);
}

}  // namespace armjig
