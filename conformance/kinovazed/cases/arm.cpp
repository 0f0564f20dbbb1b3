// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum emulation::State;

/// A mode that cannot be read, once: the server notices at its next look.
template <emulation::State state>
void silent_stop(ServerBench& server) {
  enter(server, state);
  server.touch("arm.fail.status_read", 1);
  server.expect_quiet(300ms);
  server.expect_beat(3);
  server.expect_quiet(2s);
}

void recovers(ServerBench& server) {
  server.touch("arm.fail.current_read", 1);
  server.pause(300ms);
  server.accept("QuitEStop");
  server.perform("Initialize", Event::kInitialized);
  server.expect_beat(21);
}

void position_read(ServerBench& server) {
  server.touch("arm.fail.position_read", 1);
  server.expect_quiet(300ms);
  server.expect_beat(21);
}

/// Of a command whose event does not come, for `call` fails.
void expect_stop(ServerBench& server, std::string_view call, std::string_view command) {
  server.touch(call, 1);
  server.accept(command);
  server.expect_quiet(6s);
  server.expect_beat(3);
}

void take_control(ServerBench& server) {
  expect_stop(server, "arm.fail.take_control", "Initialize");
}

void button(ServerBench& server) {
  server.perform("Retract", Event::kRetracted);
  switch_off(server);
  expect_stop(server, "arm.fail.home_button_press", "Initialize");
}

void erase(ServerBench& server) { expect_stop(server, "arm.fail.trajectory_erase", kFarObjective); }

void release(ServerBench& server) {
  server.touch("arm.fail.joystick_release", 1);
  server.perform("Freeze", Event::kFreezed);
  server.expect_beat(3);
}

void move(ServerBench& server) {
  server.touch("arm.fail.joystick_axes_write", 1);
  server.accept("MoveJoystick:1:1:1");
  server.expect_beat(3);
}

void current_high(ServerBench& server) {
  server.accept(kFarObjective);
  server.touch("arm.current", 4000);
  server.expect(Event::kObjectiveDone, ServerBench::kMotionTime);
  server.touch("arm.current", 800);
}

void early_ready(ServerBench& server) {
  enter(server, kInitializing);
  server.touch("arm.mode", 1);
  server.expect(Event::kInitialized, 200ms);
}

constexpr Case kCases[] = {
    in(kEmergencyStopped, "kinovazed.arm.silent-stop", "From emergencyStopped, beat 3.",
       on<silent_stop<kEmergencyStopped>>, "stopped"),
    in(kPoweredOff, "kinovazed.arm.silent-stop", "From poweredOff, beat 3.",
       on<silent_stop<kPoweredOff>>, "off"),
    in(kIdle, "kinovazed.arm.silent-stop", "From idle, beat 3.", on<silent_stop<kIdle>>, "idle"),
    in(kInitializing, "kinovazed.arm.silent-stop", "From initializing, beat 3.",
       on<silent_stop<kInitializing>>, "initializing"),
    in(kRetracted, "kinovazed.arm.silent-stop", "From retracted, beat 3.",
       on<silent_stop<kRetracted>>, "retracted"),
    in(kRunningSequence, "kinovazed.arm.silent-stop", "From runningSequence, beat 3.",
       on<silent_stop<kRunningSequence>>, "running"),
    in(kSteering, "kinovazed.arm.silent-stop", "From steering, beat 3.", on<silent_stop<kSteering>>,
       "steering"),
    in(kIdle, "kinovazed.arm.recovers", "Initialized, and beat 21.", on<recovers>),
    in(kIdle, "kinovazed.arm.position-read", "No word, and beat 21.", on<position_read>),
    from(kOff, Hazard::kMove, "kinovazed.arm.take-control", "No word for 6 s, and beat 3.",
         on<take_control>),
    in(kIdle, "kinovazed.arm.button", "No word for 6 s, and beat 3.", on<button>),
    in(kIdle, "kinovazed.arm.erase", "No word for 6 s, and beat 3.", on<erase>),
    in(kIdle, "kinovazed.arm.release", "Freezed, and beat 3.", on<release>),
    in(kSteering, "kinovazed.arm.move", "Accepted, and beat 3.", on<move>),
    in(kIdle, "kinovazed.arm.current-high", "ObjectiveDone comes.", on<current_high>),
    in(kInitializing, "kinovazed.arm.early-ready", "Initialized comes within 0.2 s.",
       on<early_ready>),
};

}  // namespace

std::span<const Case> arm_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
