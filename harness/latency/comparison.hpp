// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/latency/meter.hpp"
#include "harness/timing/block_bootstrap.hpp"

namespace armjig {

/// What the difference of two runs came to.
enum class Difference : std::uint8_t { kNone, kSlower, kFaster, kUnclear };

[[nodiscard]] std::string_view to_string(Difference difference) noexcept;

/// Of one figure: the second run minus the first.
struct Compared {
  std::string figure;  ///< `median` or `mean`
  Duration first{};
  Duration second{};
  ConfidenceInterval interval{};  ///< of the difference
  Difference difference{};
};

struct LatencyComparison {
  std::vector<Compared> figures;
  double confidence{};
  std::string rests_on;
  /// Of all figures: slower if one is, then faster; unclear if nothing can be said.
  Difference difference{};
};

/// What a comparison keeps of a stretch of a run that is alternated with another one.
struct Slice {
  Duration median{};
  Duration mean{};
};

/// Of round trips that were measured in one stretch. Requires some.
[[nodiscard]] Slice slice_of(std::span<const RoundTrip> trips);

/// Two targets in alternated slices, so that what comes over the machine comes over both: the
/// intervals are those of the differences of neighbours, of their median for the figure `median`,
/// of their mean for `mean`. Below ten pairs it is unclear.
[[nodiscard]] LatencyComparison compare_alternated(std::span<const Slice> first,
                                                   std::span<const Slice> second,
                                                   std::uint64_t seed);

/// The median of a stored run, and its noise floor: between what that of another run may lie.
struct Baseline {
  Duration median{};
  ConfidenceInterval noise{};
  std::string text;  ///< target and date, for people
};

/// Reads a run that was stored as JSON. Problems: `kMalformed`; `where` is for messages.
[[nodiscard]] Outcome<Baseline> parse_baseline(std::string_view json, const std::string& where);

/// Slower or faster only if the noise floors of both runs lie apart.
[[nodiscard]] LatencyComparison compare_with(const Baseline& baseline, Duration median,
                                             const ConfidenceInterval& noise);

}  // namespace armjig
