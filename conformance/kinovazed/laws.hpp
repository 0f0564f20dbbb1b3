// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "harness/core/time.hpp"
#include "harness/wire/kinovazed/line.hpp"
#include "harness/wire/kinovazed/state.hpp"

/// What the judges of servers and of their clients hold to be right, read from
/// docs/spec/kinovazed.md ("States", "Interrupts and ends", "Heartbeats", "Times"). The emulator
/// has all of it too, written for itself; nothing is shared, and a test compares the two.
namespace armjig::kinovazed::conformance {

/// Two modes that are nearer to each other hang a shipped server ("Times").
inline constexpr Duration kModePause = std::chrono::milliseconds{500};
/// From one heartbeat to the next.
inline constexpr Duration kBeatPeriod = std::chrono::seconds{1};

/// Where a command leads if it is accepted. Requires `is_answered(verb)`, here and below.
[[nodiscard]] State leads_to(Verb verb) noexcept;
[[nodiscard]] bool is_accepted(State state, Verb verb) noexcept;

/// Where an event leads that is no answer; `mode` is the one that was asked for last.
[[nodiscard]] State state_behind(Event event, Mode mode) noexcept;

/// The state that a heartbeat shows; none: one of those that no flag shows.
[[nodiscard]] std::optional<State> shown_state(Heartbeat beat) noexcept;

/// The heartbeat of a state, of an arm that is there. It is initialized unless the state comes
/// before that, or ends it.
[[nodiscard]] Heartbeat beat_of(State state) noexcept;

}  // namespace armjig::kinovazed::conformance
