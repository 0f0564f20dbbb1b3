// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/error.hpp"

namespace armjig::kinovazed {

/// A cell of a table in which the emulated server differs from the recorded one.
struct CellDifference {
  std::string cell;      ///< state and command
  std::string recorded;  ///< what was said, where it led, the heartbeats
  std::string actual;
};

/// How the emulated server does by a table of states and commands.
struct MatrixVerdict {
  std::size_t cells{};
  std::vector<CellDifference> differences;
};

/// Sends every command of a table (JSON, `state-command-matrix/1`, as captures/kinovazed/README.md
/// tells) to a fresh server in its state, with the slow arm of the recordings behind it, and
/// compares what comes. Keys that a cell does not have are not compared. Problems: `kMalformed`;
/// `where` is for messages.
[[nodiscard]] Outcome<MatrixVerdict> verify_matrix(std::string_view text, const std::string& where);

}  // namespace armjig::kinovazed
