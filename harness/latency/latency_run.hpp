// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/latency/comparison.hpp"
#include "harness/latency/jitter_cost.hpp"
#include "harness/latency/limit.hpp"
#include "harness/latency/meter.hpp"
#include "harness/report/report.hpp"
#include "harness/timing/block_bootstrap.hpp"
#include "harness/timing/realtime.hpp"
#include "harness/timing/sentinel.hpp"

namespace armjig {

/// What the sentinel saw; copied, for it has ended.
struct Witness {
  LatencyHistogram lateness;
  std::vector<Oversleep> oversleeps;
};

/// A run, with all that somebody needs to believe it.
struct LatencyRun {
  std::string name;  ///< among several: `rate=50`; empty: the only one
  std::string device;
  std::string target;
  std::string exchange;
  std::string path;
  std::string machine;                              ///< kernel and processors
  std::string load;                                 ///< made on purpose; empty: none
  std::vector<Privilege> privileges;                ///< none in virtual time
  std::optional<std::chrono::sys_seconds> started;  ///< wall clock; none in virtual time
  MeterPlan plan;
  Measured measured;
  std::optional<LatencyHistogram> sending;  ///< of further requests, as `time_sending`
  std::optional<Witness> witness;
  std::optional<Duration> time_on_wire;  ///< of an exchange, by arithmetic
  std::vector<Figure> figures;
  std::vector<LimitVerdict> limits;
  std::optional<LatencyComparison> comparison;
  std::optional<JitterCost> cost;
  bool is_interrupted = false;
  std::vector<std::string> left_out;  ///< what a recording does not have
  bool is_recorded = false;           ///< by somebody, not measured now

  [[nodiscard]] bool is_virtual() const noexcept { return !started && !is_recorded; }
};

/// A share of the round trip, and what says so.
struct Share {
  std::string of;  ///< `host`, `link`, `device or link`
  Duration median{};
  Duration p99{};
  std::string rests_on;
};

/// A percentile of the round trips as they were, and of those corrected.
struct PercentileRow {
  double percent{};
  Duration raw{};
  std::optional<ConfidenceInterval> interval;  ///< of `raw`; none: their order is not known
  Duration corrected{};
};

inline constexpr double kLatencyConfidence = 0.99;

/// Those that enough answers stand behind, from 50 %.
[[nodiscard]] std::vector<PercentileRow> percentiles_of(const Measured& measured);

/// Between what the median of another run of the same may lie: what a bootstrap of the trips says,
/// and how far stretches of a tenth of the run lay apart, for what comes over a machine for seconds
/// is in no bootstrap. None: their order is not known, or they are too few.
[[nodiscard]] std::optional<ConfidenceInterval> noise_floor_of(const Measured& measured);

/// As far as kernel and arithmetic allow.
[[nodiscard]] std::vector<Share> shares_of(const LatencyRun& run);

/// Whose fault one of the worst was, as far as somebody saw it.
[[nodiscard]] std::string blame_of(const Outlier& outlier, const LatencyRun& run);

/// For people: facts and verdicts first; then percentiles, shares and figures, the worst, plots.
[[nodiscard]] Report report_of(const LatencyRun& run);

/// Several runs side by side, then each by itself. Requires some.
[[nodiscard]] Report report_of(std::span<const LatencyRun> runs);

/// One JSON object of docs/schemas/latency-runs.schema.json, "armjig.latency-runs/1".
[[nodiscard]] std::string to_latency_json(std::span<const LatencyRun> runs);

/// One JSON object of docs/schemas/latency.schema.json, "armjig.latency/1".
[[nodiscard]] std::string to_latency_json(const LatencyRun& run);

/// All round trips as a log for HdrHistogram's plotters; tags are `raw` and `corrected`.
[[nodiscard]] std::string to_latency_log(const LatencyRun& run);

}  // namespace armjig
