// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "emulators/memory/hosted.hpp"
#include "harness/core/error.hpp"
#include "harness/link/session_source.hpp"
#include "harness/link/stream_port.hpp"

/// A device at the other end of a port, hosted as an emulated one is: what programs send goes to it
/// as it is, and what it sends goes to them. There is no guard: it is a cable, and who sends is the
/// program.
namespace armjig {

/// How that went.
struct RelayStatistics {
  std::uint64_t pieces = 0;      ///< passed on, both ways
  Duration held{};               ///< all of them together, from being read to being handed on
  Duration longest_held{};       ///< one of them
  std::uint64_t overlooks = 0;   ///< how often this process did not look
  Duration overlooked{};         ///< how long that was together
  std::optional<Error> failure;  ///< why the device is gone
};

/// `statistics` must outlive it. Of a server each connection of a program is one to the server; one
/// that the server refuses is closed at once.
[[nodiscard]] std::unique_ptr<HostedStream> relay(std::unique_ptr<StreamPort> port,
                                                  RelayStatistics& statistics);
/// Problems: `kSystem`, with the errno.
[[nodiscard]] Result<std::unique_ptr<HostedServer>> relay(std::unique_ptr<SessionSource> server,
                                                          RelayStatistics& statistics);

}  // namespace armjig
