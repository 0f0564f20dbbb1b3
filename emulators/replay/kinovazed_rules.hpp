// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "harness/capture/trace.hpp"
#include "harness/core/time.hpp"

namespace armjig::kinovazed::replay {

/// In what a replay may differ from a recording of a server (captures/kinovazed/README.md, "What is
/// exact and what is not"). Everything else is exact.
struct SessionRules {
  Duration late =
      std::chrono::milliseconds{20};  ///< than recorded; recorders are late, never early
  Duration early = std::chrono::milliseconds{60};  ///< than recorded
  double motion_late = 0.01;                       ///< of the time, if that is more
  double motion_early = 0.03;                      ///< of the time, if that is more
  /// Messages that end a motion.
  std::array<std::string_view, 4> motions{"Initialized\r\n", "Unfolded\r\n", "Retracted\r\n",
                                          "ObjectiveDone\r\n"};
  /// Messages that may overtake their `Accepted`, if both come at the same time.
  std::array<std::string_view, 4> racing{"Initialized\r\n", "Unfolded\r\n", "Retracted\r\n",
                                         "JoystickModeSet\r\n"};
  Duration same_time = std::chrono::milliseconds{60};
  /// A beat that is closer than this to a message may have the state before or behind it.
  Duration beat_near = std::chrono::milliseconds{60};
};

/// By `rules`: for each connection messages, ends and refusals with their order and times; values
/// of beats; and what is left of the server.
[[nodiscard]] std::optional<TraceDifference> session_difference(
    const std::vector<TraceEvent>& recorded, const std::vector<TraceEvent>& actual,
    const SessionRules& rules);
[[nodiscard]] std::optional<TraceDifference> session_difference(
    const std::vector<TraceEvent>& recorded, const std::vector<TraceEvent>& actual);

}  // namespace armjig::kinovazed::replay
