// SPDX-License-Identifier: Apache-2.0
#include "harness/console/morap/view.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "harness/wire/morap/pen.hpp"

namespace armjig::morap::console {

using namespace drive;

namespace {

std::string name_of(MotorStatus status) {
  switch (status) {
    case MotorStatus::kEnabled:
      return "enabled";
    case MotorStatus::kDisabled:
      return "disabled";
    case MotorStatus::kNeedsCalibration:
      return "needs calibration";
  }
  return fmt::format("status {}", static_cast<int>(status));
}

/// Keeps the first trouble.
template <class T>
T take(NodeView& view, const Reading<T>& reading) {
  if (view.code == BusCode::kOk) view.code = reading.code;
  return reading.value;
}

/// JSON has no infinity.
nlohmann::ordered_json number(float value) {
  if (!std::isfinite(value)) return nullptr;
  return value;
}

}  // namespace

NodeView look_at(Master& master, BusAddress address) {
  Joint joint{master, address};
  NodeView view;
  view.address = address;
  view.status = take(view, joint.status());
  if (view.code == BusCode::kOk) view.angle = take(view, joint.angle());
  if (view.code == BusCode::kOk) view.voltage = take(view, joint.voltage());
  if (view.code == BusCode::kOk) view.current = take(view, joint.current());
  return view;
}

ScanResult find_nodes(Master& master) {
  ScanResult found;
  for (auto address = kNodeBaseAddress; is_node_address(address); ++address) {
    if (address == pen::kAddress) continue;
    const auto code = master.poke({address});
    if (code == BusCode::kOk) found.addresses.push_back({address});
    if (code == BusCode::kOk || code == BusCode::kNoSuchAddress) continue;
    found.code = code;
    break;
  }
  return found;
}

std::string to_line(const NodeView& node) {
  const int id = node_of(node.address.value);
  if (node.code != BusCode::kOk) return fmt::format("{:>4}  {}", id, describe(node.code));
  const auto radians = static_cast<double>(node.angle.value);
  return fmt::format("{:>4}  {:<17} {:>11.5f} rad {:>10.3f} deg {:>9.4f} V {:>7.3f} A", id,
                     name_of(node.status), radians, radians * 180 / std::numbers::pi,
                     node.voltage.value, node.current.value);
}

std::string table(std::span<const NodeView> nodes) {
  auto text = fmt::format("{:>4}  {:<17} {:>15} {:>14} {:>11} {:>9}\n", "node", "status", "angle",
                          "", "voltage", "current");
  for (const auto& node : nodes) text += to_line(node) + '\n';
  return text;
}

std::string to_json(const NodeView& node, double seconds) {
  nlohmann::ordered_json json{{"schema", "armjig.morap-node/1"},
                              {"time_s", seconds},
                              {"node", node_of(node.address.value)}};
  if (node.code != BusCode::kOk) {
    json["error"] = describe(node.code);
    return json.dump();
  }
  json["status"] = name_of(node.status);
  json["angle_rad"] = number(node.angle.value);
  json["voltage_v"] = number(node.voltage.value);
  json["current_a"] = number(node.current.value);
  return json.dump();
}

}  // namespace armjig::morap::console
