// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using namespace std::string_view_literals;

using enum State;

/// EStop comes in any state, and what it ended is not told.
template <State state>
void estop(ServerBench& server) {
  enter(server, state);
  server.accept("EStop");
  server.expect_beat(3);
}

/// All of them, one after the other.
void refuse_all(ServerBench& server, std::span<const std::string_view> commands) {
  for (const auto command : commands) server.refuse(command);
}

constexpr std::array kAllButEStop{"QuitEStop"sv,
                                  "Initialize"sv,
                                  "Unfold"sv,
                                  "Retract"sv,
                                  "Freeze"sv,
                                  "Unfreeze"sv,
                                  "SetJoystickMode:Rotation"sv,
                                  "MoveJoystick:0:0:0"sv,
                                  "RunObjective:Home"sv};

/// The others of them, in their order.
template <class... LeftOut>
constexpr auto all_but(LeftOut... left_out) {
  std::array<std::string_view, kAllButEStop.size() - sizeof...(left_out)> others;
  std::ranges::copy_if(kAllButEStop, others.begin(),
                       [&](std::string_view one) { return ((one != left_out) && ...); });
  return others;
}

constexpr auto kAllButStops = all_but("QuitEStop"sv);

constexpr auto kAllButInitialize = all_but("QuitEStop"sv, "Initialize"sv);

constexpr std::array kNotInIdle{"Unfold"sv, "Unfreeze"sv, "MoveJoystick:0:0:0"sv, "QuitEStop"sv};

constexpr auto kNotInRetracted = all_but("Unfold"sv, "Retract"sv);

constexpr auto kNotInSettingMode = all_but("Retract"sv);

constexpr std::array kNotInSteering{"Initialize"sv, "Unfold"sv, "Retract"sv, "Unfreeze"sv,
                                    "QuitEStop"sv};

constexpr auto kNotInRunning = all_but("SetJoystickMode:Rotation"sv, "RunObjective:Home"sv);

constexpr auto kNotInFrozen = all_but("Freeze"sv, "Unfreeze"sv);

void quit_estop(ServerBench& server) {
  server.accept("QuitEStop");
  server.expect_beat(1);
}

template <State state, const auto& commands>
void refused(ServerBench& server) {
  enter(server, state);
  refuse_all(server, commands);
  server.expect_beat(beat_of(state).flags);
}

/// Of states that end by themselves. A mode takes half a second, in which a slow server has no time
/// for all of them; so the rest is for the next time.
template <State state, const auto& commands, Event event>
void refused_until(ServerBench& server) {
  constexpr Duration kTime = state == State::kSettingMode ? 250ms : Duration::max();
  for (std::span<const std::string_view> rest{commands}; !rest.empty() && !server.is_over();) {
    enter(server, state);
    const auto entered = server.now() - server.noise();
    do {
      server.refuse(rest.front());
      rest = rest.subspan(1);
    } while (!rest.empty() && !server.is_over() && server.now() - entered < kTime);
    server.about(std::string{to_string(event)} + " after refused commands");
    server.expect(event, ServerBench::kMotionTime);
    // A mode that is set already may be there at once.
    if (!rest.empty()) server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet);
  }
}

/// What is accepted after refused commands, and what becomes of it.
struct Next {
  std::string_view command;
  std::optional<Event> event;  ///< none: only the answer
  State state;
};
constexpr Next kQuit{"QuitEStop", {}, kPoweredOff};
constexpr Next kInitialized{"Initialize", Event::kInitialized, kIdle};
constexpr Next kFolding{"Retract", Event::kRetracted, kRetracted};
constexpr Next kUnfolded{"Unfold", Event::kUnfolded, kIdle};
constexpr Next kStanding{kStop, {}, kSteering};
constexpr Next kThawed{"Unfreeze", Event::kUnfreezed, kIdle};

void expect_only(ServerBench& server, const Next& next) {
  if (next.event) {
    server.perform(next.command, *next.event);
  } else {
    server.accept(next.command);
  }
  server.about(fmt::format("after refused commands and {}", next.command));
  server.expect_quiet(1500ms);
  server.expect_beat(beat_of(next.state).flags);
}

