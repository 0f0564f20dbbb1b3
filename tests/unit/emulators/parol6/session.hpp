// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "emulators/parol6/board.hpp"
#include "harness/core/time.hpp"

namespace armjig::parol6::emulation {

/// One thing that is done to a board.
struct Action {
  Instant time{};
  std::string what;  ///< for messages
  std::function<void(Board&)> act;
};

/// A board's life, drawn at random: every command at all kinds of speeds and targets, noise and
/// bursts on the link, gripper answers, and an arm that somebody pushes, jams and switches off.
/// Switches are near, so that homing gets somewhere. The same seed is the same session on every
/// machine.
struct Session {
  Plant plant;
  BoardTiming timing;
  std::vector<Action> actions;
  Instant end{};
};

[[nodiscard]] Session random_session(std::uint64_t seed, Duration length);

}  // namespace armjig::parol6::emulation
