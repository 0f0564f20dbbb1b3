// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/drive/parol6/activity.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/motion/parol6/cartesian_jog.hpp"

namespace armjig::parol6::drive {

/// Moves the tool for a time, or as far as it goes without one; the arm stands at the end. Each
/// frame's joint speeds are computed from the newest telemetry. Fails, standing, where the tool can
/// no further, and at once if the arm is not homed. `kRefused` if the emergency stop is latched.
[[nodiscard]] Result<std::unique_ptr<Activity>> begin_tool_jog(Drive& drive,
                                                               const planning::CartesianJog& jog,
                                                               std::optional<Duration> time);

}  // namespace armjig::parol6::drive
