// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"
#include "conformance/kinovazed/fixture.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum State;

void expect_lives(ServerBench& server) {
  server.pause(500ms);
  server.expect_true(server.answers(), "an answer to EStop", "silence");
}

// What kills a shipped server.

void unplug(ServerBench& server) {
  server.spoil();
  server.about("while the arm is unplugged");
  server.touch("arm.plugged", 0);
  server.pause(200ms);
}

void break_velocity(ServerBench& server) {
  server.spoil();
  server.about("after a velocity that cannot be read");
  server.touch("arm.fail.velocity_read", 1);
  server.pause(200ms);
}

void draw_current(ServerBench& server) {
  server.spoil();
  server.about("after 4.6 A");
  server.touch("arm.current", 4600);
  server.pause(200ms);
  server.touch("arm.current", 800);
}

void break_mode_write(ServerBench& server) {
  server.spoil();
  server.touch("arm.fail.cartesian_mode_select", 1);
  server.accept("SetJoystickMode:XYZ");
}

/// Antenna and the end of Handle are further apart than the frame allows.
void ask_position(ServerBench& server) {
  server.spoil();
  server.perform("RunObjective:Handle", Event::kObjectiveDone);
  server.say("SetActiveObjective:Antenna");
  server.say("GetObjectivePosition");
}

/// The arm must be well again before anybody but Retract misses it.
void break_retract(ServerBench& server) {
  constexpr Duration kMostHand = 5ms;  // the server looks every 10 ms
  server.spoil();
  if (server.noise() > 10ms) server.leave_open("this server is too slow to be hit in that moment");
  server.begin_race();
  const auto begun = server.now();
  server.touch("arm.fail.status_read", -1);
  if (server.now() - begun > kMostHand) {
    server.leave_open("whoever breaks this arm takes longer than the server to look");
  }
  server.say("Retract");
  server.pause(150ms);
  server.touch("arm.fail.status_read", 0);
}

void break_mode_release(ServerBench& server) {
  server.spoil();
  server.begin_race();
  server.touch("arm.fail.joystick_release", -1);
  server.say("SetJoystickMode:XYZ");
  server.pause(150ms + 3 * server.noise());
  server.touch("arm.fail.joystick_release", 0);
}

void reset_waiting(ServerBench& server, std::string_view said = "") {
  server.spoil();
  server.as(1);
  server.connect();
  if (!said.empty()) server.say(said);
  server.pause(100ms);
  server.throw_away();
  server.pause(100ms);
  server.as(0);
  server.leave();
  server.as(2);
  server.pause(300ms);
}

/// A client that does not wait for its answers, and the next one.
template <void (ServerBench::*end)()>
void end_behind(ServerBench& server, std::string_view lines) {
  server.begin_race();
  server.send(lines);
  (server.*end)();
  server.as(1);
  server.pause(300ms);
  server.connect();
}

template <void (ServerBench::*end)()>
void end_at_freeze(ServerBench& server) {
  server.spoil();
  end_behind<end>(server, "Freeze\r\nUnfreeze\r\n");
}

constexpr char kFreeze[] = "Freeze\r\n";

/// Each is refused, and no event follows.
constexpr char kRefused[] = "QuitEStop\r\nQuitEStop\r\nQuitEStop\r\n";

/// Behind a beat, so that none waits among the answers.
template <const char* lines, void (ServerBench::*end)()>
void ends_harmlessly(ServerBench& server) {
  server.await_beat();
  end_behind<end>(server, lines);
  expect_lives(server);
}

/// Where the hand has to be so that the second way-point of PullDoor, (-0.45, -0.08, -0.272) in its
/// frame, lies on an edge of the workspace, and the component that leads over it.
struct Edge {
  Place hand;
  std::size_t axis;
  int side;
};
// A roll of 3 turns that point to (0.456786, 0.015695, -0.272), a pitch of 3 to
// (-0.45, 0.117584, 0.257988).
constexpr std::array kEdges{
    Edge{{-0.35, 0, 0.6, 0, 0, 0}, 0, -1}, Edge{{0.343214, 0, 0.6, 0, 0, 3}, 0, 1},
    Edge{{0, -0.77, 0.6, 0, 0, 0}, 1, -1}, Edge{{0, 0.834305, 0.6, 0, 0, 3}, 1, 1},
    Edge{{0, 0, 0.892012, 3, 0, 0}, 2, 1}};
constexpr double kEdge = 0.002;

/// PullDoor up to its second way-point, which lies `beyond` the edge.
void pull_door(ServerBench& server, const Edge& edge, double beyond) {
  auto hand = edge.hand;
  hand[edge.axis] += edge.side * beyond;
  visit(server, hand);
  server.about(fmt::format("PullDoor from {:.6f} on axis {}", hand[edge.axis], edge.axis));
  server.accept("RunObjective:PullDoor");
  server.pause(300ms + 6 * server.noise());
}

