// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "emulators/memory/hosted.hpp"
#include "harness/link/bus_port.hpp"
#include "harness/link/session_source.hpp"
#include "harness/link/stream_port.hpp"

/// Ports to devices in this process, on virtual time: waiting costs nothing, and the same calls
/// give the same bytes on every machine.
namespace armjig {

[[nodiscard]] std::unique_ptr<StreamPort> open_in_memory(std::unique_ptr<HostedStream> device);

[[nodiscard]] std::unique_ptr<SessionSource> open_in_memory(std::unique_ptr<HostedServer> server);

/// `clock_patience`: for how long a device may hold the clock before an operation fails with
/// `kTimedOut`. Adapters give up after 25 ms.
[[nodiscard]] std::unique_ptr<BusPort> open_in_memory(
    std::unique_ptr<HostedBus> bus, Duration clock_patience = std::chrono::milliseconds{25});

}  // namespace armjig
