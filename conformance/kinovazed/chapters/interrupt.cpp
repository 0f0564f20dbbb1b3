// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum State;

/// Longer than what was interrupted would have taken with any arm.
constexpr Duration kLater = 6s;

template <State state>
void estop_quietly(ServerBench& server) {
  enter(server, state);
  server.accept("EStop");
  server.expect_quiet(kLater);
  server.expect_beat(3);
}

/// The server has to see that the mode was another one before.
void fold_while_initializing(ServerBench& server) {
  enter(server, kInitializing);
  server.pause(500ms);
  server.touch("arm.mode", 3);
}

constexpr std::string_view kFar = std::string_view{kFarObjective}.substr(13);

Duration time_of_initializing(ServerBench& server) {
  switch_off(server);
  const auto said = server.now();
  return server.perform("Initialize", Event::kInitialized).time - said;
}

/// How long Initialize takes after an EStop early on the way.
Duration time_after_early_stop(ServerBench& server, std::string_view command) {
  server.accept(command);
  server.pause(600ms);
  switch_off(server);
  server.pause(kLater);
  server.about("Initialize after EStop early on the way");
  return time_of_initializing(server);
}

/// Ended early on its way to the ready pose, an arm is not there later, so that Initialize takes
/// time.
void expect_not_ready(ServerBench& server, std::string_view command) {
  expect_time(server, time_after_early_stop(server, command), 700ms, ServerBench::kMotionTime);
}

/// On a way that takes longer than what comes.
void set_out(ServerBench& server) {
  server.accept(kFarObjective);
  server.pause(300ms);
}

/// The way to Home tells where the arm is.
void expect_ready_after_steering(ServerBench& server) {
  const auto usual = time_of(server, "Home");
  initialize_afresh(server);
  server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
  server.accept("MoveJoystick:0:0:400");
  server.pause(3s);
  server.accept("MoveJoystick:0:0:0");
  server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet);
  server.perform("Initialize", Event::kInitialized);
  const auto tolerance = 300ms + server.noise();
  const auto after = time_of(server, "Home");
  server.about("the way to Home after steering and Initialize");
  expect_time(server, after, usual - tolerance, usual + tolerance);
}

