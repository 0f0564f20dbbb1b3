// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "cli/device.hpp"
#include "cli/target_options.hpp"
#include "harness/drive/morap/master.hpp"

namespace armjig::cli {

/// Reads the options and opens the bus of the device.
[[nodiscard]] Outcome<Rig<BusPort>> open_bus_rig(const Device& device,
                                                 const TargetOptions& options);

/// Adds a node's identifier as `--node`, 0 to 16.
void add_node_option(CLI::App& app, std::uint8_t& node);

/// Says on one line how a transaction with `address` ended, and the exit code that goes with it: 1
/// for a byte that the device refused, 3 for everything else. Requires that it is not `kOk`.
[[nodiscard]] Exit report(morap::drive::BusCode code, BusAddress address, const Rig<BusPort>& rig);

}  // namespace armjig::cli
