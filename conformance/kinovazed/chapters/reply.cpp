// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

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

/// How long it takes to set the mode that is set.
Duration same_mode(ServerBench& server) {
  const auto said = server.now();
  return server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet).time - said;
}

/// The first word behind a command, whichever.
void expect_soon(ServerBench& server, std::string_view command, Event answer) {
  server.about(std::string{command});
  const auto said = server.now();
  server.say(command);
  const auto heard = server.expect(answer);
  expect_time(server, heard.time - said, 0ms, ServerBench::kAnswerTime + server.link_noise());
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
  server.expect_beat(beat_of(state).flags);
}

constexpr Clause kReplyClauses[] = {
    must("kinovazed.reply.words",
         "All that the server sends are its nine words and heartbeats, each with CR LF.",
         "document; server"),
    from(kStopped, Hazard::kState, "Five answers and two beats are spelled as they should.",
         [](ServerBench& server) {
           server.accept("QuitEStop");
           server.refuse("Unfold");
           server.await_beat();
           server.accept("EStop");
           server.await_beat();
         }),

    must("kinovazed.reply.one",
         "Every command that is understood gets one Accepted or Rejected, in the order of the "
         "commands.",
         "server, state-command-matrix"),
    from(kStopped, Hazard::kState, "Forty commands get forty answers.",
         [](ServerBench& server) {
           for (int i = 0; i < 10; ++i) {
             server.accept("EStop");
             server.refuse("Unfold");
             server.accept("QuitEStop");
             server.refuse("MoveJoystick:1:2:3");
           }
           server.expect_silence();
         }),

    must("kinovazed.reply.accepted-first",
         "Commands with an event of their own are Accepted before it.",
         "server, state-command-matrix", Profiles::kFirmware, "kinovazed.reply.event-only"),
    full(from(kReady, Hazard::kMove, "Six commands are Accepted and then done.",
              [](ServerBench& server) {
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
              })),

    must("kinovazed.reply.event-only", "Commands with an event of their own get the event only.",
         "document: one positive answer to each command; our reading", Profiles::kDocumented,
         "kinovazed.reply.accepted-first"),
    from(kReady, Hazard::kMove, "Four commands are done without Accepted.",
         [](ServerBench& server) {
           server.say("Freeze");
           server.expect(Event::kFreezed);
           server.say("Unfreeze");
           server.expect(Event::kUnfreezed);
           server.say("SetJoystickMode:XYZ");
           server.expect(Event::kJoystickModeSet);
           server.say("Freeze");
           server.expect(Event::kFreezed);
         }),

    must("kinovazed.reply.prompt", "Freezed follows its Accepted at once, with nothing in between.",
         "server; reference 6.5", Profiles::kFirmware),
    from(kReady, Hazard::kMove, "Four times Freezed is the message after Accepted.",
         [](ServerBench& server) {
           for (int i = 0; i < 4; ++i) {
             expect_prompt(server, "Freeze", Event::kFreezed);
             server.perform("Unfreeze", Event::kUnfreezed);
           }
         }),

    must("kinovazed.reply.prompt-unfreezed",
         "Unfreezed follows its Accepted at once, with nothing in between.",
         "server; reference 6.5", Profiles::kFirmware),
    from(kReady, Hazard::kMove, "Four times Unfreezed is the message after Accepted.",
         [](ServerBench& server) {
           for (int i = 0; i < 4; ++i) {
             server.perform("Freeze", Event::kFreezed);
             expect_prompt(server, "Unfreeze", Event::kUnfreezed);
           }
         }),

    Requirement{
        "kinovazed.reply.race", Level::kMay,
        "If an action is over the moment it is asked for, its event may come before Accepted.",
        "server, recording repeat-initialize-swapped", Profiles::kFirmware},
    from(kReady, Hazard::kMove,
         "Five times NoMode gives Accepted and JoystickModeSet in any order.",
         [](ServerBench& server) {
           for (int i = 0; i < 5; ++i)
             server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet);
           server.expect_silence();
         }),

    must("kinovazed.reply.once", "An event is told once.", "server"),
    full(from(kReady, Hazard::kMove, "Nothing follows three events.",
              [](ServerBench& server) {
                server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
                server.expect_quiet(700ms);
                server.perform("Freeze", Event::kFreezed);
                server.expect_quiet(700ms);
                server.perform("Unfreeze", Event::kUnfreezed);
                server.expect_quiet(700ms);
              })),

    must("kinovazed.reply.recurring",
         "A command that has led to a resting state, given again there, gets its event again.",
         "document, recurring commands; our reading", Profiles::kDocumented,
         "kinovazed.reply.not-recurring"),
    full(from(kReady, Hazard::kMove, "Freezed and Retracted come again.",
              [](ServerBench& server) {
                server.perform("Freeze", Event::kFreezed);
                server.perform("Freeze", Event::kFreezed);
                server.perform("Unfreeze", Event::kUnfreezed);
                server.perform("Retract", Event::kRetracted);
                server.perform("Retract", Event::kRetracted, 500ms);
              })),

    must("kinovazed.reply.not-recurring", "Retract in retracted and Freeze in frozen are Rejected.",
         "server, recording repeat-retract", Profiles::kFirmware, "kinovazed.reply.recurring"),
    full(from(kReady, Hazard::kMove, "A second Freeze and a second Retract are Rejected.",
              [](ServerBench& server) {
                server.perform("Freeze", Event::kFreezed);
                server.refuse("Freeze");
                server.perform("Unfreeze", Event::kUnfreezed);
                server.perform("Retract", Event::kRetracted);
                server.refuse("Retract");
              })),

    must("kinovazed.reply.recurring-idle",
         "Unfold and Unfreeze, given again in the idle state to which they led, get their events "
         "again.",
         "document, recurring commands; our reading", Profiles::kDocumented,
         "kinovazed.reply.not-recurring-idle"),
    full(from(kFolded, Hazard::kMove, "Unfolded and Unfreezed come again.",
              [](ServerBench& server) {
                server.perform("Unfold", Event::kUnfolded);
                server.perform("Unfold", Event::kUnfolded);
                server.perform("Freeze", Event::kFreezed);
                server.perform("Unfreeze", Event::kUnfreezed);
                server.perform("Unfreeze", Event::kUnfreezed);
              })),

    must("kinovazed.reply.not-recurring-idle",
         "Unfold and Unfreeze are Rejected in idle, also if they led there.",
         "server, recording repeat-unfreeze", Profiles::kFirmware,
         "kinovazed.reply.recurring-idle"),
    full(from(kFolded, Hazard::kMove, "A second Unfold and a second Unfreeze are Rejected.",
              [](ServerBench& server) {
                server.perform("Unfold", Event::kUnfolded);
                server.refuse("Unfold");
                server.perform("Freeze", Event::kFreezed);
                server.perform("Unfreeze", Event::kUnfreezed);
                server.refuse("Unfreeze");
              })),

    must("kinovazed.reply.recurring-mode", "The mode that is set already is confirmed at once.",
         "document, recurring commands; our reading", Profiles::kDocumented,
         "kinovazed.reply.not-recurring-mode"),
    from(kInMode, Hazard::kMove, "XYZ is confirmed within 0.4 s when it is set.",
         [](ServerBench& server) {
           expect_time(server, same_mode(server), 0ms, 400ms + server.noise());
         }),

    must("kinovazed.reply.not-recurring-mode",
         "The mode that is set already goes through the whole change again.",
         "server, recording repeat-mode", Profiles::kFirmware, "kinovazed.reply.recurring-mode"),
    from(kInMode, Hazard::kMove, "XYZ takes more than 0.5 s when it is set.",
         [](ServerBench& server) {
           expect_time(server, same_mode(server), 500ms, 1s + server.noise());
         }),

    must("kinovazed.reply.initialize-again",
         "Initialize in idle at the ready pose is over at once.",
         "server, recording repeat-initialize"),
    full(from(kReady, Hazard::kMove,
              "Initialized comes within half a second when the arm is ready.",
              [](ServerBench& server) {
                server.perform("Initialize", Event::kInitialized, 500ms + server.noise());
                server.expect_beat(21);
              })),

    must("kinovazed.time.answer", "A command is answered within half a second.",
         "server; reference 14.3: 110 ms at most on a real arm"),
    variant("stopped", look("Fifteen answers in emergencyStopped come within half a second.",
                            [](ServerBench& server) {
                              for (int i = 0; i < 5; ++i) {
                                expect_soon(server, "EStop", Event::kAccepted);
                                expect_soon(server, "Initialize", Event::kRejected);
                                expect_soon(server, "MoveJoystick:1:1:1", Event::kRejected);
                              }
                            })),
    variant("steering",
            from(kInMode, Hazard::kMove, "Three answers in steering come within half a second.",
                 [](ServerBench& server) {
                   expect_soon(server, "MoveJoystick:0:0:0", Event::kAccepted);
                   expect_soon(server, "Retract", Event::kRejected);
                   expect_soon(server, "EStop", Event::kAccepted);
                 })),

    unobservable(
        "how long that takes depends on the arm; the answer within half a second is checked",
        must("kinovazed.time.turn",
             "Every command, also a rejected one, waits for its turn with the arm.",
             "server; reference 6.3")),

    must("kinovazed.console.silent",
         "SetActiveObjective, GetObjectivePosition and GetAbsolutePosition are never answered.",
         "server, recording service-commands-silent"),
    look("Three console commands get no answer in emergencyStopped.", on<console>),
    variant("idle", from(kReady, Hazard::kMove, "Three console commands get no answer in idle.",
                         on<console>)),
    variant("retracted",
            full(from(kFolded, Hazard::kMove, "Three console commands get no answer in retracted.",
                      on<console>))),

    variant("fresh",
            from(kFresh, Hazard::kState, "Nor do two of them before an objective was chosen.",
                 [](ServerBench& server) {
                   server.ignored("GetObjectivePosition\r\n");
                   server.ignored("GetAbsolutePosition\r\n");
                   server.expect_silence();
                 })),

    must("kinovazed.console.harmless", "The three console commands change no state.",
         "server, recording service-commands-silent"),
    variant("stopped", look("Beat 3 follows.", on<console_harmless<State::kEmergencyStopped>>)),
    variant("steering", from(kInMode, Hazard::kMove, "Beat 69 follows.",
                             on<console_harmless<State::kSteering>>)),
    variant("frozen",
            from(kReady, Hazard::kMove, "Beat 13 follows.", on<console_harmless<State::kFrozen>>)),

    unobservable("the log is not on the wire",
                 must("kinovazed.console.log",
                      "Positions go to the server's log as one JSON object, metres and radians.",
                      "document")),
};

}  // namespace

Chapter reply_chapter() { return chapter("Replies and events", kReplyClauses); }

}  // namespace armjig::kinovazed::conformance
