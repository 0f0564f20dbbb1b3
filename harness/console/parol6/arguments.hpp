// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "harness/arm/jacobian.hpp"
#include "harness/console/arguments.hpp"
#include "harness/core/quantity.hpp"

/// How joints, speeds and places of a PAROL6 are typed. What cannot be read is told in a sentence.
namespace armjig::parol6::console {

/// `j1` to `j6`, as an index from 0.
[[nodiscard]] Parsed<std::size_t> parse_joint(std::string_view text);

/// `-500`, `-500steps/s`, `10deg`, `10deg/s`: not 0, and not beyond what the board can.
[[nodiscard]] Parsed<StepsPerSecond> parse_speed(std::size_t joint, std::string_view text);

/// `x`, `y`, `z`, `rx`, `ry`, `rz` and how fast along or about it: `10`, `-10mm`, `10mm/s`, and
/// `5`, `5deg`, `5deg/s` about; not 0, and not beyond what the vendor's program can.
[[nodiscard]] Parsed<arm::Twist> parse_tool_speed(std::string_view axis, std::string_view text);

/// `1000`, `1000steps`, `90deg`: what fits in a frame.
[[nodiscard]] Parsed<Steps> parse_position(std::size_t joint, std::string_view text);

}  // namespace armjig::parol6::console