template <State state, const auto& commands, const Next& next>
void leaves_nothing(ServerBench& server) {
  enter(server, state);
  refuse_all(server, commands);
  if (state == kRetracting) server.expect(Event::kRetracted, ServerBench::kMotionTime);
  expect_only(server, next);
}

void expect_event_while_asked(ServerBench& server, std::string_view command, Event event) {
  server.accept(command);
  server.about(fmt::format("after {}, with refused commands all the time", command));
  server.refuse_until("QuitEStop", event);
}

/// The arm may be there already.
void initialize(ServerBench& server) {
  server.perform("Initialize", Event::kInitialized);
  server.expect_beat(21);
}

void freeze(ServerBench& server) {
  server.perform("Freeze", Event::kFreezed);
  server.expect_beat(13);
}

/// What takes its time: a beat on the way, and the event behind it.
void on_the_way(ServerBench& server, std::string_view command, int flags, Event event) {
  server.wait_until_before_beat(kBeforeBeat);
  server.accept(command);
  server.expect_beat(flags);
  server.expect(event, ServerBench::kMotionTime);
}

void objective(ServerBench& server) {
  on_the_way(server, kFarObjective, 37, Event::kObjectiveDone);
}

void mode(ServerBench& server) {
  on_the_way(server, "SetJoystickMode:Rotation", 5, Event::kJoystickModeSet);
}

/// How long a command takes until its event.
Duration time_until(ServerBench& server, std::string_view command, Event event) {
  const auto said = server.now();
  return server.perform(command, event).time - said;
}

/// An arm that is not folded is unfolded sooner.
void expect_folded_from_afar(ServerBench& server) {
  server.perform("Retract", Event::kRetracted);
  const auto usual = time_until(server, "Unfold", Event::kUnfolded);
  server.perform(kFarObjective, Event::kObjectiveDone);
  server.perform("Retract", Event::kRetracted);
  const auto after = time_until(server, "Unfold", Event::kUnfolded);
  server.about("Unfold after Retract from where an objective ends");
  expect_time(server, after, usual - 300ms - server.noise(), ServerBench::kMotionTime);
}

/// Away from its ready pose the arm has a way to go, however it was led away.
void expect_initialized_from_afar(ServerBench& server) {
  const auto usual = time_until(server, "Initialize", Event::kInitialized);
  for (const auto* const mode : {"XYZ", "Axis1to3", "Axis4to6"}) {
    server.perform(std::string{"SetJoystickMode:"} + mode, Event::kJoystickModeSet);
    server.accept("MoveJoystick:0:0:400");
    server.pause(1s);
    server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet);
    const auto after = time_until(server, "Initialize", Event::kInitialized);
    server.about(fmt::format("Initialize after a second of steering in {}", mode));
    expect_time(server, after, usual + 200ms, ServerBench::kMotionTime);
  }
}

/// The way to Home from where a mode ended an objective, some time after Freeze and Unfreeze.
Duration way_from_unfinished(ServerBench& server, Duration after) {
  (void)time_of(server, "Home");
  server.accept("RunObjective:Antenna");
  server.pause(1s);
  server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
  server.perform("Freeze", Event::kFreezed);
  server.perform("Unfreeze", Event::kUnfreezed);
  server.pause(after);
  return time_of(server, "Home");
}

void expect_standing_after_unfreeze(ServerBench& server) {
  const auto usual = way_from_unfinished(server, 0ms);
  const auto after = way_from_unfinished(server, 3s);
  const auto tolerance = 400ms + 2 * server.noise();
  server.about("the way back from an objective that was ended, 3 s after Unfreeze");
  expect_time(server, after, usual - tolerance, usual + tolerance);
}

/// How long Retract takes after Freeze and Unfreeze of an arm that was stopped while it was
/// steered.
Duration retracting_after_steering(ServerBench& server, std::string_view move) {
  server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
  server.accept(move);
  server.pause(500ms);
  server.accept("EStop");
  server.accept("QuitEStop");
  server.perform("Initialize", Event::kInitialized);
  server.perform("Freeze", Event::kFreezed);
  server.perform("Unfreeze", Event::kUnfreezed);
  return time_until(server, "Retract", Event::kRetracted);
}

