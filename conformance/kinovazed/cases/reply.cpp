// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "conformance/kinovazed/chapters.hpp"
#include "conformance/kinovazed/server_bench.hpp"
#include "conformance/kinovazed/ways.hpp"
#include "conformance/kinovazed/wording.hpp"

namespace armjig::kinovazed {
namespace {

using namespace std::chrono_literals;

void words(ServerBench& server) {
  server.accept("QuitEStop");
  server.refuse("Unfold");
  server.await_beat();
  server.accept("EStop");
  server.await_beat();
}

void one(ServerBench& server) {
  for (int i = 0; i < 10; ++i) {
    server.accept("EStop");
    server.refuse("Unfold");
    server.accept("QuitEStop");
    server.refuse("MoveJoystick:1:2:3");
  }
  server.expect_silence();
}

void accepted_first(ServerBench& server) {
  server.accept("Freeze");
  server.expect(Event::kFreezed);
  server.accept("Unfreeze");
  server.expect(Event::kUnfreezed);
  server.accept("SetJoystickMode:XYZ");
  server.expect(Event::kJoystickModeSet);
  server.accept("RunObjective:Current");
  server.expect(Event::kObjectiveDone);
  server.accept("Retract");
  server.expect(Event::kRetracted, ServerBench::kMotionTime);
  server.accept("Unfold");
  server.expect(Event::kUnfolded, ServerBench::kMotionTime);
}

void event_only(ServerBench& server) {
  server.say("Freeze");
  server.expect(Event::kFreezed);
  server.say("Unfreeze");
  server.expect(Event::kUnfreezed);
  server.say("SetJoystickMode:XYZ");
  server.expect(Event::kJoystickModeSet);
  server.say("Freeze");
  server.expect(Event::kFreezed);
}

/// The event is the very next message behind `Accepted`.
void expect_prompt(ServerBench& server, std::string_view command, Event event) {
  server.about(std::string{command});
  server.say(command);
  const auto accepted = server.expect(Event::kAccepted);
  const auto done = server.expect(event);
  server.expect_true(done.order == accepted.order + 1, "nothing in between",
                     "a heartbeat in between");
  expect_time(server, done.time - accepted.time, 0ms, 150ms + server.noise());
}

void prompt(ServerBench& server) {
  for (int i = 0; i < 4; ++i) {
    expect_prompt(server, "Freeze", Event::kFreezed);
    server.perform("Unfreeze", Event::kUnfreezed);
  }
}

void prompt_unfreezed(ServerBench& server) {
  for (int i = 0; i < 4; ++i) {
    server.perform("Freeze", Event::kFreezed);
    expect_prompt(server, "Unfreeze", Event::kUnfreezed);
  }
}

void race(ServerBench& server) {
  for (int i = 0; i < 5; ++i) server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet);
  server.expect_silence();
}

void once(ServerBench& server) {
  server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
  server.expect_quiet(700ms);
  server.perform("Freeze", Event::kFreezed);
  server.expect_quiet(700ms);
  server.perform("Unfreeze", Event::kUnfreezed);
  server.expect_quiet(700ms);
}

void recurring(ServerBench& server) {
  server.perform("Freeze", Event::kFreezed);
  server.perform("Freeze", Event::kFreezed);
  server.perform("Unfreeze", Event::kUnfreezed);
  server.perform("Retract", Event::kRetracted);
  server.perform("Retract", Event::kRetracted, 500ms);
}

void not_recurring(ServerBench& server) {
  server.perform("Freeze", Event::kFreezed);
  server.refuse("Freeze");
  server.perform("Unfreeze", Event::kUnfreezed);
  server.perform("Retract", Event::kRetracted);
  server.refuse("Retract");
}

void recurring_idle(ServerBench& server) {
  server.perform("Unfold", Event::kUnfolded);
  server.perform("Unfold", Event::kUnfolded);
  server.perform("Freeze", Event::kFreezed);
  server.perform("Unfreeze", Event::kUnfreezed);
  server.perform("Unfreeze", Event::kUnfreezed);
}

void not_recurring_idle(ServerBench& server) {
  server.perform("Unfold", Event::kUnfolded);
  server.refuse("Unfold");
  server.perform("Freeze", Event::kFreezed);
  server.perform("Unfreeze", Event::kUnfreezed);
  server.refuse("Unfreeze");
}

/// How long it takes to set the mode that is set.
Duration same_mode(ServerBench& server) {
  const auto said = server.now();
  return server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet).time - said;
}

