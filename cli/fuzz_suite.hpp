// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "cli/device.hpp"
#include "emulators/campaign/script.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::cli {

/// What the cases of the device's suite do to that emulated device from when it is new, a script
/// for each that takes no longer than `longest`. Left out are cases that search, or end the
/// device's program, and without hands those that do something beside the link.
[[nodiscard]] std::vector<campaign::Script> scripts_of_suite(const Device& device,
                                                             const RigOptions& model,
                                                             bool has_hands, Duration longest);

}  // namespace armjig::cli
