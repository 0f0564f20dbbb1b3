// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "harness/console/device_console.hpp"
#include "harness/console/watched.hpp"
#include "harness/wire/dissector.hpp"

/// For devices of which nothing more is known than how their traffic is read.
namespace armjig::generic {

/// The command `send HEX`; what comes is shown as messages. What makes the device stand is not
/// known: `stop` only ends a `wait`. `target` is for messages.
[[nodiscard]] std::unique_ptr<DeviceConsole> open(StreamLink link,
                                                  std::unique_ptr<Dissector> dissector,
                                                  const std::string& target, Say say);

/// Shows what the device answers to harmless requests, one of which is sent each period in their
/// order, or what it says by itself if there are none.
[[nodiscard]] std::unique_ptr<Watched> watch(StreamLink link, std::unique_ptr<Dissector> dissector,
                                             std::vector<std::vector<std::byte>> requests);

}  // namespace armjig::generic