template <std::size_t edge>
void pull_door_outside(ServerBench& server) {
  server.spoil();
  pull_door(server, kEdges[edge], kEdge);
}

/// Where the hand is when Current is made the objective, which is its frame, and where it is asked.
struct Asked {
  Place frame;
  Place hand;
};
constexpr double kQuarter = 1.570796;
constexpr std::array kInside{
    Asked{{-0.4, 0, 0.3, 0, 0, 0}, {0.398, 0, 0.3, 0, 0, 0}},
    Asked{{0.4, 0, 0.3, 0, 0, 0}, {-0.398, 0, 0.3, 0, 0, 0}},
    Asked{{0, -0.45, 0.3, 0, 0, 0}, {0, 0.398, 0.3, 0, 0, 0}},
    Asked{{0, 0.45, 0.3, 0, 0, 0}, {0, -0.398, 0.3, 0, 0, 0}},
    Asked{{0, 0, -0.3, 0, 0, 0}, {0, 0, 0.848, 0, 0, 0}},
    // y of the base is x here, and its x the negative y, of which there is more.
    Asked{{0.45, -0.4, 0.3, 0, 0, kQuarter}, {-0.398, 0.398, 0.3, 0, 0, 0}},
    // The negative y is z here, of which there is most, and its z is y.
    Asked{{0, 0.6, -0.3, kQuarter, 0, 0}, {0, -0.54, 0.548, 0, 0, 0}},
    // x is z here, and its z the negative x.
    Asked{{-0.6, 0, -0.3, 0, kQuarter, 0}, {0.54, 0, 0.498, 0, 0, 0}},
    Asked{{0.2, 0.1, 0.3, 0.3, -0.4, 0.5}, {-0.2, -0.1, 0.2, 1, 0.2, -2}},
};
constexpr std::array kOutside{
    Asked{{0.4, 0, 0.3, 0, 0, 0}, {-0.402, 0, 0.3, 0, 0, 0}},
    Asked{{-0.4, 0, 0.3, 0, 0, 0}, {0.402, 0, 0.3, 0, 0, 0}},
    Asked{{0, 0.45, 0.3, 0, 0, 0}, {0, -0.402, 0.3, 0, 0, 0}},
    Asked{{0, -0.45, 0.3, 0, 0, 0}, {0, 0.402, 0.3, 0, 0, 0}},
    Asked{{0, 0, -0.3, 0, 0, 0}, {0, 0, 0.852, 0, 0, 0}},
    Asked{{0, -0.4, 0.3, 0, 0, kQuarter}, {0, 0.402, 0.3, 0, 0, 0}},
    Asked{{0, 0.6, 0.3, kQuarter, 0, 0}, {0, -0.56, 0.3, 0, 0, 0}},
    Asked{{0, 0, -0.3, 0, kQuarter, 0}, {0, 0, 0.502, 0, 0, 0}},
};

void ask_from(ServerBench& server, const Asked& asked) {
  visit(server, asked.frame);
  server.say("SetActiveObjective:Current");
  server.pause(50ms + 3 * server.noise());
  visit(server, asked.hand);
  server.about(fmt::format("asked at {}, {}, {}", asked.hand[0], asked.hand[1], asked.hand[2]));
  server.say("GetObjectivePosition");
}

template <std::size_t row>
void ask_outside(ServerBench& server) {
  server.spoil();
  ask_from(server, kOutside[row]);
}

template <void (*kill)(ServerBench&)>
void hangs(ServerBench& server) {
  kill(server);
  expect_hung(server);
}

template <void (*kill)(ServerBench&)>
void ends(ServerBench& server) {
  kill(server);
  server.expect_end();
}

template <void (*kill)(ServerBench&)>
void lives(ServerBench& server) {
  kill(server);
  expect_lives(server);
}

constexpr Case dies(std::string_view rule, CaseBody run) {
  return full(from(kReady, Hazard::kCrash, rule, run));
}

