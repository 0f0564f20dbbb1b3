// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "harness/core/time.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::drive {

/// One JSON object on one line, docs/schemas/telemetry.schema.json ("armjig.telemetry/1"), without
/// a line end: what the frame that came at `time` says, and the link up to then.
[[nodiscard]] std::string to_json(Instant time, const TelemetryFrame& frame,
                                  const DriveStatistics& link);

}  // namespace armjig::parol6::drive
