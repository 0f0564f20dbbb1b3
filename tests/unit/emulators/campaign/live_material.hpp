// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "cli/device.hpp"
#include "cli/devices/devices.hpp"
#include "cli/diff.hpp"
#include "cli/fuzz_material.hpp"
#include "harness/rig/judge.hpp"

namespace armjig::campaign {

/// What a live campaign on a device there has. The device itself need not be there.
inline Material live_material(const std::string& name, const std::string& place) {
  const auto& device = **cli::find_device(cli::shipped_devices(), name);
  RigOptions live;
  live.target = parse_target(place).value();
  live.permissions = Permissions::all();
  RigOptions model;
  model.target = parse_target("emulated:?profile=firmware").value();
  auto material = cli::material_of(device, live, model, std::chrono::seconds{8}).value();
  material.rules = cli::rules_beside(device, live.target, "").value();
  return material;
}

}  // namespace armjig::campaign
