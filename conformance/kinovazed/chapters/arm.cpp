// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"
#include "conformance/kinovazed/fixture.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using namespace std::string_view_literals;
using enum State;

/// A mode that cannot be read, once: the server notices at its next look.
template <State state>
void silent_stop(ServerBench& server) {
  enter(server, state);
  server.touch("arm.fail.status_read", 1);
  server.expect_quiet(300ms + 3 * server.noise());
  server.expect_beat(3);
  server.expect_quiet(2s);
}

/// Of a command whose event does not come, for `call` fails.
void expect_stop(ServerBench& server, std::string_view call, std::string_view command) {
  server.touch(call, 1);
  server.accept(command);
  server.expect_quiet(6s);
  server.expect_beat(3);
}

/// A command, the calls that it makes, and the beat that shows where it leads if all work.
struct Calls {
  std::string_view command;
  std::array<std::string_view, 4> made;
  int beat;
  Duration takes;
};
constexpr Duration kModeTime = 700ms;
constexpr Calls stopping_and(std::string_view command, std::string_view call, int beat,
                             Duration takes = {}) {
  return {command, {kStopping[0], kStopping[1], kStopping[2], call}, beat, takes};
}
constexpr std::array kCallsInIdle{
    stopping_and("Freeze", "", 13),
    stopping_and("RunObjective:SuckDoor", "target_write", 37),
    stopping_and("SetJoystickMode:XYZ", "cartesian_mode_select", 69, kModeTime),
    stopping_and("SetJoystickMode:Rotation", "cartesian_mode_select", 69, kModeTime),
    stopping_and("SetJoystickMode:Axis1to3", "angular_mode_select", 69, kModeTime),
    stopping_and("SetJoystickMode:Axis4to6", "angular_mode_select", 69, kModeTime),
    stopping_and("SetJoystickMode:NoMode", "cartesian_mode_select", 21),
    Calls{"Retract", {"home_button_press"}, 5, {}}};
constexpr std::array kCallsInSteering{Calls{"MoveJoystick:0:0:0", {"joystick_axes_write"}, 69, {}},
                                      stopping_and("Freeze", "", 13),
                                      stopping_and("RunObjective:SuckDoor", "target_write", 37)};

/// Whether a failure hangs or ends a shipped server; that has requirements of its own.
bool is_fatal(std::string_view call) { return call.ends_with("_mode_select"); }

/// EStop and QuitEStop, while each of the calls fails once.
void estop_while_failing(ServerBench& server, std::initializer_list<std::string_view> calls) {
  for (const auto call : calls) server.touch(fmt::format("arm.fail.{}", call), 1);
  server.accept("EStop");
  server.pause(300ms + 6 * server.noise());
  server.about(fmt::format("after EStop while {} fails", *calls.begin()));
  server.accept("QuitEStop");
}

/// Each call fails once. One that the command makes stops the arm, of others nobody knows. The arm
/// is held, so that it does not get anywhere before a beat is heard.
void expect_calls(ServerBench& server, const Calls& one, State state) {
  for (const auto call : kAllCalls) {
    const bool is_made = std::ranges::find(one.made, call) != one.made.end();
    if ((is_made && is_fatal(call)) || server.is_over()) continue;
    start_again(server);
    if (state == kSteering) server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
    hold(server);
    server.touch(fmt::format("arm.fail.{}", call), 1);
    server.say(one.command);
    server.about(fmt::format("{} while {} fails", one.command, call));
    server.pause(one.takes + 200ms + 6 * server.noise());
    server.expect_beat(is_made ? 3 : one.beat);
    server.touch(fmt::format("arm.fail.{}", call), 0);
    let_go(server);
  }
}

/// What Kinova's numbers of modes make of a command that moves the arm (reference 10.3 to 10.5).
enum class Does : std::uint8_t {
  kNothing,     ///< it is there
  kPress,       ///< the home button
  kPressTwice,  ///< and lets it go between
  kFail,
};
struct ModeRow {
  int mode;
  Does does;
};
constexpr int kModeError = 25'000;
constexpr std::array kModesToReady{
    ModeRow{0, Does::kPress}, ModeRow{1, Does::kNothing},    ModeRow{2, Does::kPress},
    ModeRow{3, Does::kPress}, ModeRow{4, Does::kPressTwice}, ModeRow{5, Does::kPress},
    ModeRow{6, Does::kPress}, ModeRow{7, Does::kNothing},    ModeRow{kModeError, Does::kFail}};
