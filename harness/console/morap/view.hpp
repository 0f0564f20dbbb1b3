// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "harness/drive/morap/joint.hpp"

/// How MORAP nodes look in a terminal.
namespace armjig::morap::console {

/// What a node says of itself. Nothing but `code` counts if that is not `kOk`.
struct NodeView {
  BusAddress address;
  drive::BusCode code{};
  MotorStatus status{};
  drive::Angle angle;
  drive::Voltage voltage;
  drive::Current current;
};

/// Asks a node for everything.
[[nodiscard]] NodeView look_at(drive::Master& master, BusAddress address);

/// Who answers where nodes are, the pen's address left out.
[[nodiscard]] drive::ScanResult find_nodes(drive::Master& master);

/// All of them under a heading, a line each.
[[nodiscard]] std::string table(std::span<const NodeView> nodes);
/// Without line end.
[[nodiscard]] std::string to_line(const NodeView& node);
/// An object of docs/schemas/morap-node.schema.json, "armjig.morap-node/1".
[[nodiscard]] std::string to_json(const NodeView& node, double seconds);

}  // namespace armjig::morap::console
