// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "conformance/kinovazed/cases.hpp"
#include "conformance/kinovazed/fixture.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum State;

constexpr auto kUp = "MoveJoystick:0:0:400";

/// An arm that was up for two seconds is 0.4 m away from Home, which takes time; one that was not
/// is there at once.
constexpr Duration kWayBack = 500ms;

/// How long the arm is deflected, and how much shorter the way back is then at least if it was led
/// back.
constexpr Duration kPush = 2s;
constexpr Duration kAway = 150ms;

void rise_from_home(ServerBench& server) {
  (void)time_of(server, "Home");
  server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
  server.accept(kUp);
}

void expect_far_from_home(ServerBench& server) {
  const auto back = time_of(server, "Home");
  server.about("the way back to Home");
  expect_time(server, back, kWayBack, ServerBench::kMotionTime);
}

std::string deflection(std::size_t axis, int number) {
  std::array<int, 3> numbers{};
  numbers[axis] = number;
  return fmt::format("MoveJoystick:{}:{}:{}", numbers[0], numbers[1], numbers[2]);
}

struct Push {
  std::size_t axis;
  int number;
  Duration time;
};

/// Leads the arm away by some deflections, one after the other.
void push_in(ServerBench& server, std::string_view mode, std::initializer_list<Push> pushes) {
  server.perform("SetJoystickMode:" + std::string{mode}, Event::kJoystickModeSet);
  for (const auto& [axis, number, time] : pushes) {
    server.accept(deflection(axis, number));
    server.pause(time);
  }
  server.accept(kStop);
}

void push_from_home(ServerBench& server, std::string_view mode,
                    std::initializer_list<Push> pushes) {
  (void)time_of(server, "Home");
  push_in(server, mode, pushes);
}

/// The way back to Home behind some deflections.
Duration way_back(ServerBench& server, std::string_view mode, std::initializer_list<Push> pushes) {
  push_from_home(server, mode, pushes);
  return time_of(server, "Home");
}

/// The way back from a push of Axis4to6, with the hand led to Home from the same place each time.
Duration way_back_after(ServerBench& server, std::string_view mode_before) {
  initialize_afresh(server);
  (void)time_of(server, "Home");
  server.perform("SetJoystickMode:" + std::string{mode_before}, Event::kJoystickModeSet);
  push_in(server, kAxis4to6, {{2, 400, kPush}});
  return time_of(server, "Home");
}

/// A push of Axis4to6 leads as far away whatever mode was set before.
void expect_own_axes(ServerBench& server) {
  const auto own = way_back_after(server, "NoMode");
  const auto tolerance = kAway + server.noise();
  for (const auto* const before : {kXyz, kAxis1to3}) {
    const auto back = way_back_after(server, before);
    server.about(fmt::format("the way back from a push of Axis4to6, set after {}", before));
    expect_time(server, back, own - tolerance, own + tolerance);
  }
}

/// How long the server takes for many moves that come together.
Duration time_of_moves(ServerBench& server, std::string_view move) {
  constexpr int kMany = 40;
  std::string moves;
  for (int i = 0; i < kMany; ++i) moves += std::string{move} + "\r\n";
  const auto said = server.now();
  server.send(moves);
  auto last = said;
  for (int i = 0; i < kMany && !server.is_over(); ++i) {
    last = server.expect(Event::kAccepted).time;
  }
  return last - said;
}

/// Three zeroes are a deflection like others, and no stop, for which a server waits.
void expect_zeroes_as_fast(ServerBench& server) {
  constexpr Duration kShortestStops = 600ms;
  const auto usual = time_of_moves(server, "MoveJoystick:0:0:1");
  const auto zeroes = time_of_moves(server, kStop);
  server.about("how much longer forty moves by zeroes take than forty by 1");
  expect_time(server, std::max(zeroes - usual, Duration{}), {}, kShortestStops + server.noise());
}

/// Each axis leads away, and only its own opposite leads back.
template <const char* mode>
void three_axes(ServerBench& server) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto next = (axis + 1) % 3;
    const auto away = way_back(server, mode, {{axis, 400, kPush}});
    const auto back = way_back(server, mode, {{axis, 400, kPush}, {axis, -400, kPush}});
    const auto aside = way_back(server, mode, {{axis, 400, kPush}, {next, -400, kPush}});
    server.about(fmt::format("number {} of {} there, against there and back", axis + 1, mode));
    expect_time(server, away - back, kAway, ServerBench::kMotionTime);
    server.about(fmt::format("number {} of {} with another back", axis + 1, mode));
    expect_time(server, aside - back, kAway, ServerBench::kMotionTime);
  }
}

