// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "harness/wire/kinovazed/line.hpp"
#include "harness/wire/kinovazed/state.hpp"

/// What the server may do when: what commands and the arm make of its states. Tables only; time and
/// arm are elsewhere.
namespace armjig::kinovazed::emulation {

/// What the supervision of the arm tells.
enum class ArmEvent : std::uint8_t {
  kInitialized,
  kHomeReached,
  kRetractionReached,
  kModeChanged,
  kNoModeChanged,
  kPointReached,
  kLastPointReached,
  kReconnected,
};

struct ArmReaction {
  State next{};
  std::optional<Event> said;
};

struct ArmRow {
  ArmEvent event{};
  State state{};
  ArmReaction reaction{};
};

/// A whole machine, as data: another one is a server that is wrong.
struct Machine {
  std::array<std::array<std::optional<State>, kAnsweredVerbs>, kStateNames.size()> commands{};
  std::array<ArmRow, 7> arm{};
  std::array<std::uint8_t, kStateNames.size()> flags{};

  /// The state that a command leads to, or none: `Rejected`.
  [[nodiscard]] std::optional<State> next_state(State state, Verb verb) const noexcept {
    return commands[static_cast<std::size_t>(state)][static_cast<std::size_t>(verb)];
  }

  /// What an event of the arm does in a state, or none: nothing, not even a word. `kReconnected` is
  /// not asked here: it stops the arm in any state.
  [[nodiscard]] std::optional<ArmReaction> reaction(State state, ArmEvent event) const noexcept;

  /// The flag of a state; 0 for those that no bit shows.
  [[nodiscard]] std::uint8_t flag(State state) const noexcept {
    return flags[static_cast<std::size_t>(state)];
  }
};

/// The machine of every server that there is.
[[nodiscard]] const Machine& shipped_machine() noexcept;

}  // namespace armjig::kinovazed::emulation
