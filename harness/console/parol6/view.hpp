// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "harness/drive/parol6/drive.hpp"
#include "harness/wire/parol6/frame.hpp"

/// How a PAROL6 looks in a terminal. Texts of several lines end with a line end.
namespace armjig::parol6::console {

/// Everything that telemetry says, a table of joints first; at most 80 columns wide.
[[nodiscard]] std::string panel(const TelemetryFrame& frame);

/// The same in one line, without line end, for logs.
[[nodiscard]] std::string one_line(const TelemetryFrame& frame);

/// What the link did so far: counts and round-trip times.
[[nodiscard]] std::string link_panel(const drive::DriveStatistics& statistics);

}  // namespace armjig::parol6::console
