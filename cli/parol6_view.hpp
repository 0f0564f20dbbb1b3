// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "harness/drive/parol6/drive.hpp"
#include "harness/wire/parol6/frame.hpp"

/// How a PAROL6 looks in a terminal. Texts of several lines end with a line end.
namespace armjig::cli {

/// Everything that telemetry says, a table of joints first; at most 80 columns wide.
[[nodiscard]] std::string panel(const parol6::TelemetryFrame& frame);

/// The same in one line, without line end, for logs.
[[nodiscard]] std::string one_line(const parol6::TelemetryFrame& frame);

/// What the link did so far: counts and round-trip times.
[[nodiscard]] std::string link_panel(const parol6::DriveStatistics& statistics);

/// `0.123 / 0.456 / 1.789 ms` at 50 %, 99 % and the most.
[[nodiscard]] std::string percentiles(const LatencyHistogram& histogram);

/// `idle`, or `200` for a code without a name.
[[nodiscard]] std::string name_of(parol6::Command command);

}  // namespace armjig::cli
