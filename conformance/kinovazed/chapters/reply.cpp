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

/// From a command to its answer, which is the first word behind it.
Duration answer_time(ServerBench& server, std::string_view command, Event answer) {
  server.about(std::string{command});
  const auto said = server.now();
  server.say(command);
  return server.expect(answer).time - said;
}

void expect_soon(ServerBench& server, std::string_view command, Event answer) {
  const auto taken = answer_time(server, command, answer);
  expect_time(server, taken, 0ms, ServerBench::kAnswerTime + server.link_noise());
}

/// A command that stops the arm first, and the pauses of 10 ms that the server makes until then.
struct Stop {
  State from;
  std::string_view command;
  int pauses;
};
constexpr std::array kEStops{
    Stop{State::kPoweredOff, "EStop", 3},      Stop{State::kIdle, "EStop", 3},
    Stop{State::kRetracting, "EStop", 3},      Stop{State::kRetracted, "EStop", 3},
    Stop{State::kSettingMode, "EStop", 3},     Stop{State::kSteering, "EStop", 3},
    Stop{State::kRunningSequence, "EStop", 3}, Stop{State::kFrozen, "EStop", 3}};
constexpr std::array kOtherStops{Stop{State::kIdle, "Freeze", 3},
                                 Stop{State::kSteering, "Freeze", 3},
                                 Stop{State::kIdle, kFarObjective, 3},
                                 Stop{State::kSteering, kFarObjective, 3},
                                 Stop{State::kRunningSequence, "RunObjective:Home", 3},
                                 Stop{State::kIdle, "SetJoystickMode:XYZ", 4},
                                 Stop{State::kSteering, "SetJoystickMode:Rotation", 4},
                                 Stop{State::kRunningSequence, "SetJoystickMode:Axis1to3", 4}};

/// From idle, and not any further than that.
void go_to_state(ServerBench& server, State state) {
  switch (state) {
    case State::kPoweredOff:
      return switch_off(server);
    case State::kRetracting:
      return server.accept("Retract");
    case State::kRetracted:
      return (void)server.perform("Retract", Event::kRetracted);
    case State::kSettingMode:
      return server.accept("SetJoystickMode:XYZ");
    case State::kSteering:
      return (void)server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
    case State::kRunningSequence:
      return server.accept(kFarObjective);
    case State::kFrozen:
      return (void)server.perform("Freeze", Event::kFreezed);
    default:
      return;
  }
}

/// An answer that comes sooner cannot have waited for all of the calls. A server's clock may be
/// one in a hundred fast.
template <const auto& stops>
void expect_pauses(ServerBench& server) {
  constexpr auto kPause = 9900us;
  for (const Stop& stop : stops) {
    if (server.is_over()) return;
    server.pause(kModePause + 100ms);  // two modes may be no nearer to each other
    start_again(server);
    go_to_state(server, stop.from);
    const auto taken = answer_time(server, stop.command, Event::kAccepted);
    const auto least = stop.pauses * kPause;
    server.about(fmt::format("{} in {}, until it is answered", stop.command, to_string(stop.from)));
    server.expect_true(taken >= least, fmt::format("{:.1f} ms or more", milliseconds(least)),
                       fmt::format("{:.1f} ms", milliseconds(taken)));
  }
}

/// How long a call to the arm takes: of a stop the shortest that is seen, without its pauses. Where
/// a look at the arm takes most of the time, the stop may have waited for one or two each time.
Duration call_time(ServerBench& server) {
  constexpr int kStops = 6;
  constexpr int kCalls = 3;
  auto shortest = Duration::max();
  for (int i = 0; i < kStops; ++i) {
    const auto said = server.now();
    shortest = std::min(shortest, server.perform("Freeze", Event::kFreezed).time - said);
    server.perform("Unfreeze", Event::kUnfreezed);
  }
  return (shortest - kCalls * 10ms) / kCalls;
}

/// A look at the arm is four calls and more, one in 10 ms, so that some of many commands meet one.
void expect_turns(ServerBench& server) {
  constexpr int kCommands = 100;
  constexpr auto kBetween = 3700us;
  const auto call = call_time(server);
  if (call <= 5 * server.link_noise()) {
    return server.skip("calls to the arm that take longer than this link lets tell");
  }
  Duration longest{};
  for (int i = 0; i < kCommands && !server.is_over(); ++i) {
    longest = std::max(longest, answer_time(server, "QuitEStop", Event::kRejected));
    server.pause(kBetween);
  }
  server.about("the longest that a refused command waits");
  expect_time(server, longest, call / 2, ServerBench::kAnswerTime + server.link_noise());
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

    must("kinovazed.time.stop",
         "A stop is three calls to the arm with a pause of 10 ms after each, a change of modes has "
         "a "
         "fourth pause, and all of it comes before the answer.",
         "server; reference 6.3", Profiles::kFirmware),
    variant("estop", quick(in(State::kIdle, "EStop in eight states takes 30 ms or more.",
                              on<expect_pauses<kEStops>>))),
    variant("others", in(State::kIdle,
                         "Freeze and RunObjective take 30 ms or more, and SetJoystickMode 40 ms.",
                         on<expect_pauses<kOtherStops>>)),

    must("kinovazed.time.turn",
         "Every command, also a rejected one, waits for its turn with the arm.",
         "server; reference 6.3"),
    in(State::kIdle, "Of a hundred refused commands some wait for a call to the arm.",
       on<expect_turns>),

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
