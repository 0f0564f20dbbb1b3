// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum emulation::State;

constexpr auto kStop = "MoveJoystick:0:0:0";
constexpr auto kUp = "MoveJoystick:0:0:400";

template <const char* mode>
void set(ServerBench& server) {
  server.perform(std::string{"SetJoystickMode:"} + mode, Event::kJoystickModeSet);
  server.accept(kStop);
  server.expect_beat(69);
}
constexpr char kXyz[] = "XYZ";
constexpr char kRotation[] = "Rotation";
constexpr char kAxis1to3[] = "Axis1to3";
constexpr char kAxis4to6[] = "Axis4to6";

/// The shortest of three, for all that a link does makes it longer.
void settles(ServerBench& server) {
  auto shortest = ServerBench::kMotionTime;
  for (const auto* mode : {"Rotation", "XYZ", "Axis1to3"}) {
    const auto said = server.now();
    const auto set =
        server.perform(std::string{"SetJoystickMode:"} + mode, Event::kJoystickModeSet);
    shortest = std::min(shortest, set.time - said);
  }
  expect_time(server, shortest, 500ms, 680ms + server.noise());
}

/// From any state that takes modes.
void no_mode(ServerBench& server) {
  server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet, 400ms + server.noise());
  server.expect_beat(21);
}

void chain(ServerBench& server) {
  for (const auto* mode : {"Rotation", "Axis1to3", "Axis4to6", "XYZ"}) {
    server.perform(std::string{"SetJoystickMode:"} + mode, Event::kJoystickModeSet);
    server.accept(kStop);
  }
}

void gate(ServerBench& server) {
  server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet);
  server.refuse(kStop);
}

void behind_freeze(ServerBench& server) {
  server.perform("Freeze", Event::kFreezed);
  server.perform("Unfreeze", Event::kUnfreezed);
  server.refuse(kStop);
  server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
  server.accept(kStop);
}

void behind_objective(ServerBench& server) {
  server.perform("RunObjective:Current", Event::kObjectiveDone);
  server.refuse(kStop);
}

/// Each is undone in the same segment.
void any_number(ServerBench& server) {
  for (const auto* number : {"2147483647", "-2147483648", "400", "-1"}) {
    server.about(std::string{"a move by "} + number);
    server.send(std::string{"MoveJoystick:0:0:"} + number + "\r\nMoveJoystick:0:0:0\r\n");
    server.expect(Event::kAccepted);
    server.expect(Event::kAccepted);
  }
}

void stream(ServerBench& server) {
  std::string moves;
  for (int i = 0; i < 20; ++i) moves += "MoveJoystick:0:0:0\r\n";
  server.send(moves);
  for (int i = 0; i < 20; ++i) server.expect(Event::kAccepted);
  server.expect_silence();
}

/// An arm that was up for two seconds is 0.4 m away from Home, which takes time; one that was not
/// is there at once.
constexpr Duration kWayBack = 500ms;

void rise_from_home(ServerBench& server) {
  server.perform("RunObjective:Home", Event::kObjectiveDone);
  server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
  server.accept(kUp);
}

void expect_far_from_home(ServerBench& server) {
  const auto said = server.now();
  const auto done = server.perform("RunObjective:Home", Event::kObjectiveDone);
  server.about("the way back to Home");
  expect_time(server, done.time - said, kWayBack, ServerBench::kMotionTime);
}

void holds(ServerBench& server) {
  rise_from_home(server);
  server.pause(2s);
  server.accept(kStop);
  expect_far_from_home(server);
}

void client_lost(ServerBench& server) {
  rise_from_home(server);
  server.pause(100ms);
  server.leave();
  server.pause(2s);
  server.connect();
  server.accept(kStop);
  expect_far_from_home(server);
}

/// Two modes with less than half a second between them, which is why the arm has to be ready.
void two_modes(ServerBench& server) {
  server.accept("SetJoystickMode:XYZ");
  initialize_afresh(server);
  server.say("SetJoystickMode:Rotation");
}

void guard(ServerBench& server) {
  server.spoil(ServerBench::Recovery::kByHand);
  two_modes(server);
  server.expect(Event::kAccepted);
  server.about("behind two modes within half a second");
  expect_hung(server);
}

void no_guard(ServerBench& server) {
  server.spoil(ServerBench::Recovery::kByHand);
  two_modes(server);
  server.pause(1s);
  server.expect_true(server.answers(), "an answer", "silence");
}

void late_enough(ServerBench& server) {
  server.accept("SetJoystickMode:XYZ");
  switch_off(server);
  server.pause(700ms);
  server.perform("Initialize", Event::kInitialized);
  server.perform("SetJoystickMode:Rotation", Event::kJoystickModeSet);
  server.expect_beat(69);
}

constexpr Case kCases[] = {
    in(kIdle, "kinovazed.mode.settles", "0.5 to 0.7 s.", on<settles>),
    in(kSteering, "kinovazed.mode.no-mode", "Within 0.4 s, and beat 21.", on<no_mode>),
    in(kIdle, "kinovazed.mode.no-mode-idle", "Within 0.4 s, and beat 21.", on<no_mode>),
    in(kIdle, "kinovazed.mode.xyz", "A move is Accepted, and beat 69.", on<set<kXyz>>),
    in(kIdle, "kinovazed.mode.rotation", "A move is Accepted, and beat 69.", on<set<kRotation>>),
    in(kIdle, "kinovazed.mode.axis1to3", "A move is Accepted, and beat 69.", on<set<kAxis1to3>>),
    in(kIdle, "kinovazed.mode.axis4to6", "A move is Accepted, and beat 69.", on<set<kAxis4to6>>),
    in(kSteering, "kinovazed.mode.chain", "Four modes, and moves between them.", on<chain>),
    in(kSteering, "kinovazed.joystick.gate", "Rejected.", on<gate>),
    in(kSteering, "kinovazed.joystick.behind-freeze", "Rejected, and Accepted behind a mode.",
       on<behind_freeze>),
    in(kSteering, "kinovazed.joystick.behind-objective", "Rejected.", on<behind_objective>),
    in(kSteering, "kinovazed.joystick.any-number", "Four numbers are Accepted.", on<any_number>),
    in(kSteering, "kinovazed.joystick.stream", "Twenty moves in one go are Accepted.", on<stream>),
    in(kIdle, "kinovazed.joystick.holds", "Two seconds up, and Home is far away.", on<holds>),
    in(kIdle, "kinovazed.joystick.client-lost",
       "Two seconds up without a client, and Home is far away.", on<client_lost>),
    from(kReady, Hazard::kCrash, "kinovazed.mode.guard",
         "Accepted, and then nothing, not even a beat.", on<guard>),
    from(kReady, Hazard::kCrash, "kinovazed.mode.no-guard", "EStop is answered.", on<no_guard>),
    in(kIdle, "kinovazed.mode.late-enough", "The second mode is set.", on<late_enough>),
};

}  // namespace

std::span<const Case> joystick_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
