// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/device.hpp"

namespace gripper {

/// The gripper as it is delivered, and the same at 1,200 baud.
[[nodiscard]] armjig::cli::Devices devices();

}  // namespace gripper
