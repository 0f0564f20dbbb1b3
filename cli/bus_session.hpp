// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "cli/command.hpp"
#include "cli/target_options.hpp"
#include "harness/drive/morap/master.hpp"
#include "harness/rig/bus_rig.hpp"

namespace armjig::cli {

/// Reads the options and opens the bus. `device` must be one that is on a bus.
[[nodiscard]] Outcome<BusRig> open_bus_rig(std::string_view device, const TargetOptions& options);

/// `add_target_options` in the words of a bus.
void add_bus_target_options(CLI::App& app, TargetOptions& options);

/// Adds a node's identifier as `--node`, 0 to 16.
void add_node_option(CLI::App& app, std::uint8_t& node);

/// Says on one line how a transaction with `address` ended, and the exit code that goes with it: 1
/// for a byte that the device refused, 3 for everything else. Requires that it is not `kOk`.
[[nodiscard]] Exit report(morap::BusCode code, BusAddress address, const BusRig& rig);

}  // namespace armjig::cli
