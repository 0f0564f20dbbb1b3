// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/console/device_console.hpp"
#include "harness/console/watched.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::parol6::console {

/// The commands of a person who drives a board. `target` is for messages.
[[nodiscard]] Outcome<std::unique_ptr<DeviceConsole>> open(Rig<StreamPort> rig,
                                                           const std::string& target, Say say);

/// The telemetry that a board answers to idle frames. They also say that outputs go off and a
/// gripper goes limp. 100 a second are usual.
[[nodiscard]] Outcome<std::unique_ptr<Watched>> watch(Rig<StreamPort> rig,
                                                      const std::string& target,
                                                      const WatchHow& how);

}  // namespace armjig::parol6::console