void recurring_mode(ServerBench& server) {
  expect_time(server, same_mode(server), 0ms, 400ms + server.noise());
}

void not_recurring_mode(ServerBench& server) {
  expect_time(server, same_mode(server), 500ms, 1s + server.noise());
}

void initialize_again(ServerBench& server) {
  server.perform("Initialize", Event::kInitialized, 500ms + server.noise());
  server.expect_beat(21);
}

/// The first word behind a command, whichever.
void expect_soon(ServerBench& server, std::string_view command, Event answer) {
  server.about(std::string{command});
  const auto said = server.now();
  server.say(command);
  const auto heard = server.expect(answer);
  expect_time(server, heard.time - said, 0ms, 500ms + server.noise());
}

void answer(ServerBench& server) {
  for (int i = 0; i < 5; ++i) {
    expect_soon(server, "EStop", Event::kAccepted);
    expect_soon(server, "Initialize", Event::kRejected);
    expect_soon(server, "MoveJoystick:1:1:1", Event::kRejected);
  }
}

void answer_steering(ServerBench& server) {
  expect_soon(server, "MoveJoystick:0:0:0", Event::kAccepted);
  expect_soon(server, "Retract", Event::kRejected);
  expect_soon(server, "EStop", Event::kAccepted);
}

/// With `Current` active the position in its frame is the origin, which every server survives.
void console(ServerBench& server) {
  server.ignored("SetActiveObjective:Current\r\n");
  server.ignored("GetObjectivePosition\r\n");
  server.ignored("GetAbsolutePosition\r\n");
  server.expect_silence();
}

template <State state>
void console_harmless(ServerBench& server) {
  enter(server, state);
  for (const auto* command :
       {"SetActiveObjective:Current", "GetObjectivePosition", "GetAbsolutePosition"}) {
    server.say(command);
  }
  server.expect_silence();
  server.expect_beat(beat_of(state));
}

