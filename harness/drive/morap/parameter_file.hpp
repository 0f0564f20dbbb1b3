// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/error.hpp"
#include "harness/wire/morap/controller_set.hpp"

/// The parameters of a controller as a file that people write:
///
///     controller = "position"     # or "speed"
///     rate_hz = 400
///     d = [-8.20586205, 9.26545811]   # of the measured value; the last belongs to the newest
///     c = [-8.20585251, 9.26544857]   # of the reference
///     f = [-0.956420779]              # of earlier outputs
///     integral = 0.0
namespace armjig::morap::drive {

/// Reads such a file. Numbers are rounded to single precision. Problems: `kCannotRead`,
/// `kMalformed`; they name path and line.
[[nodiscard]] Outcome<ControllerSet> read_parameters(const std::string& path);
/// The same from text in memory; `path` is for messages.
[[nodiscard]] Outcome<ControllerSet> parse_parameters(std::string_view text, std::string path);

/// The file of a set; read again it is the same set to the bit, unless numbers are none (NaN).
/// Requires a position or speed controller and counts of at most four.
[[nodiscard]] std::string to_toml(const ControllerSet& set);

}  // namespace armjig::morap::drive
