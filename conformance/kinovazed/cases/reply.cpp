// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using namespace emulation;

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
    from(kStopped, Hazard::kState, "kinovazed.reply.words",
         "Five answers and two beats are spelled as they should.", on<words>),
    from(kStopped, Hazard::kState, "kinovazed.reply.one", "Forty commands get forty answers.",
         on<one>),
    full(from(kReady, Hazard::kMove, "kinovazed.reply.accepted-first",
              "Six commands are Accepted and then done.", on<accepted_first>)),
    from(kReady, Hazard::kMove, "kinovazed.reply.event-only",
         "Four commands are done without Accepted.", on<event_only>),
    from(kReady, Hazard::kMove, "kinovazed.reply.prompt",
         "Four times Freezed is the message behind Accepted.", on<prompt>),
    from(kReady, Hazard::kMove, "kinovazed.reply.prompt-unfreezed",
         "Four times Unfreezed is the message behind Accepted.", on<prompt_unfreezed>),
    from(kReady, Hazard::kMove, "kinovazed.reply.race",
         "Five times NoMode gives Accepted and JoystickModeSet in any order.", on<race>),
    full(from(kReady, Hazard::kMove, "kinovazed.reply.once", "Nothing follows three events.",
              on<once>)),
    full(from(kReady, Hazard::kMove, "kinovazed.reply.recurring",
              "Freezed and Retracted come again.", on<recurring>)),
    full(from(kReady, Hazard::kMove, "kinovazed.reply.not-recurring",
              "A second Freeze and a second Retract are Rejected.", on<not_recurring>)),
    full(from(kFolded, Hazard::kMove, "kinovazed.reply.recurring-idle",
              "Unfolded and Unfreezed come again.", on<recurring_idle>)),
    full(from(kFolded, Hazard::kMove, "kinovazed.reply.not-recurring-idle",
              "A second Unfold and a second Unfreeze are Rejected.", on<not_recurring_idle>)),
    from(kSteering, Hazard::kMove, "kinovazed.reply.recurring-mode",
         "XYZ is confirmed within 0.4 s when it is set.", on<recurring_mode>),
    from(kSteering, Hazard::kMove, "kinovazed.reply.not-recurring-mode",
         "XYZ takes more than 0.5 s when it is set.", on<not_recurring_mode>),
    full(from(kReady, Hazard::kMove, "kinovazed.reply.initialize-again",
              "Initialized comes within half a second when the arm is ready.",
              on<initialize_again>)),
    {.requirement = "kinovazed.time.answer",
     .variant = "stopped",
     .rule = "Fifteen answers in emergencyStopped come within half a second.",
     .run = on<answer>},
    from(kSteering, Hazard::kMove, "kinovazed.time.answer",
         "Three answers in steering come within half a second.", on<answer_steering>, "steering"),
    {.requirement = "kinovazed.console.silent",
     .rule = "Three console commands get no answer in emergencyStopped.",
     .run = on<console>},
    from(kReady, Hazard::kMove, "kinovazed.console.silent",
         "Three console commands get no answer in idle.", on<console>, "idle"),
    full(from(kFolded, Hazard::kMove, "kinovazed.console.silent",
              "Three console commands get no answer in retracted.", on<console>, "retracted")),
    {.requirement = "kinovazed.console.harmless",
     .variant = "stopped",
     .rule = "Beat 3 follows.",
     .run = on<console_harmless<State::kEmergencyStopped>>},
    from(kSteering, Hazard::kMove, "kinovazed.console.harmless", "Beat 69 follows.",
         on<console_harmless<State::kSteering>>, "steering"),
    from(kReady, Hazard::kMove, "kinovazed.console.harmless", "Beat 13 follows.",
         on<console_harmless<State::kFrozen>>, "frozen"),
};

}  // namespace

std::span<const Case> reply_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
