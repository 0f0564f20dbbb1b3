// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

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

    must("kinovazed.arm.recovers", "Behind a repair QuitEStop and Initialize lead to idle as ever.",
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
         server.touch("arm.mode", 1);
         server.expect(Event::kInitialized, 200ms + 2 * server.noise());
       }),

    unobservable("what reaches the arm is not on the wire",
                 must("kinovazed.stop.no-release",
                      "A stop is erase, zero axes, release; failing axes leave out the release.",
                      "server; reference 11.1")),
};

}  // namespace

Chapter arm_chapter() { return chapter("Supervision of the arm", kArmClauses); }

}  // namespace armjig::kinovazed::conformance
