// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "conformance/kinovazed/laws.hpp"
#include "conformance/kinovazed/server_bench.hpp"
#include "conformance/suite.hpp"
#include "harness/rig/guard.hpp"

/// Ways into the states of the server.
namespace armjig::kinovazed::conformance {

/// A target so far away from the ready pose that the fastest arm needs more than a second.
inline constexpr auto kFarObjective = "RunObjective:SuckDoor";
/// A deflection of nothing.
inline constexpr auto kStop = "MoveJoystick:0:0:0";
/// Modes in which the joystick moves something.
inline constexpr char kXyz[] = "XYZ";
inline constexpr char kRotation[] = "Rotation";
inline constexpr char kAxis1to3[] = "Axis1to3";
inline constexpr char kAxis4to6[] = "Axis4to6";
/// The beat that shows a state of less than a second comes that long behind the command.
inline constexpr Duration kBeforeBeat = std::chrono::milliseconds{420};

/// From which start a case reaches a state by `enter`.
[[nodiscard]] constexpr Start start_for(State state) noexcept {
  switch (state) {
    case State::kEmergencyStopped:
      return kStopped;
    case State::kPoweredOff:
      return kOff;
    case State::kSteering:
      return kInMode;
    case State::kInitializing:
    case State::kRetracted:
    case State::kUnfolding:
      return kFolded;
    default:
      return kReady;
  }
}

[[nodiscard]] constexpr Hazard hazard_of(State state) noexcept {
  if (state == State::kEmergencyStopped) return Hazard::kObserve;
  return state == State::kPoweredOff ? Hazard::kState : Hazard::kMove;
}

/// Goes to the state from its start. A beat comes soon behind.
void enter(ServerBench& server, State state);

/// From retracted to poweredOff; the arm stays folded, so that initializing takes its time.
void switch_off(ServerBench& server);
/// The same, and initializes.
void initialize_afresh(ServerBench& server);

/// Begins again in idle, out of any state. What is said meanwhile is passed over.
void start_again(ServerBench& server);

/// Initializes again an arm that is there already, which a beat has to show.
void initialize_at_home(ServerBench& server);

/// How long an objective takes, from its command on. No message tells where the arm is; this does.
[[nodiscard]] Duration time_of(ServerBench& server, std::string_view objective);

/// Within which a server does what nothing else has to come before.
inline constexpr Duration kSoon = std::chrono::milliseconds{500};

/// Says a command and ends its sending: the answer comes, and the end.
void half_close(ServerBench& server);
/// The end does not wait for the next beat.
void expect_soon_closed(ServerBench& server);

/// A second client connects and speaks while the first is served.
void say_while_waiting(ServerBench& server, std::string_view text);
/// Such a one is served soon once the first has ended its connection in this way.
void expect_next_served(ServerBench& server, void (*end)(ServerBench& server));

void expect_hung(ServerBench& server);

/// A case that begins where its state can be entered; with motion it is not quick.
[[nodiscard]] constexpr Case in(State state, std::string_view rule, CaseBody run) noexcept {
  const auto one = from(start_for(state), hazard_of(state), rule, run);
  return one.hazard == Hazard::kMove ? full(one) : one;
}

/// One that is worth its time in quick runs, too.
[[nodiscard]] constexpr Case quick(Case one) noexcept {
  one.tier = Tier::kQuick;
  return one;
}

}  // namespace armjig::kinovazed::conformance
