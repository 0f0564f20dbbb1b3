// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "emulators/i2c/bus.hpp"
#include "harness/core/error.hpp"
#include "harness/rig/bus_rig.hpp"

namespace armjig {

/// A device that can be hosted on a bus, with others of its kind. `make` names `where` the options
/// came from in its problems.
struct BusEntry {
  std::string_view device;
  Outcome<i2c::Bus> (*make)(const DeviceOptions& options, const std::string& where);
  OpenEmulatedBus open;  ///< the same bus in this process, on virtual time
};

/// All of them: the room's list of devices that are on a bus and not on a byte stream.
[[nodiscard]] std::span<const BusEntry> hosted_buses() noexcept;

/// nullptr if the device is none of them.
[[nodiscard]] const BusEntry* find_hosted_bus(std::string_view device) noexcept;

}  // namespace armjig
