// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "harness/core/time.hpp"

namespace armjig {

/// Between which two values something lies with the confidence asked for.
struct ConfidenceInterval {
  Duration low{};
  Duration high{};

  friend bool operator==(const ConfidenceInterval&, const ConfidenceInterval&) = default;
};

struct BootstrapHow {
  double confidence = 0.99;
  std::uint64_t seed = 1;
  /// Values in a row that are drawn together, for neighbours resemble each other; 0: as many as the
  /// square root of their number.
  std::size_t block = 0;
};

/// Intervals of percentiles of `values`, which are in the order of their times, by drawing blocks
/// of them again and again. Fewer draws of many values: it takes at most some seconds. Requires
/// that there are values. The same values and seed give the same intervals.
[[nodiscard]] std::vector<ConfidenceInterval> percentile_intervals(std::span<const Duration> values,
                                                                   std::span<const double> percents,
                                                                   const BootstrapHow& how);

/// The interval of the mean of differences that do not depend on each other.
[[nodiscard]] ConfidenceInterval mean_interval(std::span<const Duration> differences,
                                               const BootstrapHow& how);

}  // namespace armjig