constexpr std::array kModesToFold{
    ModeRow{0, Does::kPress},   ModeRow{1, Does::kPress},   ModeRow{2, Does::kPressTwice},
    ModeRow{3, Does::kNothing}, ModeRow{4, Does::kPress},   ModeRow{5, Does::kPress},
    ModeRow{6, Does::kPress},   ModeRow{7, Does::kNothing}, ModeRow{kModeError, Does::kFail}};

struct Homing {
  State from;
  std::string_view command;
  Event event;
};

void begin_in(ServerBench& server, State state) {
  start_again(server);
  if (state == kRetracted) server.perform("Retract", Event::kRetracted);
  if (state == kPoweredOff) switch_off(server);
}

enum class Ends : std::uint8_t { kThere, kStopped };

/// The command in a mode, while a call fails that it makes or not. The arm is held, so that it does
/// not get anywhere.
void expect_homing(ServerBench& server, const Homing& one, int mode, std::string_view call,
                   Ends ends) {
  begin_in(server, one.from);
  hold(server);
  server.touch("arm.mode", mode);
  server.pause(100ms + 6 * server.noise());
  if (!call.empty()) server.touch(fmt::format("arm.fail.{}", call), 1);
  server.about(fmt::format("{} in mode {} while {} fails", one.command, mode,
                           call.empty() ? "nothing" : call));
  if (ends == Ends::kStopped) {
    server.say(one.command);
    server.pause(700ms + 6 * server.noise());
    server.expect_beat(3);
  } else {
    server.perform(std::string{one.command}, one.event, 400ms + 9 * server.noise());
  }
  if (!call.empty()) server.touch(fmt::format("arm.fail.{}", call), 0);
  server.touch("arm.mode", 5);
  let_go(server);
}

void expect_modes(ServerBench& server, const Homing& one, std::span<const ModeRow> rows) {
  for (const auto& [mode, does] : rows) {
    if (server.is_over()) return;
    switch (does) {
      case Does::kNothing:
        expect_homing(server, one, mode, "home_button_press", Ends::kThere);
        break;
      case Does::kPressTwice:
        expect_homing(server, one, mode, "joystick_release", Ends::kStopped);
        [[fallthrough]];
      case Does::kPress:
        expect_homing(server, one, mode, "home_button_press", Ends::kStopped);
        break;
      case Does::kFail:
        expect_homing(server, one, mode, "", Ends::kStopped);
        break;
    }
  }
}

/// Modes that are not awaited are no event; the one that is awaited still is.
void expect_only(ServerBench& server, State state, std::initializer_list<int> others, int awaited,
                 Event event) {
  enter(server, state);
  server.pause(100ms + 6 * server.noise());
  for (const int mode : others) {
    server.touch("arm.mode", mode);
    server.expect_quiet(100ms + 6 * server.noise());
  }
  server.touch("arm.mode", awaited);
  server.expect(event);
}

