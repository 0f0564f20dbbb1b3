// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum emulation::State;

/// Longer than what was interrupted would have taken with any arm.
constexpr Duration kLater = 6s;

template <emulation::State state>
void estop(ServerBench& server) {
  enter(server, state);
  server.accept("EStop");
  server.expect_quiet(kLater);
  server.expect_beat(3);
}

void table(ServerBench& server) {
  server.perform("Retract", Event::kRetracted);
  server.expect_beat(133);
  server.perform("Unfold", Event::kUnfolded);
  server.expect_beat(21);
  server.perform("Retract", Event::kRetracted);
  initialize_afresh(server);
  server.expect_beat(21);
}

void retract(ServerBench& server) {
  server.accept("SetJoystickMode:XYZ");
  server.accept("Retract");
  server.about("Retract during a change of mode");
  server.expect(Event::kRetracted, ServerBench::kMotionTime);
  server.expect_quiet(1s);
  server.expect_beat(133);
}

void mode(ServerBench& server) {
  server.accept(kFarObjective);
  server.pause(300ms);
  server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
  server.expect_quiet(kLater);
  server.expect_beat(69);
}

void objective(ServerBench& server) {
  server.accept(kFarObjective);
  server.pause(300ms);
  server.perform("RunObjective:Home", Event::kObjectiveDone);
  server.expect_quiet(kLater);
}

void late_mode(ServerBench& server) {
  server.accept("SetJoystickMode:XYZ");
  initialize_afresh(server);
  server.expect_quiet(1s);
  server.expect_beat(21);
}

void half_way(ServerBench& server) {
  server.accept("Retract");
  server.pause(800ms);
  initialize_afresh(server);
  server.expect_beat(21);
}

void from_anywhere(ServerBench& server) {
  server.perform("RunObjective:Home", Event::kObjectiveDone);
  server.perform("Retract", Event::kRetracted);
  server.expect_quiet(kLater);
  server.expect_beat(133);
}

/// The server has to see that the mode was another one before.
void fold_while_initializing(ServerBench& server) {
  enter(server, kInitializing);
  server.pause(500ms);
  server.touch("arm.mode", 3);
}

void sticks(ServerBench& server) {
  fold_while_initializing(server);
  server.expect(Event::kRetracted);
  server.refuse("Unfold");
  server.expect_beat(1);
}

void goes_on(ServerBench& server) {
  fold_while_initializing(server);
  server.expect(Event::kInitialized, ServerBench::kMotionTime);
}

void initialize_again(ServerBench& server) {
  initialize_at_home(server);
  server.expect(Event::kInitialized, ServerBench::kMotionTime);
  server.expect_beat(21);
}

void initialize_recurring(ServerBench& server) {
  server.perform("RunObjective:Home", Event::kObjectiveDone);
  server.perform("Initialize", Event::kInitialized, 500ms + server.noise());
}

constexpr Case kCases[] = {
    in(kIdle, "kinovazed.event.table", "Folding, unfolding, folding, initializing.", on<table>),
    in(kIdle, "kinovazed.interrupt.retract", "Retracted comes, and nothing else.", on<retract>),
    in(kIdle, "kinovazed.interrupt.mode", "JoystickModeSet comes, and nothing for 6 s.", on<mode>),
    in(kIdle, "kinovazed.interrupt.objective", "ObjectiveDone comes, and nothing for 6 s.",
       on<objective>),
    in(kInitializing, "kinovazed.interrupt.estop-initializing", "Nothing for 6 s, and beat 3.",
       on<estop<kInitializing>>),
    in(kRetracting, "kinovazed.interrupt.estop-retracting", "Nothing for 6 s, and beat 3.",
       on<estop<kRetracting>>),
    in(kUnfolding, "kinovazed.interrupt.estop-unfolding", "Nothing for 6 s, and beat 3.",
       on<estop<kUnfolding>>),
    in(kSettingMode, "kinovazed.interrupt.estop-setting-mode", "Nothing for 6 s, and beat 3.",
       on<estop<kSettingMode>>),
    in(kRunningSequence, "kinovazed.interrupt.estop-objective", "Nothing for 6 s, and beat 3.",
       on<estop<kRunningSequence>>),
    in(kIdle, "kinovazed.interrupt.late-mode", "Nothing for 1 s behind Initialized.",
       on<late_mode>),
    in(kIdle, "kinovazed.interrupt.half-way", "Initialized comes, and beat 21.", on<half_way>),
    in(kIdle, "kinovazed.retract.from-anywhere", "From Home, Retracted comes once.",
       on<from_anywhere>),
    in(kInitializing, "kinovazed.retract.while-initializing", "Retracted, then beat 1.",
       on<sticks>),
    in(kInitializing, "kinovazed.retract.goes-on", "Initialized comes all the same.", on<goes_on>),
    in(kIdle, "kinovazed.initialize.again", "From Home, beat 5, then Initialized.",
       on<initialize_again>),
    in(kIdle, "kinovazed.initialize.recurring", "From Home, Initialized within half a second.",
       on<initialize_recurring>),
};

}  // namespace

std::span<const Case> interrupt_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
