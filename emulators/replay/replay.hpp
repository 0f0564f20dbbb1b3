// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "harness/capture/trace.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// What a replay has to show.
struct Replayed {
  std::vector<TraceEvent> recorded;  ///< the lines that the emulator must reproduce
  std::vector<TraceEvent> actual;    ///< what it sent
};

/// Where the two first disagree, by the rules that recordings of the device have.
using Comparison = std::optional<TraceDifference> (*)(const std::vector<TraceEvent>& recorded,
                                                      const std::vector<TraceEvent>& actual);

/// A device whose recordings can be replayed into an emulator.
struct ReplayEntry {
  std::string_view device;
  /// Drives a fresh emulator with the stimulus of the recording.
  Outcome<Replayed> (*replay)(const Trace& trace);
  Comparison compare = first_difference;
};

/// All of them, by name.
[[nodiscard]] std::span<const ReplayEntry> replays() noexcept;

/// Replays a recording and compares. No difference: the emulator and the recorded device are
/// identical there. `kUnknownDevice` if no emulator can replay the device.
[[nodiscard]] Outcome<std::optional<TraceDifference>> verify(const Trace& trace);

}  // namespace armjig
