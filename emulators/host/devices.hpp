// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "emulators/host/hosted_server.hpp"
#include "emulators/host/hosted_stream.hpp"
#include "harness/core/device_input.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/session_rig.hpp"
#include "harness/rig/target.hpp"

namespace armjig {

/// A device that can be hosted on a byte stream. `make` names `where` the options came from in its
/// problems: `kUnknownOption`, `kBadValue`.
struct HostEntry {
  std::string_view device;
  Outcome<std::unique_ptr<HostedStream>> (*make)(const DeviceOptions& options,
                                                 const std::string& where);
  OpenEmulated open;  ///< the same device in this process, on virtual time
  std::span<const DeviceInput> (*inputs)() noexcept;  ///< what its `set_input` knows
};

/// All of them. This is the room's one list of devices.
[[nodiscard]] std::span<const HostEntry> hosted_devices() noexcept;

/// A server that can be hosted on TCP; `make` as above.
struct ServerEntry {
  std::string_view device;
  Outcome<std::unique_ptr<HostedServer>> (*make)(const DeviceOptions& options,
                                                 const std::string& where);
  std::uint16_t port;       ///< on which clients look for it
  OpenEmulatedServer open;  ///< the same server in this process, on virtual time
  std::span<const DeviceInput> (*inputs)() noexcept;  ///< what its `set_input` knows
};

/// All of them: devices that know connections and not just bytes.
[[nodiscard]] std::span<const ServerEntry> hosted_servers() noexcept;

/// The entry of a device that has one.
[[nodiscard]] const HostEntry& hosted_device(std::string_view device) noexcept;

/// The entry of a server that has one.
[[nodiscard]] const ServerEntry& hosted_server(std::string_view device) noexcept;

/// Problems: those of `make`, and `kUnknownDevice` with the names of all devices.
[[nodiscard]] Outcome<std::unique_ptr<HostedStream>> make_hosted_device(
    const std::string& device, const DeviceOptions& options = {});

}  // namespace armjig
