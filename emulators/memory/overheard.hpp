// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "emulators/memory/hosted.hpp"
#include "harness/core/overhearer.hpp"

namespace armjig {

/// The same device, of which `overhearer` is told all that passes. It must outlive the device.
[[nodiscard]] std::unique_ptr<HostedStream> overhear(std::unique_ptr<HostedStream> device,
                                                     Overhearer& overhearer);
[[nodiscard]] std::unique_ptr<HostedServer> overhear(std::unique_ptr<HostedServer> device,
                                                     Overhearer& overhearer);
[[nodiscard]] std::unique_ptr<HostedBus> overhear(std::unique_ptr<HostedBus> device,
                                                  Overhearer& overhearer);

}  // namespace armjig
