// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "emulators/i2c/bus.hpp"
#include "harness/core/error.hpp"
#include "harness/link/bus_port.hpp"
#include "harness/rig/target.hpp"

/// Buses with MORAP nodes as users describe them.
namespace armjig::morap {

/// Makes a bus from options. `where` they came from is for problems: `kUnknownOption`, `kBadValue`,
/// those of `read_bus`.
///
/// - `file=NODES.toml`: everything is in the file, and there are no other options
/// - `nodes=1,2`: identifiers of the nodes, 0 to 16; 2 if nothing is said
/// - `motor=dcx22l` or `dcx26l`: of all nodes; without it node 1 has the latter
/// - `profile=firmware` or `documented`
/// - `pen=yes` or `no`: is there a pen end-effector? No if nothing is said
[[nodiscard]] Outcome<i2c::Bus> make_bus(const DeviceOptions& options, const std::string& where);

/// Reads a bus from a TOML file: any number of these, each key but `id` and `address` optional.
///
///     [[node]]
///     id = 2
///     profile = "firmware"   # or "documented"
///     motor = "dcx22l"       # or "dcx26l": what the node believes and what is there
///     inertia = 0.05         # kg m^2 at the output shaft
///     viscous = 0.0          # N m s/rad
///     dry = 0.0              # N m
///     load = 0.0             # N m
///     shunt = 820.0          # ohm, of the current sense
///     has_shaft = true       # false: nothing turns, whatever the voltage
///
///     [[pen]]
///     hangs = true           # on surplus bytes, as the recorded one does
///
///     [[thermometer]]        # an example of any other device
///     address = 0x48
///     celsius = 21.5
///
/// Problems: `kCannotRead`, `kMalformed`, with path and line.
[[nodiscard]] Outcome<i2c::Bus> read_bus(const std::string& path);
[[nodiscard]] Outcome<i2c::Bus> parse_bus(std::string_view text, std::string path);

/// The bus of an `emulated:` target on virtual time.
[[nodiscard]] Outcome<std::unique_ptr<BusPort>> open_emulated_bus(const Target& target);

}  // namespace armjig::morap
