// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "emulators/replay/replay.hpp"

namespace armjig::kinovazed::replay {

/// Sends every command of a table (JSON, `state-command-matrix/1`, as captures/kinovazed/README.md
/// tells) to a fresh server in its state, with the slow arm of the recordings behind it, and
/// compares what comes. Keys that a cell does not have are not compared. Problems: `kMalformed`;
/// `where` is for messages.
[[nodiscard]] Outcome<TableVerdict> verify_matrix(std::string_view text, const std::string& where);

}  // namespace armjig::kinovazed::replay
