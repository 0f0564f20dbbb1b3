// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/laws.hpp"

#include <algorithm>
#include <array>

namespace armjig::kinovazed::conformance {
namespace {

using enum State;

/// A set of states, a bit for each.
template <class... States>
constexpr unsigned one_of(States... states) noexcept {
  return (... | (1U << static_cast<unsigned>(states)));
}
constexpr unsigned kAnyState = ~0U;

struct Way {
  Verb verb;
  State to;
  unsigned from;
};
/// By `Verb`.
constexpr std::array<Way, kAnsweredVerbs> kWays{{
    {Verb::kEStop, kEmergencyStopped, kAnyState},
    {Verb::kQuitEStop, kPoweredOff, one_of(kEmergencyStopped, kPoweredOff)},
    {Verb::kInitialize, kInitializing, one_of(kPoweredOff, kIdle)},
    {Verb::kUnfold, kUnfolding, one_of(kRetracted)},
    {Verb::kRetract, kRetracting, one_of(kIdle, kSettingMode)},
    {Verb::kFreeze, kFrozen, one_of(kIdle, kSteering)},
    {Verb::kUnfreeze, kIdle, one_of(kFrozen)},
    {Verb::kSetJoystickMode, kSettingMode, one_of(kIdle, kSteering, kRunningSequence)},
    {Verb::kMoveJoystick, kSteering, one_of(kSteering)},
    {Verb::kRunObjective, kRunningSequence, one_of(kIdle, kSteering, kRunningSequence)},
}};

constexpr const Way& way_of(Verb verb) noexcept { return kWays[static_cast<std::size_t>(verb)]; }

struct Sign {
  std::uint8_t flag;
  State state;
};
/// If a heartbeat has several, the first counts.
constexpr std::array kSigns{
    Sign{beat::kEmergencyStop, kEmergencyStopped},
    Sign{beat::kIdle, kIdle},
    Sign{beat::kRetracted, kRetracted},
    Sign{beat::kInJoystickMode, kSteering},
    Sign{beat::kRunningObjective, kRunningSequence},
    Sign{beat::kFreezed, kFrozen},
};

}  // namespace

State leads_to(Verb verb) noexcept { return way_of(verb).to; }

bool is_accepted(State state, Verb verb) noexcept {
  return (way_of(verb).from & one_of(state)) != 0;
}

State state_behind(Event event, Mode mode) noexcept {
  if (event == Event::kRetracted) return kRetracted;
  if (event == Event::kFreezed) return kFrozen;
  return event == Event::kJoystickModeSet && mode != Mode::kNoMode ? kSteering : kIdle;
}

std::optional<State> shown_state(Heartbeat beat) noexcept {
  for (const auto& sign : kSigns) {
    if ((beat.flags & sign.flag) != 0) return sign.state;
  }
  return std::nullopt;
}

Heartbeat beat_of(State state) noexcept {
  const auto sign = std::ranges::find(kSigns, state, &Sign::state);
  const bool is_initialized =
      (one_of(state) & one_of(kEmergencyStopped, kPoweredOff, kInitializing)) == 0;
  return {static_cast<std::uint8_t>(beat::kConnected | (sign == kSigns.end() ? 0 : sign->flag) |
                                    (is_initialized ? beat::kInitialized : 0))};
}

}  // namespace armjig::kinovazed::conformance