/// Along one axis, then another, and back along both. One that goes on while another is asked for
/// leads farther.
void expect_square_to_close(ServerBench& server) {
  const auto even = way_back(server, kXyz, {{2, 400, kPush}, {2, -400, kPush}});
  const auto square = way_back(
      server, kXyz, {{2, 400, kPush}, {0, 400, kPush}, {2, -400, kPush}, {0, -400, kPush}});
  server.about("how much farther it is back from four sides of a square than from there and back");
  expect_time(server, std::max(square - even, Duration{}), {}, kAway + 2 * server.noise());
}

/// An axis of the joystick, and the objective that lies farthest to the side to which its positive
/// numbers lead.
struct Side {
  std::size_t axis;
  const char* objective;
};

/// How much nearer it is after a push to its side than after one the other way.
Duration nearer_by(ServerBench& server, const Side& side) {
  const auto way_after = [&](int number) {
    push_from_home(server, kXyz, {{side.axis, number, kPush}});
    return time_of(server, side.objective);
  };
  const auto to_it = way_after(400);
  return way_after(-400) - to_it;
}

struct Ending {
  const char* command;
  std::optional<Event> event{};  ///< that follows its acceptance
};

/// Going up, then stopped: the way back must not grow while time passes.
void expect_stopped_by(ServerBench& server, std::initializer_list<Ending> endings) {
  rise_from_home(server);
  server.pause(kPush);
  server.accept(kStop);
  const auto usual = time_of(server, "Home");
  for (const auto& [command, event] : endings) {
    rise_from_home(server);
    server.pause(kPush);
    if (event) {
      server.perform(command, *event);
    } else {
      server.accept(command);
    }
    server.pause(4s);
    if (event == Event::kFreezed) server.perform("Unfreeze", Event::kUnfreezed);
    server.about(std::string{"the way back from a rise that was ended by "} + command);
    expect_time(server, time_of(server, "Home"), 0ms, usual + 400ms + server.noise());
  }
}

/// Home, as reference 9.6 has it, and what bounds deflections there.
constexpr Place kHomePlace{0.048067, -0.330291, 0.472718, 1.712650, -0.139070, -0.113034};
struct Bound {
  std::size_t axis;
  double metres;
};
constexpr std::array kBounds{Bound{0, 0.79}, Bound{1, 0.84}};
constexpr double kMillimetre = 0.001;
/// A hand that is held at its target is seen there sooner.
constexpr Duration kNotThere = 500ms;

/// The wrist is turned for a second with the hand at Home, but for one component. Then it is held
/// at Home, which is reached if it was not turned.
void turn_wrist(ServerBench& server, std::size_t axis, double place, int number) {
  auto hand = kHomePlace;
  hand[axis] = place;
  server.perform("SetJoystickMode:Rotation", Event::kJoystickModeSet);
  visit(server, hand);
  server.accept(deflection(axis, number));
  let_go(server);
  server.pause(1s);
  server.accept(kStop);
  hold(server);
  hold_at(server, axis, kHomePlace[axis]);
  server.about(fmt::format("Home after a turn by {} at {}", number, place));
}

/// The hand that is held is at Home, or not.
void expect_at_home(ServerBench& server) {
  server.perform("RunObjective:Home", Event::kObjectiveDone);
}
void expect_elsewhere(ServerBench& server) {
  server.accept("RunObjective:Home");
  server.expect_quiet(kNotThere + 3 * server.noise());
}

