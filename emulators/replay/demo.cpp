// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/demo.hpp"

#include <utility>

#include "emulators/demo/demo.hpp"

namespace armjig::demo::replay {

Outcome<Replayed> replay(const Trace& trace) {
  Replayed replayed;
  emulation::StreamDevice device;
  for (const auto& event : trace.events) {
    device.advance_to(event.time);
    if (event.dir == "to_device") device.receive(event.time, event.bytes);
    if (event.dir == "from_device") replayed.recorded.push_back(event);
  }
  for (const auto& reply : device.sent()) {
    TraceEvent event;
    event.time = reply.time;
    event.dir = "from_device";
    event.bytes = reply.bytes;
    replayed.actual.push_back(std::move(event));
  }
  return replayed;
}

}  // namespace armjig::demo::replay
