// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/machine.hpp"

#include <algorithm>

namespace armjig::kinovazed::emulation {
namespace {

using Cell = std::optional<State>;
using enum State;

/// kinovazed.state.table. Columns are the verbs, in their order: EStop, QuitEStop, Initialize,
/// Unfold, Retract, Freeze, Unfreeze, SetJoystickMode, MoveJoystick, RunObjective.
constexpr decltype(Machine::commands) kCommands = [] {
  // As short as the table that they fill needs them.
  // NOLINTBEGIN(readability-identifier-naming)
  constexpr Cell r{};  // Rejected
  constexpr Cell off{kPoweredOff};
  constexpr Cell ini{kInitializing};
  constexpr Cell stop{kEmergencyStopped};
  constexpr Cell idle{kIdle};
  constexpr Cell fold{kRetracting};
  constexpr Cell unf{kUnfolding};
  constexpr Cell mode{kSettingMode};
  constexpr Cell move{kSteering};
  constexpr Cell run{kRunningSequence};
  constexpr Cell frz{kFrozen};
  // NOLINTEND(readability-identifier-naming)
  return decltype(Machine::commands){{
      {stop, off, r, r, r, r, r, r, r, r},            // emergencyStopped
      {stop, off, ini, r, r, r, r, r, r, r},          // poweredOff
      {stop, r, r, r, r, r, r, r, r, r},              // initializing
      {stop, r, ini, r, fold, frz, r, mode, r, run},  // idle
      {stop, r, r, r, r, r, r, r, r, r},              // retracting
      {stop, r, r, unf, r, r, r, r, r, r},            // retracted
      {stop, r, r, r, r, r, r, r, r, r},              // unfolding
      {stop, r, r, r, fold, r, r, r, r, r},           // settingMode: kinovazed.interrupt.retract
      {stop, r, r, r, r, frz, r, mode, move, run},    // steering
      {stop, r, r, r, r, r, r, mode, r, run},  // runningSequence: kinovazed.interrupt.objective
      {stop, r, r, r, r, r, idle, r, r, r},    // frozen
  }};
}();

/// kinovazed.event.table.
constexpr decltype(Machine::arm) kArmRows{
    ArmRow{ArmEvent::kInitialized, kInitializing, {kIdle, Event::kInitialized}},
    ArmRow{ArmEvent::kHomeReached, kUnfolding, {kIdle, Event::kUnfolded}},
    ArmRow{ArmEvent::kRetractionReached, kRetracting, {kRetracted, Event::kRetracted}},
    ArmRow{ArmEvent::kModeChanged, kSettingMode, {kSteering, Event::kJoystickModeSet}},
    ArmRow{ArmEvent::kNoModeChanged, kSettingMode, {kIdle, Event::kJoystickModeSet}},
    ArmRow{ArmEvent::kPointReached, kRunningSequence, {kRunningSequence, {}}},
    ArmRow{ArmEvent::kLastPointReached, kRunningSequence, {kIdle, Event::kObjectiveDone}},
};

/// kinovazed.beat.values. In the order of `State`.
constexpr decltype(Machine::flags) kFlagsOfStates{
    beat::kEmergencyStop, 0, 0, beat::kIdle,           0,
    beat::kRetracted,     0, 0, beat::kInJoystickMode, beat::kRunningObjective,
    beat::kFreezed};

constexpr Machine kShipped{kCommands, kArmRows, kFlagsOfStates};

}  // namespace

const Machine& shipped_machine() noexcept { return kShipped; }

std::optional<ArmReaction> Machine::reaction(State state, ArmEvent event) const noexcept {
  const auto row = std::ranges::find_if(arm, [&](const ArmRow& candidate) {
    return candidate.event == event && candidate.state == state;
  });
  return row == arm.end() ? std::nullopt : std::optional{row->reaction};
}

}  // namespace armjig::kinovazed::emulation
