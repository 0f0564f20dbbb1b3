// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "emulators/memory/hosted.hpp"
#include "harness/core/error.hpp"
#include "harness/link/impairment.hpp"

namespace armjig {

/// The same device behind a link that is as bad as `impairment` says, seen from its programs: one
/// call is a chunk, and so is each thing that the device sends. A connection to a server has a bad
/// link of its own, with a seed of its own; one that breaks is reset on both sides. A bus is as bad
/// as `ImpairedBus` says. Programs wait when more than 1 MiB is on its way to the device.
///
/// Problems: `kUnsupported` for what such a link cannot have: a stream does not break, a bus knows
/// bytes only.
[[nodiscard]] Outcome<std::unique_ptr<HostedStream>> impair(std::unique_ptr<HostedStream> device,
                                                            const Impairment& impairment);
[[nodiscard]] Outcome<std::unique_ptr<HostedServer>> impair(std::unique_ptr<HostedServer> device,
                                                            const Impairment& impairment);
[[nodiscard]] Outcome<std::unique_ptr<HostedBus>> impair(std::unique_ptr<HostedBus> device,
                                                         const Impairment& impairment);

}  // namespace armjig