constexpr Case kCases[] = {
    {.requirement = "kinovazed.reply.words",
     .rule = "Five answers and two beats are spelled as they should.",
     .run = on<words>,
     .hazard = Hazard::kState},
    {.requirement = "kinovazed.reply.one",
     .rule = "Forty commands get forty answers.",
     .run = on<one>,
     .hazard = Hazard::kState},
    {.requirement = "kinovazed.reply.accepted-first",
     .rule = "Six commands are Accepted and then done.",
     .run = on<accepted_first>,
     .hazard = Hazard::kMove,
     .tier = Tier::kFull,
     .start = kReady},
    {.requirement = "kinovazed.reply.event-only",
     .rule = "Four commands are done without Accepted.",
     .run = on<event_only>,
     .hazard = Hazard::kMove,
     .start = kReady},
    {.requirement = "kinovazed.reply.prompt",
     .rule = "Four times Freezed is the message behind Accepted.",
     .run = on<prompt>,
     .hazard = Hazard::kMove,
     .start = kReady},
    {.requirement = "kinovazed.reply.prompt-unfreezed",
     .rule = "Four times Unfreezed is the message behind Accepted.",
     .run = on<prompt_unfreezed>,
     .hazard = Hazard::kMove,
     .start = kReady},
    {.requirement = "kinovazed.reply.race",
     .rule = "Five times NoMode gives Accepted and JoystickModeSet in any order.",
     .run = on<race>,
     .hazard = Hazard::kMove,
     .start = kReady},
    {.requirement = "kinovazed.reply.once",
     .rule = "Nothing follows three events.",
     .run = on<once>,
     .hazard = Hazard::kMove,
     .tier = Tier::kFull,
     .start = kReady},
    {.requirement = "kinovazed.reply.recurring",
     .rule = "Freezed and Retracted come again.",
     .run = on<recurring>,
     .hazard = Hazard::kMove,
     .tier = Tier::kFull,
     .start = kReady},
    {.requirement = "kinovazed.reply.not-recurring",
     .rule = "A second Freeze and a second Retract are Rejected.",
     .run = on<not_recurring>,
     .hazard = Hazard::kMove,
     .tier = Tier::kFull,
     .start = kReady},
    {.requirement = "kinovazed.reply.recurring-idle",
     .rule = "Unfolded and Unfreezed come again.",
     .run = on<recurring_idle>,
     .hazard = Hazard::kMove,
     .tier = Tier::kFull,
     .start = kFolded},
    {.requirement = "kinovazed.reply.not-recurring-idle",
     .rule = "A second Unfold and a second Unfreeze are Rejected.",
     .run = on<not_recurring_idle>,
     .hazard = Hazard::kMove,
     .tier = Tier::kFull,
     .start = kFolded},
    {.requirement = "kinovazed.reply.recurring-mode",
     .rule = "XYZ is confirmed within 0.4 s when it is set.",
     .run = on<recurring_mode>,
     .hazard = Hazard::kMove,
     .start = kSteering},
    {.requirement = "kinovazed.reply.not-recurring-mode",
     .rule = "XYZ takes more than 0.5 s when it is set.",
     .run = on<not_recurring_mode>,
     .hazard = Hazard::kMove,
     .start = kSteering},
    {.requirement = "kinovazed.reply.initialize-again",
     .rule = "Initialized comes within half a second when the arm is ready.",
     .run = on<initialize_again>,
     .hazard = Hazard::kMove,
     .tier = Tier::kFull,
     .start = kReady},
    {.requirement = "kinovazed.time.answer",
     .variant = "stopped",
     .rule = "Fifteen answers in emergencyStopped come within half a second.",
     .run = on<answer>},
    {.requirement = "kinovazed.time.answer",
     .variant = "steering",
     .rule = "Three answers in steering come within half a second.",
     .run = on<answer_steering>,
     .hazard = Hazard::kMove,
     .start = kSteering},
    {.requirement = "kinovazed.console.silent",
     .rule = "Three console commands get no answer in emergencyStopped.",
     .run = on<console>},
    {.requirement = "kinovazed.console.silent",
     .variant = "idle",
     .rule = "Three console commands get no answer in idle.",
     .run = on<console>,
     .hazard = Hazard::kMove,
     .start = kReady},
    {.requirement = "kinovazed.console.silent",
     .variant = "retracted",
     .rule = "Three console commands get no answer in retracted.",
     .run = on<console>,
     .hazard = Hazard::kMove,
     .tier = Tier::kFull,
     .start = kFolded},
    {.requirement = "kinovazed.console.harmless",
     .variant = "stopped",
     .rule = "Beat 3 follows.",
     .run = on<console_harmless<State::kEmergencyStopped>>},
    {.requirement = "kinovazed.console.harmless",
     .variant = "steering",
     .rule = "Beat 69 follows.",
     .run = on<console_harmless<State::kSteering>>,
     .hazard = Hazard::kMove,
     .start = kSteering},
    {.requirement = "kinovazed.console.harmless",
     .variant = "frozen",
     .rule = "Beat 13 follows.",
     .run = on<console_harmless<State::kFrozen>>,
     .hazard = Hazard::kMove,
     .start = kReady},
};

}  // namespace

std::span<const Case> reply_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed
