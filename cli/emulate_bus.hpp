// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "cli/command.hpp"
#include "emulators/host/buses.hpp"
#include "emulators/host/i2c_adapter.hpp"

namespace armjig::cli {

enum class Announcement : std::uint8_t { kText, kJson };

/// Serves a bus as /dev/i2c-1, or as the number of the option `bus`, until a signal comes. Says
/// what programs need in their environment to find it. `listener` may be empty.
[[nodiscard]] Exit emulate_bus(const BusEntry& entry, DeviceOptions options, Announcement form,
                               BusListener listener);

}  // namespace armjig::cli
