// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/console/device_console.hpp"
#include "harness/console/watched.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::kinovazed::console {

/// The commands of a person who drives an arm through its server. `target` is for messages; the
/// server is believed to have the profile that it names, if it names one. Problems: those of
/// `parse_target`.
[[nodiscard]] Outcome<std::unique_ptr<DeviceConsole>> open(Rig<SessionSource> rig,
                                                           const std::string& target, Say say);

/// The beats and events of a server, which come by themselves; nothing is sent. Connects at once.
/// Looking ten times a second is usual.
[[nodiscard]] Outcome<std::unique_ptr<Watched>> watch(Rig<SessionSource> rig,
                                                      const std::string& target,
                                                      const WatchHow& how);

}  // namespace armjig::kinovazed::console
