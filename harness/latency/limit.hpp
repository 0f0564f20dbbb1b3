// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/latency/meter.hpp"

namespace armjig {

/// What a run must not exceed: `p99<2ms`, `max<10ms`, `mean<800us`, `lost<1`, `skipped<1`.
struct Limit {
  enum class Of : std::uint8_t { kPercentile, kMean, kMax, kLost, kSkipped };

  std::string text;  ///< as written
  Of of{};
  double percent{};  ///< of `kPercentile`
  double below{};    ///< nanoseconds, or how many
};

/// Reads some with `,` between. Problems: `kBadValue`.
[[nodiscard]] Outcome<std::vector<Limit>> parse_limits(std::string_view text);

struct LimitVerdict {
  Limit limit;
  double actual{};  ///< as `Limit::below`
  bool is_kept{};
  bool is_known = true;  ///< enough answers for that percentile
};

/// Durations are those corrected for coordinated omission. A lost answer is longer than any, so
/// limits of the mean and the most do not bear one, nor a percentile more than its share.
[[nodiscard]] LimitVerdict check(const Limit& limit, const Measured& measured);

/// `1.234 ms`, or `3`.
[[nodiscard]] std::string actual_text(const LimitVerdict& verdict);

}  // namespace armjig
