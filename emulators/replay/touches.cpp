// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/touches.hpp"

#include <fmt/core.h>

#include "harness/core/hex.hpp"

namespace armjig {
namespace {

/// Empty for what was not done beside the link.
std::string line_of(const KeptRecord& record) {
  if (record.kind == LinkKind::kEvents) return '{' + record.details + '}';
  if (record.kind != LinkKind::kCan || record.direction == Direction::kFromDevice) return {};
  return fmt::format(R"({{"dir":"can_to_device","id":{},"hex":"{}"}})", record.id,
                     to_hex(record.bytes));
}

}  // namespace

DeviceTouches touches_of(const KeptRecord& record, TouchesOf of_device) {
  const auto line = line_of(record);
  if (line.empty()) return {};
  const auto input = text_in(line, "name");
  if (what_of(record) == "input" && !input.empty()) {
    return {{input, number_in(line, "value", 0)}};
  }
  return of_device == nullptr ? DeviceTouches{} : of_device(line);
}

}  // namespace armjig