constexpr Clause kArmClauses[] = {
    must("kinovazed.arm.silent-stop",
         "A failure of the arm that can be repaired ends in emergencyStopped without a word; "
         "the next heartbeat shows it.",
         "server, recordings fault-status-*"),
    variant("stopped", in(kEmergencyStopped, "From emergencyStopped, beat 3.",
                          on<silent_stop<kEmergencyStopped>>)),
    variant("off", in(kPoweredOff, "From poweredOff, beat 3.", on<silent_stop<kPoweredOff>>)),
    variant("idle", in(kIdle, "From idle, beat 3.", on<silent_stop<kIdle>>)),
    variant("initializing",
            in(kInitializing, "From initializing, beat 3.", on<silent_stop<kInitializing>>)),
    variant("retracted", in(kRetracted, "From retracted, beat 3.", on<silent_stop<kRetracted>>)),
    variant("running", in(kRunningSequence, "From runningSequence, beat 3.",
                          on<silent_stop<kRunningSequence>>)),
    variant("steering", in(kSteering, "From steering, beat 3.", on<silent_stop<kSteering>>)),

    must("kinovazed.arm.recovers", "After a repair QuitEStop and Initialize lead to idle as ever.",
         "server, transcript S6"),
    in(kIdle, "Initialized, and beat 21.",
       [](ServerBench& server) {
         server.touch("arm.fail.current_read", 1);
         server.pause(300ms + 3 * server.noise());
         server.accept("QuitEStop");
         server.perform("Initialize", Event::kInitialized);
         server.expect_beat(21);
       }),

    must("kinovazed.arm.position-read", "One position that cannot be read changes nothing.",
         "server, recording fault-position-read"),
    in(kIdle, "No word, and beat 21.",
       [](ServerBench& server) {
         server.touch("arm.fail.position_read", 1);
         server.expect_quiet(300ms);
         server.expect_beat(21);
       }),

    must("kinovazed.arm.calls",
         "A command makes its own calls to the arm and no others, and one of them that fails ends "
         "in emergencyStopped.",
         "server; reference 6.6 and 11.1"),
    variant("idle", in(kIdle, "Nine calls fail during eight commands in idle.",
                       [](ServerBench& server) {
                         for (const auto& one : kCallsInIdle) expect_calls(server, one, kIdle);
                       })),
    variant("steering", in(kSteering, "And during three in steering.",
                           [](ServerBench& server) {
                             for (const auto& one : kCallsInSteering) {
                               expect_calls(server, one, kSteering);
                             }
                           })),

    must("kinovazed.arm.estop-calls",
         "EStop erases, zeroes and releases as every stop does, and gives the control of the arm "
         "back.",
         "server; reference 6.6 and 11.1"),
    /// A failure of a call that EStop makes is used up, and no Freeze meets it later.
    variant("stops", in(kIdle, "Each of the three fails in EStop, and in Freeze no more.",
                        [](ServerBench& server) {
                          for (const auto call : kStopping) {
                            estop_while_failing(server, {call});
                            server.perform("Initialize", Event::kInitialized);
                            server.say("Freeze");
                            server.pause(200ms + 6 * server.noise());
                            server.expect_beat(13);
                            start_again(server);
                          }
                        })),
    /// If it cannot be given back, the repair takes it again.
    variant("gives-back", in(kIdle, "Neither taken without need, nor kept.",
                             [](ServerBench& server) {
                               estop_while_failing(server, {"take_control"});
                               server.accept("Initialize");
                               server.expect_quiet(700ms + 6 * server.noise());
                               server.expect_beat(3);
                               start_again(server);
                               estop_while_failing(server, {"take_control", "release_control"});
                               server.perform("Initialize", Event::kInitialized);
                             })),

    must("kinovazed.arm.homing",
         "Where the arm says that it is decides what Initialize, Unfold and Retract do: nothing "
         "where it is there or its word is unknown, an error at 25000, else the home button, which "
         "is let go and pressed again where the arm turns round.",
         "server; reference 10.3 to 10.5"),
    variant("initialize", in(kPoweredOff, "Nine modes of the arm.",
                             [](ServerBench& server) {
                               expect_modes(server,
                                            {kPoweredOff, "Initialize", Event::kInitialized},
                                            kModesToReady);
                             })),
    variant("unfold", in(kRetracted, "Nine modes of the arm.",
                         [](ServerBench& server) {
                           expect_modes(server, {kRetracted, "Unfold", Event::kUnfolded},
                                        kModesToReady);
                         })),
    variant("retract", in(kIdle, "Nine modes of the arm.",
                          [](ServerBench& server) {
                            expect_modes(server, {kIdle, "Retract", Event::kRetracted},
                                         kModesToFold);
                          })),

    must("kinovazed.arm.awaited",
         "Only the mode that is awaited is an event: ready while it unfolds, folded while it "
         "retracts.",
         "server; reference 10.3"),
    variant("unfolding", in(kUnfolding, "All others pass without a word.",
                            [](ServerBench& server) {
                              expect_only(server, kUnfolding, {3, 0, 5, 2, 7}, 1, Event::kUnfolded);
                            })),
    variant("retracting", in(kRetracting, "All others pass without a word.",
                             [](ServerBench& server) {
                               expect_only(server, kRetracting, {1, 0, 5, 2, 7}, 3,
                                           Event::kRetracted);
                             })),
    variant("idle", in(kIdle, "None is in idle.",
                       [](ServerBench& server) {
                         for (const int mode : {3, 0, 1, 4, 3, 1}) {
                           server.touch("arm.mode", mode);
                           server.expect_quiet(100ms + 6 * server.noise());
                         }
                         server.expect_beat(21);
                       })),

    must("kinovazed.arm.takes-control-again",
         "A repair takes the control of the arm again that the server had, and else does not.",
         "server; reference 10.4"),
    /// What takes it uses up the failure.
    in(kIdle, "In idle it is taken, in poweredOff not.",
       [](ServerBench& server) {
         for (const bool has_control : {true, false}) {
           start_again(server);
           if (!has_control) switch_off(server);
           server.touch("arm.fail.take_control", 1);
           server.touch("arm.fail.status_read", 1);
           server.pause(500ms + 6 * server.noise());
           server.accept("QuitEStop");
           if (has_control) {
             server.perform("Initialize", Event::kInitialized);
           } else {
             server.accept("Initialize");
             server.expect_quiet(6s);
             server.expect_beat(3);
           }
           server.touch("arm.fail.take_control", 0);
         }
       }),

    must("kinovazed.arm.take-control",
         "If control cannot be taken Initialize ends in emergencyStopped, and Initialized "
         "never comes.",
         "server, recording fault-take-control"),
    from(kOff, Hazard::kMove, "No word for 6 s, and beat 3.",
         [](ServerBench& server) { expect_stop(server, "arm.fail.take_control", "Initialize"); }),

    must("kinovazed.arm.button",
         "If the home button cannot be pressed Initialize ends in emergencyStopped, and "
         "Initialized never comes.",
         "server, recording fault-button-initialize"),
    in(kIdle, "No word for 6 s, and beat 3.",
       [](ServerBench& server) {
         server.perform("Retract", Event::kRetracted);
         switch_off(server);
         expect_stop(server, "arm.fail.home_button_press", "Initialize");
       }),

    must("kinovazed.arm.erase",
         "If a trajectory cannot be erased RunObjective ends in emergencyStopped, and "
         "ObjectiveDone never comes.",
         "server, recording fault-erase-objective"),
    in(kIdle, "No word for 6 s, and beat 3.",
       [](ServerBench& server) {
         expect_stop(server, "arm.fail.trajectory_erase", kFarObjective);
       }),

    must("kinovazed.arm.release",
         "If the stick cannot be released Freeze is still confirmed, and ends in "
         "emergencyStopped.",
         "server, recording fault-release-freeze"),
    in(kIdle, "Freezed, and beat 3.",
       [](ServerBench& server) {
         server.touch("arm.fail.joystick_release", 1);
         server.perform("Freeze", Event::kFreezed);
         server.pause(200ms + 6 * server.noise());
         server.expect_beat(3);
       }),

    must("kinovazed.arm.move",
         "If a deflection cannot be written the move is still Accepted, and ends in "
         "emergencyStopped.",
         "server, transcript S7"),
    in(kSteering, "Accepted, and beat 3.",
       [](ServerBench& server) {
         server.touch("arm.fail.joystick_axes_write", 1);
         server.accept("MoveJoystick:1:1:1");
         server.pause(200ms + 6 * server.noise());
         server.expect_beat(3);
       }),

    must("kinovazed.arm.current-high", "4 A of all joints together change nothing.",
         "server, recording fault-current-high"),
    in(kIdle, "ObjectiveDone comes.",
       [](ServerBench& server) {
         server.accept(kFarObjective);
         server.touch("arm.current", 4000);
         server.expect(Event::kObjectiveDone, ServerBench::kMotionTime);
         server.touch("arm.current", 800);
       }),

    must("kinovazed.arm.early-ready",
         "An arm that reports ready while it initializes is initialized at once.",
         "server, recording fault-early-ready"),
    in(kInitializing, "Initialized comes within 0.2 s.",
       [](ServerBench& server) {
         enter(server, kInitializing);
         server.pause(200ms + 6 * server.noise());
         server.touch("arm.mode", 1);
         server.expect(Event::kInitialized, 200ms + 4 * server.noise());
       }),

    unobservable("what reaches the arm is not on the wire",
                 must("kinovazed.stop.no-release",
                      "A stop is erase, zero axes, release; failing axes leave out the release.",
                      "server; reference 11.1")),
};

}  // namespace

Chapter arm_chapter() { return chapter("Supervision of the arm", kArmClauses); }

}  // namespace armjig::kinovazed::conformance
