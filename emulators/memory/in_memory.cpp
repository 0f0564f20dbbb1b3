// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/in_memory.hpp"

#include <utility>

#include "harness/link/emulated_bus_port.hpp"
#include "harness/link/memory_session.hpp"
#include "harness/link/memory_stream.hpp"

namespace armjig {

std::unique_ptr<StreamPort> open_in_memory(std::unique_ptr<HostedStream> device) {
  return std::make_unique<MemoryStream<std::unique_ptr<HostedStream>>>(std::move(device));
}

std::unique_ptr<SessionSource> open_in_memory(std::unique_ptr<HostedServer> server) {
  return std::make_unique<MemoryServer<std::unique_ptr<HostedServer>>>(std::move(server));
}

std::unique_ptr<BusPort> open_in_memory(std::unique_ptr<HostedBus> bus, Duration clock_patience) {
  return std::make_unique<EmulatedBusPort<std::unique_ptr<HostedBus>>>(std::move(bus),
                                                                       clock_patience);
}

}  // namespace armjig
