// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/console/device_console.hpp"
#include "harness/console/watched.hpp"
#include "harness/rig/rig.hpp"

namespace armjig::morap::console {

/// The commands of a person with a bus of motor nodes. All but `wait` are done at once; they are
/// for one node, which `node` changes. What was told to move is disabled by `stop`. `target` is for
/// messages.
[[nodiscard]] Outcome<std::unique_ptr<DeviceConsole>> open(Rig<BusPort> rig,
                                                           const std::string& target, Say say);

/// What all nodes on a bus say of themselves: those that answer now. Problems: trouble with the
/// bus, and nobody answers (`kTimedOut`). Ten rounds of questions a second are usual.
[[nodiscard]] Outcome<std::unique_ptr<Watched>> watch(Rig<BusPort> rig, const std::string& target,
                                                      const WatchHow& how);

}  // namespace armjig::morap::console
