// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "cli/command.hpp"
#include "harness/core/error.hpp"

namespace armjig::cli {

/// What an emulator makes of a recording.
struct Verified {
  bool is_identical = false;
  std::string device;  ///< as the recording calls it; empty: of a table
  std::string title;   ///< as its author calls it, may be empty
  std::string what;    ///< the first difference, of a table all of them: indented lines
  std::optional<std::size_t> cells{};  ///< of a table
  bool is_of_capture = false;          ///< made by `--capture` or `record`
};

/// Replays a recording, or a table of states and commands (`*.json`), into a fresh emulator in
/// virtual time. Problems: those of the file; `kUnknownDevice`: no emulator here replays it.
[[nodiscard]] Outcome<Verified> verify_recording(const std::string& path, Devices devices);

/// The text of a recording with what the emulator says now. Not of tables, nor of what `--capture`
/// made, which is recorded again. Problems: those of the file.
[[nodiscard]] Outcome<std::string> renewed_recording(const std::string& path, Devices devices);

/// The target of a recording of `--capture`, to record it again. Problems: as for
/// `emulated_target_of`.
[[nodiscard]] Outcome<std::string> target_of_recording(const std::string& path);

}  // namespace armjig::cli
