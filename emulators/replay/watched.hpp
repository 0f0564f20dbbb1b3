// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "emulators/i2c/bus.hpp"
#include "emulators/kinovazed/server.hpp"
#include "emulators/parol6/board.hpp"
#include "emulators/replay/replay.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// Sees an emulated device after each line of a recording, at the time of that line. It may put a
/// copy of the device in its place, which must make no difference.
template <class Device>
using Onlooker = std::function<void(Device& device, Instant time)>;

namespace parol6::replay {
/// `replay` of the device, watched.
[[nodiscard]] Outcome<Replayed> replay_watched(const Trace& trace,
                                               const Onlooker<emulation::Board>& watch);
}  // namespace parol6::replay

namespace morap::replay {
/// `replay` of what is on the bus, watched. Nodes have the numbers of the recording's header.
[[nodiscard]] Outcome<Replayed> replay_watched(const Trace& trace, const Onlooker<i2c::Bus>& watch);
}  // namespace morap::replay

namespace kinovazed::replay {
/// `replay` of the server, watched; where threads race, in one order only.
[[nodiscard]] Outcome<Replayed> replay_watched(const Trace& trace,
                                               const Onlooker<emulation::Server>& watch);
}  // namespace kinovazed::replay

}  // namespace armjig
