// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/timing/latency_histogram.hpp"

/// The log format of HdrHistogram, version 1.3 with histograms in their second encoding, which its
/// plotters and its log processor open.
namespace armjig {

/// The histogram compressed and in Base64, as a line of a log has it.
[[nodiscard]] std::string to_hdr_text(const LatencyHistogram& histogram);

/// Reads that. Values out of our range count as the longest. Errors: `kMalformed` for what is no
/// histogram of that encoding with three digits that counts from one nanosecond.
[[nodiscard]] Result<LatencyHistogram> parse_hdr_text(std::string_view text);

/// A stretch of time and what was measured in it.
struct HistogramInterval {
  std::string tag;                        ///< empty: none; without blanks and commas
  std::chrono::duration<double> start{};  ///< since the log's start
  std::chrono::duration<double> length{};
  LatencyHistogram histogram;
};

/// A whole log, of intervals in the order of their starts.
[[nodiscard]] std::string to_histogram_log(std::chrono::sys_seconds started,
                                           const std::vector<HistogramInterval>& intervals);

/// Reads one, whatever its comments say. Errors: `kMalformed` with the number of the line.
[[nodiscard]] Result<std::vector<HistogramInterval>> parse_histogram_log(std::string_view text);

}  // namespace armjig
