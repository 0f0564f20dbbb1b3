// SPDX-License-Identifier: Apache-2.0
// The judges' laws and the emulator's tables were written apart; here they meet.
#include "conformance/kinovazed/laws.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "emulators/kinovazed/behaviour.hpp"
#include "emulators/kinovazed/machine.hpp"
#include "harness/drive/kinovazed/drive.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using emulation::ArmEvent;
using emulation::shipped_machine;

std::vector<State> all_states() {
  std::vector<State> states;
  for (std::size_t i = 0; i < kStateNames.size(); ++i) states.push_back(static_cast<State>(i));
  return states;
}

std::vector<Verb> answered_verbs() {
  std::vector<Verb> verbs;
  for (std::size_t i = 0; i < kAnsweredVerbs; ++i) verbs.push_back(static_cast<Verb>(i));
  return verbs;
}

TEST(KinovaLaws, LeadFromEveryStateByEveryCommandWhereTheEmulatorGoes) {
  for (const auto state : all_states()) {
    for (const auto verb : answered_verbs()) {
      const auto judged =
          is_accepted(state, verb) ? std::optional{leads_to(verb)} : std::optional<State>{};
      EXPECT_EQ(judged, shipped_machine().next_state(state, verb))
          << to_string(verb) << " in " << to_string(state);
    }
  }
}

TEST(KinovaLaws, EndWhatTheArmEndsWhereTheEmulatorDoes) {
  for (const auto& row : shipped_machine().arm) {
    const auto mode = row.event == ArmEvent::kModeChanged ? Mode::kAxis4to6 : Mode::kNoMode;
    if (!row.reaction.said) continue;
    EXPECT_EQ(state_behind(*row.reaction.said, mode), row.reaction.next)
        << to_string(*row.reaction.said);
  }
}

/// What a client waits for is what the arm says where the command leads, or, of a command that asks
/// nothing of the arm, what is told at once.
TEST(KinovaLaws, AndTheDriveAwaitTheEventsThatTheEmulatorHas) {
  const auto& rows = shipped_machine().arm;
  for (const auto verb : answered_verbs()) {
    const auto awaited = drive::event_of(verb);
    const bool is_said_by_arm = std::ranges::any_of(
        rows, [&](const auto& row) { return row.state == leads_to(verb) && row.reaction.said; });
    if (!is_said_by_arm) {
      EXPECT_TRUE(!awaited || state_behind(*awaited, {}) == leads_to(verb)) << to_string(verb);
      continue;
    }
    for (const auto& row : rows) {
      if (row.state != leads_to(verb) || !row.reaction.said) continue;
      EXPECT_EQ(awaited, row.reaction.said) << to_string(verb);
    }
  }
}

TEST(KinovaLaws, ReadEveryHeartbeatAsTheEmulatorFlagsItsStates) {
  for (int flags = 0; flags <= UINT8_MAX; ++flags) {
    const auto states = all_states();
    const auto first = std::ranges::find_if(
        states, [&](State state) { return (shipped_machine().flag(state) & flags) != 0; });
    const auto wanted = first == states.end() ? std::optional<State>{} : std::optional{*first};
    EXPECT_EQ(shown_state({static_cast<std::uint8_t>(flags)}), wanted) << flags;
  }
  for (const auto state : all_states()) {
    const auto beyond = beat_of(state).flags & ~(beat::kConnected | beat::kInitialized);
    EXPECT_EQ(beyond, shipped_machine().flag(state)) << to_string(state);
    EXPECT_NE(beat_of(state).flags & beat::kConnected, 0) << to_string(state);
  }
}

TEST(KinovaLaws, HaveTheTimesOfTheEmulator) {
  for (const auto& behaviour : {emulation::kFirmwareBehaviour, emulation::kDocumentedBehaviour}) {
    EXPECT_EQ(kModePause, behaviour.mode_settles);
    EXPECT_EQ(kBeatPeriod, behaviour.beat_period);
  }
}

}  // namespace
}  // namespace armjig::kinovazed::conformance
