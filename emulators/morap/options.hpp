// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "emulators/i2c/bus.hpp"
#include "emulators/i2c/thermometer.hpp"
#include "emulators/morap/defects/defects.hpp"
#include "emulators/morap/eeprom.hpp"
#include "emulators/morap/pen.hpp"
#include "harness/core/error.hpp"
#include "harness/core/option.hpp"

/// Buses with MORAP nodes as users describe them.
namespace armjig::morap::emulation {

/// A node. If nothing else is said, its motor carries what the firmware's controllers were designed
/// for.
struct NodeSettings {
  std::uint8_t id = 2;
  const KnownMotor* motor = nullptr;  ///< none: dcx26l for node 1, dcx22l for others
  Profile profile = kFirmware;
  double inertia = 0.05;  ///< kg m^2
  double viscous = 0.1;   ///< N m s/rad
  double dry = 0.0;       ///< N m
  double load = 0.0;      ///< N m
  double shunt = kBelievedShuntOhm;
  bool has_shaft = true;
  std::vector<std::string> faults;  ///< as `add_fault` reads them

  /// The motor that it has, and believes to have if nothing is wrong with it.
  [[nodiscard]] const KnownMotor& known_motor() const noexcept;
};

struct BusSettings {
  std::vector<NodeSettings> nodes;
  std::vector<PenSetup> pens;
  std::vector<i2c::Thermometer> thermometers;
};

[[nodiscard]] std::span<const OptionRow> options() noexcept;

/// The bus that options describe, as data. With `file=` it is that of the file, which needs `files`
/// to be read, and other options are what its nodes have unless the file says otherwise:
///
///     [[node]]               # any number of each
///     id = 2                 # needed; other keys are the options, with _ for -
///     motor = "dcx22l"
///     has_shaft = false
///     [[pen]]
///     hangs = true           # on surplus bytes, as the recorded one does
///     [[thermometer]]        # any other device
///     address = 0x48         # needed
///     celsius = 21.5
///
/// `where` is for problems: `kUnknownOption`, `kBadValue`, those of `files`.
[[nodiscard]] Outcome<BusSettings> read_bus(const DeviceOptions& options, const std::string& where,
                                            const OptionFiles& files = {});

[[nodiscard]] i2c::Bus make_bus(const BusSettings& settings);

/// Both together.
[[nodiscard]] Outcome<i2c::Bus> make(const DeviceOptions& options, const std::string& where,
                                     const OptionFiles& files = {});

}  // namespace armjig::morap::emulation
