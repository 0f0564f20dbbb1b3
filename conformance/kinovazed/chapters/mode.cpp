// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum State;

template <const char* mode>
void set(ServerBench& server) {
  server.perform(std::string{"SetJoystickMode:"} + mode, Event::kJoystickModeSet);
  server.accept(kStop);
  server.expect_beat(69);
}

/// From any state that takes modes.
void no_mode(ServerBench& server) {
  server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet, 400ms + server.noise());
  server.expect_beat(21);
}

constexpr int kTurnsOfAMode = 3;

/// A mode settles in its time whatever is asked meanwhile.
void expect_to_settle_when_asked(ServerBench& server) {
  const auto said = server.now();
  server.accept("SetJoystickMode:Rotation");
  for (int i = 0; i < 3 && server.now() - said < 400ms; ++i) {
    server.pause(100ms);
    server.refuse("Unfold");
  }
  const auto set = server.expect(Event::kJoystickModeSet, ServerBench::kMotionTime);
  server.about("from a mode that is asked about until it is set");
  expect_time(server, set.time - said, 500ms, 680ms + 2 * kTurnsOfAMode * server.noise());
}

/// Two modes with less than half a second between them, which is why the arm has to be ready. On a
/// slow server there is more, and what is to be seen is left open.
void two_modes(ServerBench& server) {
  server.accept("SetJoystickMode:XYZ");
  const auto begin = server.now();
  initialize_afresh(server);
  if (server.now() - begin + 3 * server.noise() > 500ms) {
    server.leave_open("this server takes longer than half a second from one mode to the next");
  }
  server.say("SetJoystickMode:Rotation");
}

constexpr Clause kModeClauses[] = {
    must("kinovazed.mode.settles", "JoystickModeSet comes half a second after a mode that moves.",
         "server, recording session-joystick-modes"),
    /// The shortest of three, for all that a link does makes it longer. A mode takes more turns
    /// with the arm than an answer.
    in(kIdle, "0.5 to 0.7 s.",
       [](ServerBench& server) {
         auto shortest = ServerBench::kMotionTime;
         for (const auto* mode : {"Rotation", "XYZ", "Axis1to3"}) {
           const auto said = server.now();
           const auto set =
               server.perform(std::string{"SetJoystickMode:"} + mode, Event::kJoystickModeSet);
           shortest = std::min(shortest, set.time - said);
         }
         expect_time(server, shortest, 500ms, 680ms + kTurnsOfAMode * server.noise());
       }),

    variant("asked", in(kIdle, "0.5 to 0.7 s, with three refused commands on the way.",
                        on<expect_to_settle_when_asked>)),

    must("kinovazed.mode.no-mode", "NoMode is confirmed at once and leads from steering to idle.",
         "server, transcript T22"),
    in(kSteering, "Within 0.4 s, and beat 21.", on<no_mode>),

    must("kinovazed.mode.no-mode-idle", "NoMode in idle is confirmed at once, and idle stays.",
         "server, transcript T21"),
    in(kIdle, "Within 0.4 s, and beat 21.", on<no_mode>),

    must("kinovazed.mode.no-mode-running",
         "NoMode ends an objective that runs: it is confirmed, and idle follows.",
         "server; reference 6.3"),
    in(kRunningSequence, "JoystickModeSet, beat 21, and no ObjectiveDone.",
       [](ServerBench& server) {
         enter(server, kRunningSequence);
         server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet);
         server.expect_beat(21);
         server.expect_quiet(3s);
       }),

    must("kinovazed.mode.xyz", "Mode XYZ can be set and steered in.",
         "document; server, recording session-joystick-modes"),
    in(kIdle, "A move is Accepted, and beat 69.", on<set<kXyz>>),

    must("kinovazed.mode.rotation", "Mode Rotation can be set and steered in.",
         "document; server, recording session-joystick-modes"),
    in(kIdle, "A move is Accepted, and beat 69.", on<set<kRotation>>),

    must("kinovazed.mode.axis1to3", "Mode Axis1to3 can be set and steered in.",
         "document; server, recording session-joystick-modes"),
    in(kIdle, "A move is Accepted, and beat 69.", on<set<kAxis1to3>>),

    must("kinovazed.mode.axis4to6", "Mode Axis4to6 can be set and steered in.",
         "document; server, recording session-joystick-modes"),
    in(kIdle, "A move is Accepted, and beat 69.", on<set<kAxis4to6>>),

    must("kinovazed.mode.chain", "From steering another mode can be set without leaving it first.",
         "server, transcript T24"),
    in(kSteering, "Four modes, and moves between them.",
       [](ServerBench& server) {
         for (const auto* mode : {"Rotation", "Axis1to3", "Axis4to6", "XYZ"}) {
           server.perform(std::string{"SetJoystickMode:"} + mode, Event::kJoystickModeSet);
           server.accept(kStop);
         }
       }),

    must("kinovazed.mode.guard",
         "A mode that is written within 500 ms of another one, by way of EStop, hangs the "
         "server.",
         "server, recording defect-mode-change-too-soon", Profiles::kFirmware,
         "kinovazed.mode.no-guard"),
    from(kReady, Hazard::kCrash, "Accepted, and then nothing, not even a beat.",
         [](ServerBench& server) {
           server.spoil();
           two_modes(server);
           server.expect(Event::kAccepted);
           server.about("after two modes within half a second");
           expect_hung(server);
         }),

    should("kinovazed.mode.no-guard",
           "A mode that is written within 500 ms of another one, by way of EStop, is set like "
           "any other.",
           "document is silent; our choice", Profiles::kDocumented, "kinovazed.mode.guard"),
    from(kReady, Hazard::kCrash, "EStop is answered.",
         [](ServerBench& server) {
           server.spoil();
           two_modes(server);
           server.pause(1s);
           server.expect_true(server.answers(), "an answer", "silence");
         }),

    must("kinovazed.mode.late-enough",
         "The same way with more than 500 ms between the two modes is harmless.",
         "server, recording defect-mode-change-late-enough"),
    in(kIdle, "The second mode is set.",
       [](ServerBench& server) {
         server.accept("SetJoystickMode:XYZ");
         switch_off(server);
         server.pause(700ms);
         server.perform("Initialize", Event::kInitialized);
         server.perform("SetJoystickMode:Rotation", Event::kJoystickModeSet);
         server.expect_beat(69);
       }),
    variant("after-no-mode", in(kIdle, "NoMode between them does not count.",
                                [](ServerBench& server) {
                                  server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
                                  server.pause(700ms);
                                  server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet);
                                  server.perform("SetJoystickMode:Rotation",
                                                 Event::kJoystickModeSet);
                                  server.expect_beat(69);
                                })),
};

}  // namespace

Chapter mode_chapter() { return chapter("Joystick modes", kModeClauses); }

}  // namespace armjig::kinovazed::conformance