constexpr Clause kDeathClauses[] = {
    must("kinovazed.death.hang",
         "With its supervision dead the server keeps its connections, and sends nothing any "
         "more.",
         "server, recording fault-unplug-idle", Profiles::kFirmware, "kinovazed.death.repairs"),
    dies("Neither this client nor the next hears anything.",
         [](ServerBench& server) {
           unplug(server);
           expect_hung(server);
           server.about("the next client of a hung server");
           server.connect();
           server.expect_no_message(1500ms);
         }),

    should("kinovazed.death.repairs",
           "An arm that was unplugged and is back leaves the server in emergencyStopped, and it "
           "answers.",
           "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.hang"),
    dies("EStop is answered.",
         [](ServerBench& server) {
           unplug(server);
           server.touch("arm.plugged", 1);
           server.pause(300ms);
           server.expect_true(server.answers(), "an answer to EStop", "silence");
         }),

    must("kinovazed.death.velocity", "A velocity that cannot be read hangs the server.",
         "server; reference 11.2", Profiles::kFirmware, "kinovazed.death.no-velocity"),
    dies("Nothing comes.", on<hangs<break_velocity>>),

    should("kinovazed.death.no-velocity",
           "A velocity that cannot be read leaves the server answering.",
           "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.velocity"),
    dies("EStop is answered.", on<lives<break_velocity>>),

    must("kinovazed.death.current", "More than 4.5 A of all joints together hang the server.",
         "server; reference 11.2", Profiles::kFirmware, "kinovazed.death.no-current"),
    dies("Nothing comes.", on<hangs<draw_current>>),

    should("kinovazed.death.no-current",
           "More than 4.5 A of all joints together leave the server answering.",
           "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.current"),
    dies("EStop is answered.", on<lives<draw_current>>),

    must("kinovazed.death.mode-write",
         "A control type that cannot be written hangs the server, after Accepted.",
         "server; reference 11.2", Profiles::kFirmware, "kinovazed.death.no-mode-write"),
    dies("Accepted, and then nothing.", on<hangs<break_mode_write>>),

    should("kinovazed.death.no-mode-write",
           "A control type that cannot be written leaves the server answering.",
           "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.mode-write"),
    dies("EStop is answered.", on<lives<break_mode_write>>),

    must("kinovazed.death.later-point",
         "A way-point outside 0.8 m in x, 0.85 m in y or 1.15 m in z hangs the server, if it "
         "is not the first one.",
         "server, transcript S9; reference 9.2", Profiles::kFirmware),
    variant("inside", in(kIdle, "Five that are 2 mm inside: it runs on.",
                         [](ServerBench& server) {
                           for (const auto& one : kEdges) {
                             pull_door(server, one, -kEdge);
                             server.expect_beat(37);
                           }
                         })),
    variant("x-low", dies("2 mm outside: nothing comes.", on<hangs<pull_door_outside<0>>>)),
    variant("x-high", dies("2 mm outside: nothing comes.", on<hangs<pull_door_outside<1>>>)),
    variant("y-low", dies("2 mm outside: nothing comes.", on<hangs<pull_door_outside<2>>>)),
    variant("y-high", dies("2 mm outside: nothing comes.", on<hangs<pull_door_outside<3>>>)),
    variant("z-high", dies("2 mm outside: nothing comes.", on<hangs<pull_door_outside<4>>>)),

    must("kinovazed.death.process",
         "Some errors end the process: its clients see the end of their connections, those that "
         "wait, too.",
         "server; reference 11.3", Profiles::kFirmware),
    quick(dies("Of three clients, two of which wait, each sees the end.",
               [](ServerBench& server) {
                 for (const auto waiting : {1U, 2U}) {
                   server.as(waiting);
                   server.connect();
                 }
                 server.as(0);
                 ask_position(server);
                 for (const auto client : {0U, 1U, 2U}) {
                   server.as(client);
                   server.about(fmt::format("client {} of three", client + 1));
                   server.expect_end();
                 }
               })),

    unobservable("it needs a file of objectives that no client can give",
                 must("kinovazed.death.first-point",
                      "A first way-point outside the same limits ends the process.",
                      "server; reference 11.3", Profiles::kFirmware)),

    unobservable("it needs a file of objectives that no client can give",
                 must("kinovazed.death.objective-missing",
                      "An objective that the file does not have ends the process.",
                      "server, transcript S12", Profiles::kFirmware)),

    must("kinovazed.death.objective-position",
         "GetObjectivePosition outside the same limits, in the frame of the objective, ends "
         "the process.",
         "server; reference 5.3", Profiles::kFirmware, "kinovazed.death.no-objective-position"),
    quick(dies("The connection ends.", on<ends<ask_position>>)),

    must("kinovazed.death.position-edges",
         "The position that GetObjectivePosition asks for lies in the frame of the objective, by "
         "whose inverse it is reckoned, and counts as outside as way-points do.",
         "server; reference 5.3, 9.2 and 9.5", Profiles::kFirmware),
    variant("inside", in(kIdle, "Nine positions inside, most by 2 mm: it goes on.",
                         [](ServerBench& server) {
                           for (const auto& one : kInside) {
                             ask_from(server, one);
                             server.expect_beat(21);
                           }
                         })),
    variant("x-low", dies("2 mm outside: the connection ends.", on<ends<ask_outside<0>>>)),
    variant("x-high", dies("2 mm outside: the connection ends.", on<ends<ask_outside<1>>>)),
    variant("y-low", dies("2 mm outside: the connection ends.", on<ends<ask_outside<2>>>)),
    variant("y-high", dies("2 mm outside: the connection ends.", on<ends<ask_outside<3>>>)),
    variant("z-high", dies("2 mm outside: the connection ends.", on<ends<ask_outside<4>>>)),
    variant("rolled", dies("2 mm outside: the connection ends.", on<ends<ask_outside<5>>>)),
    variant("pitched", dies("1 cm outside: the connection ends.", on<ends<ask_outside<6>>>)),
    variant("turned", dies("2 mm outside: the connection ends.", on<ends<ask_outside<7>>>)),

    should("kinovazed.death.no-objective-position", "GetObjectivePosition never ends the process.",
           "document is silent; our choice", Profiles::kDocumented,
           "kinovazed.death.objective-position"),
    dies("EStop is answered.", on<lives<ask_position>>),

    must("kinovazed.death.retract-read", "A mode that cannot be read in Retract ends the process.",
         "server; reference 11.3", Profiles::kFirmware, "kinovazed.death.no-retract-read"),
    dies("The connection ends.", on<ends<break_retract>>),

    should("kinovazed.death.no-retract-read",
           "A mode that cannot be read in Retract leaves the server answering.",
           "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.retract-read"),
    dies("EStop is answered.", on<lives<break_retract>>),

    must("kinovazed.death.mode-release",
         "A release that fails in SetJoystickMode ends the process.", "server; reference 11.3",
         Profiles::kFirmware, "kinovazed.death.no-mode-release"),
    dies("The connection ends.", on<ends<break_mode_release>>),

    should("kinovazed.death.no-mode-release",
           "A release that fails in SetJoystickMode leaves the server answering.",
           "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.mode-release"),
    dies("EStop is answered.", on<lives<break_mode_release>>),

    must("kinovazed.death.accept-reset",
         "A client that resets while it waits ends the process when its turn comes.",
         "server; reference 1.7", Profiles::kFirmware, "kinovazed.death.no-accept-reset"),
    quick(dies("The next connection is refused.",
               [](ServerBench& server) {
                 reset_waiting(server);
                 server.expect_true(!server.is_served(), "a process that has ended",
                                    "a client that is served");
               })),
    variant("after-line", dies("Nor after one that had said something.",
                               [](ServerBench& server) {
                                 reset_waiting(server, "EStop");
                                 server.expect_true(!server.is_served(), "a process that has ended",
                                                    "a client that is served");
                               })),

    should("kinovazed.death.no-accept-reset", "A client that resets while it waits does no harm.",
           "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.accept-reset"),
    dies("The next client is served.",
         [](ServerBench& server) {
           reset_waiting(server);
           server.expect_true(server.is_served(), "a client that is served", "none");
         }),

    must("kinovazed.death.mute",
         "A write that fails while another message waits behind it mutes the server for good: "
         "Freeze and a reset do, and Freeze with Unfreeze and a close.",
         "server, transcript S11, recording defect-mute-after-close", Profiles::kFirmware,
         "kinovazed.death.no-mute"),
    quick(
        dies("The next client hears nothing.", on<hangs<end_at_freeze<&ServerBench::throw_away>>>)),
    variant("closed",
            dies("The next client hears nothing.", on<hangs<end_at_freeze<&ServerBench::leave>>>)),
    variant("half-closed", quick(dies("The next client hears nothing.",
                                      on<hangs<end_at_freeze<&ServerBench::finish_sending>>>))),

    must("kinovazed.death.not-mute",
         "One message after the one that fails does not mute it, nor do lines of one message each: "
         "a lone Freeze, or refused lines, with a close or a half-close are harmless.",
         "server; reference 4.6"),
    in(kIdle, "Freeze and a close: EStop of the next client is answered.",
       on<ends_harmlessly<kFreeze, &ServerBench::leave>>),
    variant("half-closed", in(kIdle, "Freeze and a half-close: EStop of the next is answered.",
                              on<ends_harmlessly<kFreeze, &ServerBench::finish_sending>>)),
    variant("lines", in(kIdle, "Three lines and a close: EStop of the next is answered.",
                        on<ends_harmlessly<kRefused, &ServerBench::leave>>)),
    variant("lines.half-closed",
            in(kIdle, "Three lines and a half-close: EStop of the next is answered.",
               on<ends_harmlessly<kRefused, &ServerBench::finish_sending>>)),

    should("kinovazed.death.no-mute", "Freeze and the end of a connection do no harm.",
           "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.mute"),
    dies("EStop of the next client is answered.",
         on<lives<end_at_freeze<&ServerBench::throw_away>>>),
    variant("closed", dies("EStop of the next client is answered.",
                           on<lives<end_at_freeze<&ServerBench::leave>>>)),
};

}  // namespace

Chapter death_chapter() { return chapter("Deaths", kDeathClauses); }

}  // namespace armjig::kinovazed::conformance
