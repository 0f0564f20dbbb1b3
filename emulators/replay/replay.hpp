// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/capture/trace.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// What a replay has to show.
struct Replayed {
  std::vector<TraceEvent> recorded;  ///< the lines that the emulator must reproduce
  std::vector<TraceEvent> actual;    ///< what it sent

  void add(TraceEvent what_was, TraceEvent what_is) {
    recorded.push_back(std::move(what_was));
    actual.push_back(std::move(what_is));
  }
};

/// Where the two first disagree, by the rules that recordings of the device have.
using Comparison = std::optional<TraceDifference> (*)(const std::vector<TraceEvent>& recorded,
                                                      const std::vector<TraceEvent>& actual);

/// A cell of a table of states and commands in which the emulated device differs.
struct CellDifference {
  std::string cell;      ///< state and command
  std::string recorded;  ///< what was said, where it led
  std::string actual;
};

/// How an emulated device does by such a table.
struct TableVerdict {
  std::size_t cells{};
  std::vector<CellDifference> differences;
};

/// How recordings of one device are replayed into a fresh emulator.
struct Replay {
  /// Drives it with the stimulus of the recording.
  Outcome<Replayed> (*run)(const Trace& trace){};
  Comparison compare = first_difference;
  /// Tries it cell by cell on a table of states and commands; nullptr: there are none of the
  /// device. Problems: `kMalformed`; `where` is for messages.
  Outcome<TableVerdict> (*verify_table)(std::string_view text, const std::string& where){};
};

/// Replays a recording and compares. No difference: the emulator and the recorded device are
/// identical there.
[[nodiscard]] Outcome<std::optional<TraceDifference>> verify(const Trace& trace,
                                                             const Replay& replay);

}  // namespace armjig
