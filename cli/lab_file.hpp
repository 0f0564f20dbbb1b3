// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/capture_options.hpp"
#include "cli/device.hpp"
#include "cli/serving.hpp"
#include "harness/core/error.hpp"
#include "harness/link/impairment.hpp"
#include "harness/rig/target.hpp"

namespace armjig::cli {

/// A `[[device]]` of a lab, checked as far as it can be without opening anything.
struct LabDevice {
  std::string where;  ///< `FILE:LINE`, for what turns out later
  std::string name;   ///< 1 to 64 letters, digits, `-` and `_`; of no other device
  const Device* device{};
  Target target;
  Places places;  ///< at least one, none of them another device's
  double speed = 1;
  std::optional<Impairment> impairment{};
  CaptureOptions capture{};
  bool wants_check = false;
};

/// Reads a lab from TOML (docs/labs.md). A device without a place is where programs look for one of
/// its kind: a board at the next free /dev/ttyACM-N, a bus at the next free /dev/i2c-N from 1, a
/// server on its usual TCP port. Problems name the file and, but for those of reading it, the line.
[[nodiscard]] Outcome<std::vector<LabDevice>> read_lab(const std::string& path, Devices devices);

/// The same from text in memory; `path` is for messages.
[[nodiscard]] Outcome<std::vector<LabDevice>> parse_lab(std::string_view text, std::string path,
                                                        Devices devices);

}  // namespace armjig::cli
