// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/ways.hpp"

namespace armjig::kinovazed::conformance {

using namespace emulation;

int beat_of(State state) noexcept {
  switch (state) {
    case State::kEmergencyStopped:
      return 3;
    case State::kPoweredOff:
    case State::kInitializing:
      return 1;
    case State::kIdle:
      return 21;
    case State::kRetracted:
      return 133;
    case State::kSteering:
      return 69;
    case State::kRunningSequence:
      return 37;
    case State::kFrozen:
      return 13;
    case State::kRetracting:
    case State::kUnfolding:
    case State::kSettingMode:
      break;
  }
  return 5;
}

void switch_off(ServerBench& server) {
  server.accept("EStop");
  server.accept("QuitEStop");
}

void enter(ServerBench& server, State state) {
  switch (state) {
    case State::kInitializing:
      switch_off(server);
      server.wait_until_before_beat(kBeforeBeat);
      return server.accept("Initialize");
    case State::kRetracting:
      server.wait_until_before_beat(kBeforeBeat);
      return server.accept("Retract");
    case State::kUnfolding:
      server.wait_until_before_beat(kBeforeBeat);
      return server.accept("Unfold");
    case State::kSettingMode:
      server.wait_until_before_beat(kBeforeBeat);
      return server.accept("SetJoystickMode:XYZ");
    case State::kRunningSequence:
      server.wait_until_before_beat(kBeforeBeat);
      return server.accept(kFarObjective);
    case State::kFrozen:
      server.perform("Freeze", Event::kFreezed);
      return;
    default:
      return;
  }
}

}  // namespace armjig::kinovazed::conformance