constexpr Clause kInterruptClauses[] = {
    must("kinovazed.event.table",
         "The arm's own ends act where they are awaited: folding ends in retracted, unfolding "
         "and initializing in idle.",
         "server; reference 6.4"),
    in(kIdle, "Folding, unfolding, folding, initializing.",
       [](ServerBench& server) {
         server.perform("Retract", Event::kRetracted);
         server.expect_beat(133);
         server.perform("Unfold", Event::kUnfolded);
         server.expect_beat(21);
         server.perform("Retract", Event::kRetracted);
         initialize_afresh(server);
         server.expect_beat(21);
       }),

    must("kinovazed.interrupt.retract",
         "Retract ends a change of mode, whose JoystickModeSet never comes.",
         "server; reference 6.5"),
    in(kIdle, "Retracted comes, and nothing else.",
       [](ServerBench& server) {
         server.accept("SetJoystickMode:XYZ");
         server.accept("Retract");
         server.about("Retract during a change of mode");
         server.expect(Event::kRetracted, ServerBench::kMotionTime);
         server.expect_quiet(1s);
         server.expect_beat(133);
       }),

    must("kinovazed.interrupt.mode",
         "SetJoystickMode ends a running objective, whose ObjectiveDone never comes.",
         "document; server, recording interrupt-objective-by-mode"),
    in(kIdle, "JoystickModeSet comes, and nothing for 6 s.",
       [](ServerBench& server) {
         set_out(server);
         server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
         server.expect_quiet(kLater);
         server.expect_beat(69);
       }),

    must("kinovazed.interrupt.objective",
         "RunObjective replaces the objective that runs, and only the second one is done.",
         "server, recording interrupt-objective-by-objective"),
    in(kIdle, "ObjectiveDone comes, and nothing for 6 s.",
       [](ServerBench& server) {
         set_out(server);
         server.perform("RunObjective:Home", Event::kObjectiveDone);
         server.expect_quiet(kLater);
       }),

    must("kinovazed.interrupt.estop-initializing",
         "EStop ends initializing, and Initialized never comes.",
         "document; server, transcript T12"),
    in(kInitializing, "Nothing for 6 s, and beat 3.", on<estop_quietly<kInitializing>>),

    must("kinovazed.interrupt.estop-retracting",
         "EStop ends retracting, and Retracted never comes.", "document; server, transcript T53"),
    in(kRetracting, "Nothing for 6 s, and beat 3.", on<estop_quietly<kRetracting>>),

    must("kinovazed.interrupt.estop-unfolding", "EStop ends unfolding, and Unfolded never comes.",
         "document; server; reference 6.5"),
    in(kUnfolding, "Nothing for 6 s, and beat 3.", on<estop_quietly<kUnfolding>>),

    must("kinovazed.interrupt.estop-setting-mode",
         "EStop ends a change of mode, and JoystickModeSet never comes.",
         "document; server, recording interrupt-setting-mode-by-estop"),
    in(kSettingMode, "Nothing for 6 s, and beat 3.", on<estop_quietly<kSettingMode>>),

    must("kinovazed.interrupt.estop-objective",
         "EStop ends an objective, and ObjectiveDone never comes.",
         "document; server, recording interrupt-objective-by-estop"),
    in(kRunningSequence, "Nothing for 6 s, and beat 3.", on<estop_quietly<kRunningSequence>>),

    must("kinovazed.interrupt.late-mode",
         "The end of a change of mode that EStop ended is not told after the next Initialize "
         "either.",
         "server; reference 8.3"),
    in(kIdle, "Nothing for 1 s after Initialized.",
       [](ServerBench& server) {
         server.accept("SetJoystickMode:XYZ");
         initialize_afresh(server);
         server.expect_quiet(1s);
         server.expect_beat(21);
       }),

    must("kinovazed.interrupt.half-way",
         "After EStop on the way to the folded pose Initialize leads to ready.",
         "server, recording session-estop-mid-retract"),
    in(kIdle, "Initialized comes, and beat 21.",
       [](ServerBench& server) {
         server.accept("Retract");
         server.pause(800ms);
         initialize_afresh(server);
         server.expect_beat(21);
       }),

    must("kinovazed.interrupt.mode-stops",
         "SetJoystickMode stops the arm on its way to an objective.",
         "document; server; reference 6.6"),
    in(kIdle, "Stopped in the first quarter of the way, it is not at its end later.",
       [](ServerBench& server) {
         (void)time_of(server, "Home");
         const auto whole = time_of(server, kFar);
         (void)time_of(server, "Home");
         server.accept(kFarObjective);
         server.pause(whole / 4);
         server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
         server.pause(whole);
         server.about("the way back from a quarter of the way");
         expect_time(server, time_of(server, "Home"), 0ms, whole * 6 / 10 + server.noise());
       }),

    must("kinovazed.interrupt.estop-stops",
         "EStop stops the arm: it is neither folded nor ready later if it was on its way.",
         "document; server; recording session-estop-mid-retract"),
    variant("retracting", in(kIdle, "Early on the way to the folded pose: the way back is short.",
                             [](ServerBench& server) {
                               server.perform("Retract", Event::kRetracted);
                               const auto whole = time_of_initializing(server);
                               expect_time(server, time_after_early_stop(server, "Retract"), 0ms,
                                           whole * 3 / 4 + server.noise());
                             })),
    variant("unfolding", in(kUnfolding, "Early on the way to the ready pose: it is not there.",
                            [](ServerBench& server) { expect_not_ready(server, "Unfold"); })),
    variant("initializing",
            in(kInitializing, "Early on the way to the ready pose: it is not there.",
               [](ServerBench& server) {
                 switch_off(server);
                 expect_not_ready(server, "Initialize");
               })),

    must("kinovazed.retract.from-anywhere",
         "Retract with the arm elsewhere goes by way of the ready pose, and Retracted comes "
         "once.",
         "server, transcript S16"),
    in(kIdle, "From Home, Retracted comes once.",
       [](ServerBench& server) {
         server.perform("RunObjective:Home", Event::kObjectiveDone);
         server.perform("Retract", Event::kRetracted);
         server.expect_quiet(kLater);
         server.expect_beat(133);
       }),

    must("kinovazed.retract.while-initializing",
         "If the arm ends folded while it initializes, Retracted is sent and the server stays "
         "initializing.",
         "server, transcript S15", Profiles::kFirmware, "kinovazed.retract.goes-on"),
    in(kInitializing, "Retracted, then beat 1.",
       [](ServerBench& server) {
         fold_while_initializing(server);
         server.expect(Event::kRetracted);
         server.refuse("Unfold");
         server.expect_beat(1);
       }),

    must("kinovazed.retract.goes-on",
         "An arm that ends folded while it initializes goes on to its ready pose.",
         "document: Retracted is the answer to Retract; our choice", Profiles::kDocumented,
         "kinovazed.retract.while-initializing"),
    in(kInitializing, "Initialized comes all the same.",
       [](ServerBench& server) {
         fold_while_initializing(server);
         server.expect(Event::kInitialized, ServerBench::kMotionTime);
       }),

    must("kinovazed.initialize.again",
         "Initialize in idle moves an arm that is elsewhere to its ready pose, and the server "
         "is initialized on the way.",
         "server; reference 6.6", Profiles::kFirmware, "kinovazed.initialize.recurring"),
    in(kIdle, "From Home, beat 5, then Initialized.",
       [](ServerBench& server) {
         initialize_at_home(server);
         server.expect(Event::kInitialized, ServerBench::kMotionTime);
         server.expect_beat(21);
       }),
    variant("steered", in(kIdle, "After steering the arm is at its ready pose then.",
                          on<expect_ready_after_steering>)),

    must("kinovazed.initialize.recurring",
         "Initialize in idle is confirmed at once, wherever the arm is.",
         "document, recurring commands; our reading", Profiles::kDocumented,
         "kinovazed.initialize.again"),
    in(kIdle, "From Home, Initialized within half a second.",
       [](ServerBench& server) {
         server.perform("RunObjective:Home", Event::kObjectiveDone);
         server.perform("Initialize", Event::kInitialized, 500ms + server.noise());
       }),
};

}  // namespace

Chapter interrupt_chapter() { return chapter("Interrupts and ends", kInterruptClauses); }

}  // namespace armjig::kinovazed::conformance
