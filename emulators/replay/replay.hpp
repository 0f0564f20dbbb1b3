// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/replay/touches.hpp"
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

/// Time, kind, CAN identifier and bytes of an event from the device.
[[nodiscard]] std::string write_event(std::string_view line, const TraceEvent& actual);

/// How recordings of one device are replayed into a fresh emulator.
struct Replay {
  /// Drives it with the stimulus of the recording.
  Outcome<Replayed> (*run)(const Trace& trace){};
  Comparison compare = first_difference;
  /// The same as `run` by the plain model of the device, which computes everything and leaps over
  /// nothing. nullptr: there is no other model.
  Outcome<Replayed> (*run_plainly)(const Trace& trace){};
  /// The line of a recording that says what the emulator did, one of `Replayed::actual`. `line` is
  /// the recorded one that it answers (`actual.line`; 1 is the header); empty: it stands by itself.
  std::string (*write)(std::string_view line, const TraceEvent& actual) = write_event;
  /// What was done beside the link.
  TouchesOf touches_of{};
  /// Tries it cell by cell on a table of states and commands; nullptr: there are none of the
  /// device. Problems: `kMalformed`; `where` is for messages.
  Outcome<TableVerdict> (*verify_table)(std::string_view text, const std::string& where){};
};

/// Replays a recording and compares. No difference: the emulator and the recorded device are
/// identical there.
[[nodiscard]] Outcome<std::optional<TraceDifference>> verify(const Trace& trace,
                                                             const Replay& replay);

/// What was done to the device: the recording without what came from it.
[[nodiscard]] Trace stimulus_of(Trace trace);

/// The text of a recording: what was done in `stimulus`, which has no answers, and what the
/// emulator does. `verify` finds no difference in it.
[[nodiscard]] Outcome<std::string> record(const Trace& stimulus, const Replay& replay);

}  // namespace armjig
