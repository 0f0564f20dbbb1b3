// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/core/option.hpp"

namespace armjig::cli {

/// What `--set NAME=VALUE` says of an emulated device, each time once. Problems: `kBadValue`.
[[nodiscard]] Outcome<DeviceOptions> parse_settings(const std::vector<std::string>& settings);

/// As `--target` would have them.
[[nodiscard]] std::string target_of(const DeviceOptions& settings);

}  // namespace armjig::cli