/// The arm is as ready as ever, and folds as fast.
void expect_nothing_steered_after_freeze(ServerBench& server) {
  const auto usual = retracting_after_steering(server, kStop);
  server.perform("Unfold", Event::kUnfolded);
  const auto after = retracting_after_steering(server, "MoveJoystick:0:0:30");
  const auto tolerance = 400ms + 2 * server.noise();
  server.about("Retract after Freeze and Unfreeze, after an EStop in steering");
  expect_time(server, after, usual - tolerance, usual + tolerance);
}

constexpr Clause kStateClauses[] = {
    must("kinovazed.state.start", "A server that was just started is in emergencyStopped.",
         "server; reference 6.1"),
    from(kFresh, Hazard::kObserve, "The first beat of a fresh server says emergencyStopped.",
         [](ServerBench& server) { server.expect_beat(3); }),

    must("kinovazed.state.table",
         "Commands act by the state alone, whatever their arguments: every mode and every "
         "objective is refused where one is.",
         "server; reference 6.2"),
    in(kEmergencyStopped, "All modes and objectives are Rejected in emergencyStopped.",
       [](ServerBench& server) {
         for (const auto mode : kModeNames) server.refuse("SetJoystickMode:" + std::string{mode});
         for (const auto objective : kObjectiveNames) {
           server.refuse("RunObjective:" + std::string{objective});
         }
         server.expect_beat(3);
       }),

    must("kinovazed.state.refused-leaves-nothing",
         "What was refused is not made up for with a command that is accepted later.",
         "server; reference 6.2"),
    variant("stopped", in(kEmergencyStopped, "Seven commands, then QuitEStop.",
                          on<leaves_nothing<kEmergencyStopped, kAllButStops, kQuit>>)),
    variant("off", in(kPoweredOff, "Seven, then Initialize.",
                      on<leaves_nothing<kPoweredOff, kAllButInitialize, kInitialized>>)),
    variant("idle",
            in(kIdle, "Four, then Retract.", on<leaves_nothing<kIdle, kNotInIdle, kFolding>>)),
    variant("retracting", in(kRetracting, "Nine on the way, then Unfold.",
                             on<leaves_nothing<kRetracting, kAllButEStop, kUnfolded>>)),
    variant("retracted", in(kRetracted, "Seven, then Unfold.",
                            on<leaves_nothing<kRetracted, kNotInRetracted, kUnfolded>>)),
    variant("steering", in(kSteering, "Five, then MoveJoystick.",
                           on<leaves_nothing<kSteering, kNotInSteering, kStanding>>)),
    variant("frozen", in(kFrozen, "Seven, then Unfreeze.",
                         on<leaves_nothing<kFrozen, kNotInFrozen, kThawed>>)),

    must("kinovazed.state.event-while-asked",
         "The event of a command comes, however often its client asks for something meanwhile.",
         "server; reference 6.3"),
    variant("retracted", in(kIdle, "Retract.",
                            [](ServerBench& server) {
                              expect_event_while_asked(server, "Retract", Event::kRetracted);
                            })),
    variant("unfolded", in(kRetracted, "Unfold.",
                           [](ServerBench& server) {
                             expect_event_while_asked(server, "Unfold", Event::kUnfolded);
                           })),
    variant("mode", in(kIdle, "A mode.",
                       [](ServerBench& server) {
                         expect_event_while_asked(server, "SetJoystickMode:XYZ",
                                                  Event::kJoystickModeSet);
                       })),
    variant("objective", in(kIdle, "An objective.",
                            [](ServerBench& server) {
                              expect_event_while_asked(server, kFarObjective,
                                                       Event::kObjectiveDone);
                            })),

    must("kinovazed.state.stopped.estop", "In emergencyStopped EStop stays there.",
         "server, state-command-matrix"),
    // First, for without EStop no other case can begin.
    in(kEmergencyStopped, "Accepted, and beat 3.",
       [](ServerBench& server) {
         server.accept("EStop");
         server.expect_beat(3);
       }),

    must("kinovazed.state.stopped.quit-estop", "In emergencyStopped QuitEStop leads to poweredOff.",
         "server, state-command-matrix"),
    from(kStopped, Hazard::kState, "Accepted, and beat 1.", on<quit_estop>),

    must("kinovazed.state.stopped.refused",
         "In emergencyStopped all commands but EStop and QuitEStop are Rejected and change "
         "nothing.",
         "server, state-command-matrix"),
    in(kEmergencyStopped, "Eight commands, and beat 3.",
       on<refused<kEmergencyStopped, kAllButStops>>),

    must("kinovazed.state.off.estop", "In poweredOff EStop leads to emergencyStopped.",
         "server, state-command-matrix"),
    in(kPoweredOff, "Accepted, and beat 3.", on<estop<kPoweredOff>>),

    must("kinovazed.state.off.quit-estop", "In poweredOff QuitEStop stays there.",
         "server, state-command-matrix"),
    in(kPoweredOff, "Accepted, and beat 1.", on<quit_estop>),

    must("kinovazed.state.off.initialize",
         "In poweredOff Initialize leads by way of initializing to idle.",
         "server, state-command-matrix"),
    from(kOff, Hazard::kMove, "Initialized, and beat 21.", on<initialize>),

    must("kinovazed.state.off.refused",
         "In poweredOff all commands but EStop, QuitEStop and Initialize are Rejected and "
         "change nothing.",
         "server, state-command-matrix"),
    in(kPoweredOff, "Seven commands, and beat 1.", on<refused<kPoweredOff, kAllButInitialize>>),

    must("kinovazed.state.initializing.estop", "In initializing EStop leads to emergencyStopped.",
         "server, state-command-matrix"),
    in(kInitializing, "Accepted, and beat 3.", on<estop<kInitializing>>),

    must("kinovazed.state.initializing.refused",
         "In initializing all commands but EStop are Rejected, and Initialized still comes.",
         "server, state-command-matrix"),
    quick(in(kInitializing, "Nine commands, then Initialized.",
             on<refused_until<kInitializing, kAllButEStop, Event::kInitialized>>)),

    must("kinovazed.state.idle.estop", "In idle EStop leads to emergencyStopped.",
         "server, state-command-matrix"),
    quick(in(kIdle, "Accepted, and beat 3.", on<estop<kIdle>>)),

    must("kinovazed.state.idle.initialize",
         "In idle Initialize leads by way of initializing back to idle.",
         "server, state-command-matrix"),
    in(kIdle, "Initialized, and beat 21.", on<initialize>),

    must("kinovazed.state.idle.initialize-moves",
         "In idle Initialize leads an arm that was steered away back to its ready pose first.",
         "server, homing", Profiles::kFirmware),
    in(kIdle, "It takes longer after a second of each of three modes.",
       on<expect_initialized_from_afar>),

    must("kinovazed.state.idle.retract", "In idle Retract leads to retracting.",
         "server, state-command-matrix"),
    in(kIdle, "Beat 5, then Retracted.",
       [](ServerBench& server) { on_the_way(server, "Retract", 5, Event::kRetracted); }),
    variant("from-afar",
            in(kIdle, "After an objective the arm is as folded as from the ready pose.",
               on<expect_folded_from_afar>)),

    must("kinovazed.state.idle.freeze", "In idle Freeze leads to frozen.",
         "server, state-command-matrix"),
    quick(in(kIdle, "Freezed, and beat 13.", on<freeze>)),

    must("kinovazed.state.idle.mode", "In idle SetJoystickMode leads to settingMode.",
         "server, state-command-matrix"),
    quick(in(kIdle, "Beat 5, then JoystickModeSet.", on<mode>)),

    must("kinovazed.state.idle.objective", "In idle RunObjective leads to runningSequence.",
         "server, state-command-matrix"),
    in(kIdle, "Beat 37, then ObjectiveDone.", on<objective>),

    must("kinovazed.state.idle.refused",
         "In idle Unfold, Unfreeze, MoveJoystick and QuitEStop are Rejected and change "
         "nothing.",
         "server, state-command-matrix"),
    quick(in(kIdle, "Four commands, and beat 21.", on<refused<kIdle, kNotInIdle>>)),

    must("kinovazed.state.retracting.estop", "In retracting EStop leads to emergencyStopped.",
         "server, state-command-matrix"),
    in(kRetracting, "Accepted, and beat 3.", on<estop<kRetracting>>),

    must("kinovazed.state.retracting.refused",
         "In retracting all commands but EStop are Rejected, and Retracted still comes.",
         "server, state-command-matrix"),
    quick(in(kRetracting, "Nine commands, then Retracted.",
             on<refused_until<kRetracting, kAllButEStop, Event::kRetracted>>)),

    must("kinovazed.state.retracted.estop", "In retracted EStop leads to emergencyStopped.",
         "server, state-command-matrix"),
    in(kRetracted, "Accepted, and beat 3.", on<estop<kRetracted>>),

    must("kinovazed.state.retracted.unfold", "In retracted Unfold leads to unfolding.",
         "server, state-command-matrix"),
    quick(in(kRetracted, "Beat 5, then Unfolded.",
             [](ServerBench& server) { on_the_way(server, "Unfold", 5, Event::kUnfolded); })),

    must("kinovazed.state.retracted.refused",
         "In retracted all commands but EStop, Unfold and Retract are Rejected and change "
         "nothing.",
         "server, state-command-matrix"),
    quick(
        in(kRetracted, "Seven commands, and beat 133.", on<refused<kRetracted, kNotInRetracted>>)),

    must("kinovazed.state.unfolding.estop", "In unfolding EStop leads to emergencyStopped.",
         "server, state-command-matrix"),
    in(kUnfolding, "Accepted, and beat 3.", on<estop<kUnfolding>>),

    must("kinovazed.state.unfolding.refused",
         "In unfolding all commands but EStop are Rejected, and Unfolded still comes.",
         "server, state-command-matrix"),
    quick(in(kUnfolding, "Nine commands, then Unfolded.",
             on<refused_until<kUnfolding, kAllButEStop, Event::kUnfolded>>)),

    must("kinovazed.state.setting-mode.estop", "In settingMode EStop leads to emergencyStopped.",
         "server, state-command-matrix"),
    in(kSettingMode, "Accepted, and beat 3.", on<estop<kSettingMode>>),

    must("kinovazed.state.setting-mode.retract", "In settingMode Retract leads to retracting.",
         "server, state-command-matrix"),
    in(kSettingMode, "Beat 5, then Retracted.",
       [](ServerBench& server) {
         server.accept("SetJoystickMode:XYZ");
         server.accept("Retract");
         server.expect_beat(5);
         server.expect(Event::kRetracted, ServerBench::kMotionTime);
       }),

    must("kinovazed.state.setting-mode.refused",
         "In settingMode all commands but EStop and Retract are Rejected, and JoystickModeSet "
         "still comes.",
         "server, state-command-matrix"),
    quick(in(kSettingMode, "Eight commands, then JoystickModeSet.",
             on<refused_until<kSettingMode, kNotInSettingMode, Event::kJoystickModeSet>>)),

    must("kinovazed.state.steering.estop", "In steering EStop leads to emergencyStopped.",
         "server, state-command-matrix"),
    quick(in(kSteering, "Accepted, and beat 3.", on<estop<kSteering>>)),

    must("kinovazed.state.steering.freeze", "In steering Freeze leads to frozen.",
         "server, state-command-matrix"),
    quick(in(kSteering, "Freezed, and beat 13.", on<freeze>)),

    must("kinovazed.state.steering.mode", "In steering SetJoystickMode leads to settingMode.",
         "server, state-command-matrix"),
    quick(in(kSteering, "Beat 5, then JoystickModeSet.", on<mode>)),

    must("kinovazed.state.steering.move", "In steering MoveJoystick stays there.",
         "server, state-command-matrix"),
    quick(in(kSteering, "Three moves are Accepted, and beat 69.",
             [](ServerBench& server) {
               for (const auto* move :
                    {"MoveJoystick:4:0:0", "MoveJoystick:0:-4:4", "MoveJoystick:0:0:0"}) {
                 server.accept(move);
               }
               server.expect_beat(69);
             })),

    must("kinovazed.state.steering.objective", "In steering RunObjective leads to runningSequence.",
         "server, state-command-matrix"),
    in(kSteering, "Beat 37, then ObjectiveDone.", on<objective>),

    must("kinovazed.state.steering.refused",
         "In steering Initialize, Unfold, Retract, Unfreeze and QuitEStop are Rejected and "
         "change nothing.",
         "server, state-command-matrix"),
    quick(in(kSteering, "Five commands, and beat 69.", on<refused<kSteering, kNotInSteering>>)),

    must("kinovazed.state.running.estop", "In runningSequence EStop leads to emergencyStopped.",
         "server, state-command-matrix"),
    quick(in(kRunningSequence, "Accepted, and beat 3.", on<estop<kRunningSequence>>)),

    variant("and-more",
            quick(in(kRunningSequence, "What is after it in a segment is answered, too.",
                     [](ServerBench& server) {
                       enter(server, kRunningSequence);
                       server.send("EStop\r\nQuitEStop\r\nEStop\r\n");
                       for (int i = 0; i < 3; ++i) server.expect(Event::kAccepted);
                       server.expect_beat(3);
                     }))),

    must("kinovazed.state.running.mode", "In runningSequence SetJoystickMode leads to settingMode.",
         "server, state-command-matrix"),
    in(kRunningSequence, "Beat 5, then JoystickModeSet.",
       [](ServerBench& server) {
         // The beat has to come when both are accepted; how long that takes shows the first time.
         Duration lead = kBeforeBeat + 60ms;
         const auto set_mode = [&] {
           server.wait_until_before_beat(lead);
           const auto begin = server.now();
           server.accept(kFarObjective);
           server.accept("SetJoystickMode:Rotation");
           return server.now() - begin;
         };
         const auto taken = set_mode();
         if (taken > 250ms + server.link_noise()) {
           server.expect(Event::kJoystickModeSet);
           server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet);
           lead = taken + 250ms;
           (void)set_mode();
         }
         server.expect_beat(5);
         server.expect(Event::kJoystickModeSet);
       }),

    must("kinovazed.state.running.objective", "In runningSequence RunObjective stays there.",
         "server, state-command-matrix"),
    in(kRunningSequence, "Beat 37, then ObjectiveDone.",
       [](ServerBench& server) {
         server.wait_until_before_beat(2 * kBeforeBeat);
         server.accept("RunObjective:Home");
         server.accept(kFarObjective);
         server.expect_beat(37);
         server.expect(Event::kObjectiveDone, ServerBench::kMotionTime);
       }),

    must("kinovazed.state.running.refused",
         "In runningSequence all commands but EStop, SetJoystickMode and RunObjective are "
         "Rejected, and ObjectiveDone still comes.",
         "server, state-command-matrix"),
    quick(in(kRunningSequence, "Seven commands, then ObjectiveDone.",
             on<refused_until<kRunningSequence, kNotInRunning, Event::kObjectiveDone>>)),

    must("kinovazed.state.frozen.estop", "In frozen EStop leads to emergencyStopped.",
         "server, state-command-matrix"),
    quick(in(kFrozen, "Accepted, and beat 3.", on<estop<kFrozen>>)),

    must("kinovazed.state.frozen.unfreeze", "In frozen Unfreeze leads to idle.",
         "server, state-command-matrix"),
    quick(in(kFrozen, "Unfreezed, and beat 21.",
             [](ServerBench& server) {
               enter(server, kFrozen);
               server.perform("Unfreeze", Event::kUnfreezed);
               server.expect_beat(21);
             })),
    variant("stands", in(kIdle, "An objective that was ended is not gone on with.",
                         on<expect_standing_after_unfreeze>)),
    variant("after-steering", in(kIdle, "Nor does what was steered before an EStop lead on.",
                                 on<expect_nothing_steered_after_freeze>)),

    must("kinovazed.state.frozen.refused",
         "In frozen all commands but EStop, Unfreeze and Freeze are Rejected and change "
         "nothing.",
         "server, state-command-matrix"),
    quick(in(kFrozen, "Seven commands, and beat 13.", on<refused<kFrozen, kNotInFrozen>>)),
};

}  // namespace

Chapter state_chapter() { return chapter("States", kStateClauses); }

}  // namespace armjig::kinovazed::conformance
