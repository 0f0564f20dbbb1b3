// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "cli/device.hpp"
#include "cli/devices/devices.hpp"

/// The entries of our devices, for tests that are about any of them.
namespace armjig::test {

[[nodiscard]] inline const cli::Device& device(std::string_view name) {
  return **cli::find_device(cli::shipped_devices(), name);
}

/// What a rig must know of one, by its kind of port: `cli::OnStream`, `cli::OnServer`,
/// `cli::OnBus`.
template <class Kind>
[[nodiscard]] auto wiring(std::string_view name) {
  const auto& one = device(name);
  return cli::wiring_of(one, std::get<Kind>(one.port));
}

/// A rig around the emulated device of such a target.
template <class Kind>
[[nodiscard]] auto emulated(std::string_view name, std::string_view target = "emulated:") {
  return *cli::open_rig<Kind>(device(name), {.target = parse_target(target).value()});
}

}  // namespace armjig::test