constexpr Clause kJoystickClauses[] = {
    must("kinovazed.joystick.gate", "After NoMode moves are Rejected.",
         "server, recording joystick-mode-gate"),
    in(kSteering, "Rejected.",
       [](ServerBench& server) {
         server.perform("SetJoystickMode:NoMode", Event::kJoystickModeSet);
         server.refuse(kStop);
       }),

    must("kinovazed.joystick.behind-freeze",
         "After Freeze and Unfreeze moves are Rejected until a mode is set again.",
         "server; reference 6.6"),
    in(kSteering, "Rejected, and Accepted after a mode.",
       [](ServerBench& server) {
         server.perform("Freeze", Event::kFreezed);
         server.perform("Unfreeze", Event::kUnfreezed);
         server.refuse(kStop);
         server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
         server.accept(kStop);
       }),

    must("kinovazed.joystick.behind-objective",
         "After an objective moves are Rejected until a mode is set again.",
         "server, transcript T42"),
    in(kSteering, "Rejected.",
       [](ServerBench& server) {
         server.perform("RunObjective:Current", Event::kObjectiveDone);
         server.refuse(kStop);
       }),

    must("kinovazed.joystick.any-number",
         "Moves by any number of 32 bits are Accepted in steering.", "server, transcript T87"),
    /// Each is undone in the same segment.
    in(kSteering, "Four numbers are Accepted.",
       [](ServerBench& server) {
         for (const auto* number : {"2147483647", "-2147483648", "400", "-1"}) {
           server.about(std::string{"a move by "} + number);
           server.send(std::string{"MoveJoystick:0:0:"} + number + "\r\nMoveJoystick:0:0:0\r\n");
           server.expect(Event::kAccepted);
           server.expect(Event::kAccepted);
         }
       }),

    must("kinovazed.joystick.stream", "A stream of moves is answered move by move.",
         "server, transcript T27"),
    in(kSteering, "Twenty moves in one go are Accepted.",
       [](ServerBench& server) {
         std::string moves;
         for (int i = 0; i < 20; ++i) moves += "MoveJoystick:0:0:0\r\n";
         server.send(moves);
         for (int i = 0; i < 20; ++i) server.expect(Event::kAccepted);
         server.expect_silence();
       }),
    variant("zeroes", in(kSteering, "Forty zeroes take no longer than forty of 1.",
                         on<expect_zeroes_as_fast>)),

    must("kinovazed.joystick.holds", "A deflection moves the arm until the next one.",
         "server; reference 8.2"),
    quick(in(kIdle, "Two seconds up, and Home is far away.",
             [](ServerBench& server) {
               rise_from_home(server);
               server.pause(2s);
               server.accept(kStop);
               expect_far_from_home(server);
             })),

    must("kinovazed.joystick.client-lost",
         "A deflection moves the arm on when its client has left.", "server, transcript S4"),
    in(kIdle, "Two seconds up without a client, and Home is far away.",
       [](ServerBench& server) {
         rise_from_home(server);
         server.pause(100ms);
         server.leave();
         server.pause(2s);
         server.connect();
         server.accept(kStop);
         expect_far_from_home(server);
       }),

    must("kinovazed.joystick.axes",
         "Each of the three numbers moves the arm on an axis of its own, both ways.",
         "server; reference 8.1"),
    variant("xyz", in(kIdle, "There and back on each axis, and not back by another.",
                      on<three_axes<kXyz>>)),
    variant("rotation", quick(in(kIdle, "There and back on each axis, and not back by another.",
                                 on<three_axes<kRotation>>))),

    variant("square", in(kIdle, "Four pushes of two axes of XYZ lead back to where they began.",
                         on<expect_square_to_close>)),

    must("kinovazed.joystick.own-axes",
         "A mode has its own axes also right after another one, with no NoMode between.",
         "server; reference 8.2"),
    in(kIdle, "The third of Axis4to6 after XYZ and Axis1to3 leads as far as without.",
       on<expect_own_axes>),

    must("kinovazed.joystick.signs",
         "In mode XYZ positive numbers lead the hand up, to the right and to the front, which is "
         "along +z, -x and -y of the frame of the objectives; where somebody has turned the arm "
         "by half, along +x and +y.",
         "document; server; reference 8.1"),
    quick(in(kIdle,
             "Antenna is nearer after a push up, SuckDoor to the right and Handle to the front.",
             [](ServerBench& server) {
               const auto up = nearer_by(server, {2, "Antenna"});
               const auto to_the_right = nearer_by(server, {0, "SuckDoor"});
               const auto to_the_front = nearer_by(server, {1, "Handle"});
               const int turned = to_the_right < 0ms ? -1 : 1;
               server.about("Antenna after a push up, against one down");
               expect_time(server, up, kAway, ServerBench::kMotionTime);
               server.about("SuckDoor after a push in x, against the other way");
               expect_time(server, turned * to_the_right, kAway, ServerBench::kMotionTime);
               server.about("Handle after a push in y, against the other way, turned like x");
               expect_time(server, turned * to_the_front, kAway, ServerBench::kMotionTime);
             })),

    must("kinovazed.joystick.proportional", "Half the deflection leads half as far.",
         "server; reference 8.1"),
    in(kIdle, "200 for 4 s is undone by -400 for 2 s.",
       [](ServerBench& server) {
         for (std::size_t axis = 0; axis < 3; ++axis) {
           const auto even = way_back(server, kXyz, {{axis, 400, kPush}, {axis, -400, kPush}});
           const auto back = way_back(server, kXyz, {{axis, 200, 2 * kPush}, {axis, -400, kPush}});
           server.about(
               fmt::format("the way back after number {}, against 400 both ways", axis + 1));
           expect_time(server, back - even, -kAway - server.noise(), kAway + server.noise());
         }
       }),

    must("kinovazed.joystick.stopped-by-zeroes", "Three zeroes stop the arm that is steered.",
         "server; reference 8.1"),
    in(kIdle, "The way back from a rise does not grow in 4 s.",
       [](ServerBench& server) { expect_stopped_by(server, {{kStop}}); }),

    must("kinovazed.joystick.stopped-by-freeze", "Freeze stops the arm that is steered.",
         "document; server; reference 6.6"),
    in(kIdle, "The way back from a rise does not grow in 4 s.",
       [](ServerBench& server) { expect_stopped_by(server, {{"Freeze", Event::kFreezed}}); }),

    must("kinovazed.joystick.stopped-by-mode", "Each change of mode stops the arm that is steered.",
         "server; reference 6.6"),
    in(kIdle, "The way back from a rise does not grow in 4 s.",
       [](ServerBench& server) {
         expect_stopped_by(server, {{"SetJoystickMode:Rotation", Event::kJoystickModeSet},
                                    {"SetJoystickMode:Axis1to3", Event::kJoystickModeSet},
                                    {"SetJoystickMode:NoMode", Event::kJoystickModeSet}});
       }),

    must("kinovazed.joystick.stopped-by-estop",
         "EStop stops the arm that is steered, and Initialize does not take the deflection up "
         "again.",
         "document; server; reference 6.6"),
    in(kIdle, "Home is as far from the ready pose as ever.",
       [](ServerBench& server) {
         const auto usual = time_of(server, "Home");
         rise_from_home(server);
         server.pause(kPush);
         initialize_afresh(server);
         server.pause(3s);
         server.about("the way to Home after EStop and Initialize");
         expect_time(server, time_of(server, "Home"), usual - 400ms - server.noise(),
                     usual + 400ms + server.noise());
       }),

    unobservable(
        "no message tells where the arm is or how fast",
        must("kinovazed.joystick.scale",
             "Numbers are taken times 0.0025, x and y negated, and not clamped; 400 is full "
             "deflection.",
             "server; reference 8.1")),

    must("kinovazed.joystick.bounds",
         "A deflection in x or y that leads beyond 0.79 or 0.84 m counts as 0, in every mode, by "
         "the last pose inside the workspace; the reply stays Accepted.",
         "server, transcript S17"),
    variant("stops", in(kIdle, "A millimetre beyond, the wrist is not turned outwards.",
                        [](ServerBench& server) {
                          for (const auto& [axis, bound] : kBounds) {
                            for (const int side : {-1, 1}) {
                              turn_wrist(server, axis, side * (bound + kMillimetre), -400 * side);
                              expect_at_home(server);
                            }
                          }
                        })),
    variant("lets", in(kIdle, "A millimetre before it is, and inwards.",
                       [](ServerBench& server) {
                         for (const auto& [axis, bound] : kBounds) {
                           for (const int side : {-1, 1}) {
                             turn_wrist(server, axis, side * (bound - kMillimetre), -400 * side);
                             expect_elsewhere(server);
                             turn_wrist(server, axis, side * (bound + kMillimetre), 400 * side);
                             expect_elsewhere(server);
                           }
                         }
                       })),
    variant("outside", in(kIdle, "Outside the workspace what was before counts.",
                          [](ServerBench& server) {
                            auto place = kHomePlace;
                            for (const double before : {0.0, 0.795}) {
                              place[0] = before;
                              visit(server, place);
                              turn_wrist(server, 0, 0.9, -400);
                              if (before > 0) {
                                expect_at_home(server);
                              } else {
                                expect_elsewhere(server);
                              }
                            }
                          })),

    must("kinovazed.joystick.int-min", "The most negative number is not negated.",
         "server; reference 8.1", Profiles::kFirmware),
    in(kIdle, "In x and y it leads back what -400 has led away, in z it leads on.",
       [](ServerBench& server) {
         for (std::size_t axis = 0; axis < 3; ++axis) {
           server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
           visit(server, kHomePlace);
           let_go(server);
           server.accept(deflection(axis, -400));
           server.pause(1s);
           server.accept(deflection(axis, std::numeric_limits<int>::min()));
           server.pause(1s);
           server.accept(kStop);
           hold(server);
           if (axis < 2) {
             expect_at_home(server);
           } else {
             expect_elsewhere(server);
           }
         }
       }),

};

}  // namespace

Chapter joystick_chapter() { return chapter("Joystick", kJoystickClauses); }

}  // namespace armjig::kinovazed::conformance
