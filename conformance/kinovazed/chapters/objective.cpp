// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"
#include "conformance/kinovazed/fixture.hpp"
#include "conformance/kinovazed/tour.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum State;

void run(ServerBench& server, std::string_view objective) { (void)time_of(server, objective); }

template <Objective objective>
void runs(ServerBench& server) {
  run(server, to_string(objective));
  server.expect_beat(21);
}

/// Where such an objective ends depends on how near to its end Handle was stopped, and the last
/// points may be out of an arm's reach.
template <Objective objective>
void can_be_run(ServerBench& server) {
  run(server, "Handle");
  server.wait_until_before_beat(kBeforeBeat);
  server.accept("RunObjective:" + std::string{to_string(objective)});
  server.expect_beat(37);
}

/// The two way-points are 2 rad apart; no arm turns faster than 2.5 rad/s.
template <Objective objective>
void all_points(ServerBench& server) {
  run(server, to_string(objective));
  server.about("to the first point and back to the second");
  expect_time(server, time_of(server, to_string(objective)), 1300ms, 2 * ServerBench::kMotionTime);
}

/// How much longer the way back to Handle is after Handle than it should be.
Duration detour(ServerBench& server, std::string_view meanwhile) {
  run(server, "Handle");
  const auto usual = time_of(server, "Handle");
  run(server, "Home");
  server.accept("RunObjective:Handle");
  server.say(meanwhile);
  server.expect(Event::kObjectiveDone, 2 * ServerBench::kMotionTime);
  return time_of(server, "Handle") - usual;
}

constexpr auto kHijack = "SetActiveObjective:Antenna";

constexpr Duration kDetour = 600ms;

/// Home, where the arm has just been, replaces an objective that has just begun.
void expect_under_way_first(ServerBench& server) {
  run(server, "Home");
  const auto there = time_of(server, "SuckDoor");
  run(server, "Home");
  const auto said = server.now();
  server.accept("RunObjective:SuckDoor");
  server.say("SetActiveObjective:Home");
  const auto done = server.expect(Event::kObjectiveDone, 2 * ServerBench::kMotionTime);
  server.about("to SuckDoor, with Home made active on the way");
  expect_time(server, done.time - said, there - 200ms - server.noise(),
              2 * ServerBench::kMotionTime);
}

/// Shorter than any arm takes for the last 0.05 m.
constexpr Duration kStoppedFor = 80ms;

// Where way-points are, as reference 9.6 has them from the shipped arithmetic.
/// Near the ready pose, and far from all others.
constexpr Place kReadyPlace{0.212972, -0.271539, 0.491391, 1.519286, 1.047751, 0.062104};
constexpr Place kHandleEnd{0.081576, -0.689123, 0.628466, 1.482077, -0.134015, 0.007415};
constexpr std::array<Place, 1> kHomePoints{
    Place{0.048067, -0.330291, 0.472718, 1.712650, -0.139070, -0.113034}};
constexpr std::array kHandlePoints{
    Place{0.100440, -0.540117, 0.621585, 1.463947, -0.094030, 0.020215}, kHandleEnd};
constexpr std::array<Place, 1> kSuckDoorPoints{
    Place{-0.591887, -0.115275, 0.734826, 0.365464, -1.145810, 1.391800}};
constexpr std::array kAntennaPoints{
    Place{-0.249000, 0.173000, 0.968000, 0.936000, -0.900000, 2.146000},
    Place{-0.224850, 0.235005, 0.845014, -0.995730, -1.318464, 0.176478}};
constexpr std::array kPlaceBottlePoints{
    Place{-0.248000, 0.173000, 0.968000, 0.936000, -0.900000, 2.146000},
    Place{-0.223850, 0.235005, 0.845014, -0.995730, -1.318464, 0.176478}};
// Of relative ones without their first, which is where the hand is.
constexpr std::array kOpenDoorPoints{
    Place{0.211228, -0.274157, 0.499335, 1.467240, 1.037494, 0.820169},
    Place{0.025393, -0.201899, 0.500741, 1.307070, 1.229030, 0.847925},
    Place{0.016966, -0.231357, 0.485404, 1.377414, 1.109073, -1.357808},
    Place{0.012635, -0.238613, 0.568293, 1.395946, 1.096347, -1.385976},
    Place{0.020945, 0.035730, 0.516158, -1.196418, 1.472235, 2.658867},
    Place{0.266373, -0.110374, 0.302327, 1.549544, 1.264633, -0.088261}};
constexpr std::array kOpenDoorAtHandle{
    Place{0.078544, -0.688009, 0.636376, 1.454863, -0.142166, 0.716777},
    Place{0.075085, -0.488943, 0.625473, 1.421664, 0.057783, 0.597322},
    Place{0.044529, -0.493224, 0.610571, 1.422580, -0.065218, -1.543544},
    Place{0.036715, -0.486836, 0.693276, 1.428583, -0.079218, -1.554739},
    Place{0.293441, -0.394184, 0.633621, 1.471732, 0.479929, -0.098620},
    Place{0.249725, -0.689322, 0.437948, 1.503023, 0.082179, -0.114545}};
constexpr std::array kPullDoorAtHandle{
    Place{-0.327446, -0.368196, 0.516255, 2.991299, -1.333410, 1.421750},
    Place{-0.438910, -0.245446, 0.553590, -2.814398, -1.429396, 1.901671}};

// The same of relative ones as they lie to the hand (reference 9.3).
constexpr Place kHere{};
constexpr std::array kOpenDoorOffsets{kHere,
                                      Place{-0.003, 0.008, 0, -0.027, -0.008, 0.713},
                                      Place{-0.033, 0.015, -0.197, -0.060, 0.192, 0.598},
                                      Place{-0.063, 0, -0.190, -0.059, 0.069, -1.543},
                                      Place{-0.070, 0.083, -0.188, -0.053, 0.055, -1.555},
                                      Place{0.171, 0.030, -0.319, -0.006, 0.614, -0.106},
                                      Place{0.163, -0.191, -0.039, 0.023, 0.216, -0.125}};
constexpr std::array kPullDoorOffsets{kHere, Place{-0.450, -0.080, -0.272, 1.006, -1.298, 0.902},
                                      Place{-0.576, -0.031, -0.375, 1.013, -1.427, 0.919}};

constexpr Course kHome{"Home", kHomePoints, false};
constexpr Course kHandle{"Handle", kHandlePoints, false};
constexpr Course kSuckDoor{"SuckDoor", kSuckDoorPoints, false};
constexpr Course kAntenna{"Antenna", kAntennaPoints, false};
constexpr Course kFindBottle{"FindBottle", kAntennaPoints, false};
constexpr Course kPlaceBottle{"PlaceBottle", kPlaceBottlePoints, false};
constexpr Course kOpenDoor{"OpenDoor", kOpenDoorOffsets, true};
constexpr Course kPullDoor{"PullDoor", kPullDoorOffsets, true};

// Tours in which no objective has a part in more than half of the legs: it begins one and ends one.
// Eight legs of the one with doors have no part in any that is relative.
constexpr std::array kFixedTour{kHome,     kSuckDoor, kHandle, kAntenna, kHome,    kHandle,
                                kSuckDoor, kAntenna,  kHandle, kHome,    kAntenna, kSuckDoor};
constexpr std::array kDoorTour{kHandle,   kOpenDoor, kHome,     kHandle, kPullDoor,
                               kSuckDoor, kOpenDoor, kAntenna,  kHandle, kHome,
                               kPullDoor, kHandle,   kSuckDoor, kHome,   kAntenna,
                               kSuckDoor, kHandle,   kAntenna,  kHome,   kOpenDoor};
constexpr std::array kBottleTour{kHome, kFindBottle,  kSuckDoor, kPlaceBottle, kHandle, kFindBottle,
                                 kHome, kPlaceBottle, kSuckDoor, kHandle,      kHome};

template <const auto& courses>
void tour(ServerBench& server) {
  expect_tour(server, kReadyPlace, courses);
}

template <Objective objective, const auto& way_points, const Place& first>
void points(ServerBench& server) {
  expect_points(server, to_string(objective), first, way_points);
}

/// Current at `place` goes to `target`. The hand is led away before the server, which stops the arm
/// first, looks whether it is there.
void expect_current(ServerBench& server, const Place& place, const Place& target) {
  constexpr std::size_t kSideways = 0;
  constexpr double kAside = 0.2;      // m
  constexpr Duration kPauses = 40ms;  // three when it stops the arm, and the one before a poll
  const auto until_it_looks = kPauses + server.noise() - server.link_noise();
  server.begin_race();
  for (const double side : {-1.0, 1.0}) {
    visit(server, place);
    const auto said = server.now();
    server.say("RunObjective:Current");
    server.pause(20ms + server.noise());
    hold_at(server, kSideways, place[kSideways] + kAside);
    const bool is_in_time = server.now() - said <= until_it_looks;
    server.pause(look_time(server));
    server.expect(Event::kAccepted);
    if (!is_in_time) {
      return server.leave_open("whoever leads this arm takes longer than the server to look");
    }
    server.about("Current, with the hand led away");
    server.expect_quiet(200ms);
    visit(server, near(target, 0.94 * side));
    server.expect(Event::kObjectiveDone);
  }
}

/// Nothing but steering between two of Current.
void expect_current_behind_steering(ServerBench& server) {
  for (const auto* const way : {"MoveJoystick:0:0:400", "MoveJoystick:400:0:0"}) {
    const auto usual = time_of(server, "Current");
    server.about("Current");
    expect_time(server, usual, 0ms, 500ms + 2 * server.noise());
    server.perform("SetJoystickMode:XYZ", Event::kJoystickModeSet);
    server.accept(way);
    server.pause(2s);
    server.accept("MoveJoystick:0:0:0");
  }
  server.about("Current after steering");
  expect_time(server, time_of(server, "Current"), 0ms, 500ms + 2 * server.noise());
}

/// Antenna from its own end leads as far to its first point as from there back. Asked for again
/// soon after the first point, it has an eighth of the whole to that point, and the way back.
void expect_begun_anew(ServerBench& server) {
  run(server, "Antenna");
  const auto whole = time_of(server, "Antenna");
  const auto said = server.now();
  server.accept("RunObjective:Antenna");
  server.pause(said + whole * 5 / 8 - server.now());
  const auto again = time_of(server, "Antenna");
  server.about("Antenna, asked for again on the way to its second point");
  expect_time(server, again, whole / 2 - server.noise(), 2 * ServerBench::kMotionTime);
}

/// A relative objective has moved the hand away from where it began.
void expect_current_in_the_middle(ServerBench& server) {
  run(server, "Handle");
  server.accept("RunObjective:OpenDoor");
  server.pause(1500ms);
  server.about("Current in the middle of OpenDoor");
  expect_time(server, time_of(server, "Current"), 0ms, 500ms + 2 * server.noise());
}

/// What is called at the first way-point of an objective, and the beat that shows where it leads.
struct PointCalls {
  const Course& course;
  std::array<std::string_view, 4> made;
  int beat;
};
constexpr PointCalls kCallsBetween{
    kHandle, {kStopping[0], kStopping[1], kStopping[2], "target_write"}, 37};
constexpr PointCalls kCallsAtEnd{kHome, {kStopping[0], kStopping[1], kStopping[2]}, 21};

/// Each call fails once when the point is reached. One that is made there stops the arm.
template <const PointCalls& one>
void expect_calls_at_point(ServerBench& server) {
  for (const auto call : kAllCalls) {
    if (server.is_over()) return;
    const bool is_made = std::ranges::find(one.made, call) != one.made.end();
    const auto failure = fmt::format("arm.fail.{}", call);
    start_again(server);
    visit(server, kReadyPlace);
    server.accept(fmt::format("RunObjective:{}", one.course.objective));
    server.pause(look_time(server));
    server.touch(failure, 1);
    visit(server, one.course.points.front());
    server.about(fmt::format("{} fails at the first point of {}", call, one.course.objective));
    server.expect_beat(is_made ? 3 : one.beat);
    server.touch(failure, 0);
    let_go(server);
  }
}

constexpr Clause kObjectiveClauses[] = {
    must("kinovazed.objective.current",
         "Current is done at once, for it moves to where the arm is.",
         "document; server, recording objectives-current"),
    in(kIdle, "Within half a second, twice.",
       [](ServerBench& server) {
         for (const auto* before : {"Home", "SuckDoor"}) {
           run(server, before);
           server.about("Current");
           expect_time(server, time_of(server, "Current"), 0ms, 500ms + 2 * server.noise());
         }
       }),

    variant("steered",
            quick(in(kIdle, "Within half a second, after steering and no other objective.",
                     on<expect_current_behind_steering>))),

    variant("in-another", in(kIdle, "Within half a second, in the middle of OpenDoor.",
                             on<expect_current_in_the_middle>)),

    must("kinovazed.objective.begun-anew",
         "An objective that is asked for again while it runs begins at its first way-point.",
         "server; reference 9.2"),
    in(kIdle, "Antenna, on the way to its second point.", on<expect_begun_anew>),

    must("kinovazed.objective.calls",
         "At each way-point the arm is stopped as by any stop, and sent to the next one; a call of "
         "these that fails ends in emergencyStopped.",
         "server; reference 9.2 and 11.1"),
    variant("between", in(kIdle, "Nine calls fail between two points, four of them are made.",
                          on<expect_calls_at_point<kCallsBetween>>)),
    variant("end", in(kIdle, "Nine calls fail at the last point, three of them are made.",
                      on<expect_calls_at_point<kCallsAtEnd>>)),

    must("kinovazed.objective.home", "Home runs and is done.",
         "document; server, recording objectives-absolute"),
    in(kIdle, "ObjectiveDone, and beat 21.", on<runs<Objective::kHome>>),

    must("kinovazed.objective.handle", "Handle runs and is done.",
         "document; server, recording objectives-absolute"),
    quick(in(kIdle, "ObjectiveDone, and beat 21.", on<runs<Objective::kHandle>>)),

    must("kinovazed.objective.suck-door", "SuckDoor runs and is done.",
         "document; server, recording objectives-absolute"),
    in(kIdle, "ObjectiveDone, and beat 21.", on<runs<Objective::kSuckDoor>>),

    must("kinovazed.objective.antenna", "Antenna runs and is done.",
         "document; server; reference 9.3"),
    in(kIdle, "ObjectiveDone, and beat 21.", on<runs<Objective::kAntenna>>),

    must("kinovazed.objective.open-door", "OpenDoor can be run at the end of Handle.",
         "document; server; reference 9.6"),
    in(kIdle, "Beat 37.", on<can_be_run<Objective::kOpenDoor>>),

    must("kinovazed.objective.pull-door", "PullDoor can be run at the end of Handle.",
         "document; server; reference 9.6"),
    in(kIdle, "Beat 37.", on<can_be_run<Objective::kPullDoor>>),

    must("kinovazed.objective.find-bottle", "FindBottle runs and is done.", "server; reference 9.3",
         Profiles::kFirmware, "kinovazed.objective.seven"),
    in(kIdle, "ObjectiveDone, and beat 21.", on<runs<Objective::kFindBottle>>),

    must("kinovazed.objective.place-bottle", "PlaceBottle runs and is done.",
         "server; reference 9.3", Profiles::kFirmware, "kinovazed.objective.seven"),
    in(kIdle, "ObjectiveDone, and beat 21.", on<runs<Objective::kPlaceBottle>>),

    must("kinovazed.objective.seven", "FindBottle and PlaceBottle, which came later, are Rejected.",
         "document: seven objectives", Profiles::kDocumented, "kinovazed.objective.find-bottle"),
    in(kIdle, "Two are Rejected.",
       [](ServerBench& server) {
         server.refuse("RunObjective:FindBottle");
         server.refuse("RunObjective:PlaceBottle");
       }),

    must("kinovazed.objective.takes-its-time",
         "ObjectiveDone does not come before the arm can be near its target.",
         "server; reference 9.2"),
    /// 0.8 m; no arm is faster than 0.6 m/s.
    in(kIdle, "SuckDoor takes more than 1.2 s.",
       [](ServerBench& server) {
         expect_time(server, time_of(server, "SuckDoor"), 1200ms, 2 * ServerBench::kMotionTime);
       }),

    must("kinovazed.objective.reached",
         "An objective whose target is reached already is done at once.", "server; reference 9.2"),
    in(kIdle, "A second Home takes less than half a second.",
       [](ServerBench& server) {
         run(server, "Home");
         expect_time(server, time_of(server, "Home"), 0ms, 500ms + 2 * server.noise());
       }),

    must("kinovazed.objective.all-points", "Every way-point of an objective is visited, in order.",
         "server; reference 9.2"),
    quick(
        in(kIdle, "A second Antenna takes more than 1.3 s.", on<all_points<Objective::kAntenna>>)),

    must("kinovazed.objective.all-points-of-bottles",
         "Both way-points of FindBottle and of PlaceBottle are visited.", "server; reference 9.3",
         Profiles::kFirmware),
    variant("find", in(kIdle, "A second FindBottle takes more than 1.3 s.",
                       on<all_points<Objective::kFindBottle>>)),
    variant("place", in(kIdle, "A second PlaceBottle takes more than 1.3 s.",
                        on<all_points<Objective::kPlaceBottle>>)),

    must("kinovazed.objective.ways",
         "An objective takes as long as the way from where the arm is through its way-points, each "
         "of which is left where it counts as reached.",
         "server; reference 9.2, 9.3 and 9.5"),
    /// Told by an arm that goes straight at an even speed, which its own times show.
    variant("fixed", quick(in(kIdle, "Eleven legs between Home, Handle, SuckDoor and Antenna.",
                              on<tour<kFixedTour>>))),
    variant("doors", quick(in(kIdle, "Three of OpenDoor and two of PullDoor among others.",
                              on<tour<kDoorTour>>))),

    must("kinovazed.objective.ways-of-bottles",
         "FindBottle and PlaceBottle take as long as the way through their way-points.",
         "server; reference 9.2 and 9.3", Profiles::kFirmware),
    in(kIdle, "Two of each among others.", on<tour<kBottleTour>>),

    must("kinovazed.objective.stops-there",
         "The arm is stopped where its last way-point counts as reached.", "server; reference 9.2"),
    /// An arm that goes on is 0.05 m further away when the next objective comes later.
    in(kIdle, "SuckDoor takes as long right after Home as 3 s later.",
       [](ServerBench& server) {
         run(server, "SuckDoor");
         run(server, "Home");
         const auto at_once = time_of(server, "SuckDoor");
         run(server, "Home");
         server.pause(3s);
         const auto later = time_of(server, "SuckDoor");
         server.about("the difference that 3 s at Home make");
         expect_time(server, later - at_once, -kStoppedFor - server.noise(),
                     kStoppedFor + server.noise());
       }),

    must("kinovazed.objective.one-word", "Nothing is sent between the way-points of an objective.",
         "server, transcript T41"),
    in(kIdle, "One ObjectiveDone for the two points of Handle.",
       [](ServerBench& server) {
         run(server, "Handle");
         server.expect_quiet(1s);
       }),

    must("kinovazed.objective.ends-idle", "An objective that began in steering ends in idle.",
         "server, transcript T42"),
    in(kSteering, "ObjectiveDone, and beat 21.",
       [](ServerBench& server) {
         run(server, "Home");
         server.expect_beat(21);
       }),

    must("kinovazed.objective.hijack", "SetActiveObjective replaces the objective that runs.",
         "server, transcript S14", Profiles::kFirmware, "kinovazed.objective.no-hijack"),
    quick(in(kIdle, "After Handle the arm is not at its end.",
             [](ServerBench& server) {
               server.about("the way back after a run that was replaced");
               expect_time(server, detour(server, kHijack), kDetour, ServerBench::kMotionTime);
             })),
    variant("next", in(kIdle, "The way-point that is under way comes first, with Home meanwhile.",
                       on<expect_under_way_first>)),

    must("kinovazed.objective.no-hijack",
         "SetActiveObjective leaves the objective that runs alone.",
         "document: how-to; our reading", Profiles::kDocumented, "kinovazed.objective.hijack"),
    in(kIdle, "After Handle the arm is at its end.",
       [](ServerBench& server) {
         server.about("the way back after a run that was left alone");
         expect_time(server, detour(server, kHijack), -kDetour, kDetour);
       }),

    must("kinovazed.objective.near",
         "A way-point is reached within 0.05 m and 0.25 rad in each component; then the arm is "
         "stopped, and the next one sent.",
         "server; reference 9.2, 9.3 and 9.6"),
    variant("home", in(kIdle, "The one of Home, by an arm that is held.",
                       on<points<Objective::kHome, kHomePoints, kReadyPlace>>)),
    variant("handle", in(kIdle, "Both of Handle.",
                         on<points<Objective::kHandle, kHandlePoints, kReadyPlace>>)),
    variant("suck-door", in(kIdle, "The one of SuckDoor.",
                            on<points<Objective::kSuckDoor, kSuckDoorPoints, kReadyPlace>>)),
    variant("antenna", in(kIdle, "Both of Antenna.",
                          on<points<Objective::kAntenna, kAntennaPoints, kReadyPlace>>)),

    must("kinovazed.objective.near-bottles",
         "The way-points of FindBottle are those of Antenna; PlaceBottle's are a millimetre in x "
         "further.",
         "server; reference 9.3 and 9.6", Profiles::kFirmware),
    variant("find", in(kIdle, "Both of FindBottle, by an arm that is held.",
                       on<points<Objective::kFindBottle, kAntennaPoints, kReadyPlace>>)),
    variant("place", in(kIdle, "Both of PlaceBottle.",
                        on<points<Objective::kPlaceBottle, kPlaceBottlePoints, kReadyPlace>>)),

    must("kinovazed.objective.frame",
         "The way-points of OpenDoor and PullDoor lie in the frame of the hand when the command "
         "comes.",
         "server; reference 9.2, 9.5 and 9.6"),
    variant("open-door", in(kIdle, "Six of OpenDoor from the ready pose.",
                            on<points<Objective::kOpenDoor, kOpenDoorPoints, kReadyPlace>>)),
    variant("open-door-at-handle",
            in(kIdle, "Six of OpenDoor from the end of Handle.",
               on<points<Objective::kOpenDoor, kOpenDoorAtHandle, kHandleEnd>>)),
    variant("pull-door", in(kIdle, "Two of PullDoor from the end of Handle.",
                            on<points<Objective::kPullDoor, kPullDoorAtHandle, kHandleEnd>>)),

    must("kinovazed.objective.current-place",
         "The way-point of Current is where the hand was when the command came.",
         "server; reference 9.2", Profiles::kFirmware),
    in(kIdle, "Led away, Current is done when the hand is back.",
       [](ServerBench& server) {
         for (const auto& place : {kReadyPlace, kHandleEnd}) expect_current(server, place, place);
       }),

    must("kinovazed.objective.upright",
         "Where yaw is a right angle a target has roll 0, and the angles that are one axis there "
         "are its pitch: their sum, or at the negative one their difference.",
         "server; reference 9.5", Profiles::kFirmware),
    /// 1.5708 is what the server writes; single precision has the sine of 1.570796 as 1.
    in(kIdle, "Current at both, by an arm that is held.",
       [](ServerBench& server) {
         constexpr double kRight = 1.570796;
         expect_current(server, {0.3, -0.2, 0.5, 0.7, kRight, 0.5},
                        {0.3, -0.2, 0.5, 1.2, 1.5708, 0});
         expect_current(server, {0.3, -0.2, 0.5, 0.7, -kRight, 0.5},
                        {0.3, -0.2, 0.5, 0.2, -1.5708, 0});
       }),

    unobservable(
        "an arm that stands without any noise cannot be had on the wire",
        must("kinovazed.objective.still-arm",
             "Only a reading that differs from the one before by 0.00001 somewhere can reach a "
             "way-point.",
             "server, transcript S10", Profiles::kFirmware)),

    must("kinovazed.objective.no-wrap", "Angles are compared as plain numbers.",
         "server; reference 9.2"),
    in(kIdle, "A whole turn away is not there.",
       [](ServerBench& server) {
         constexpr double kTurn = 6.283185;
         visit(server, kReadyPlace);
         server.accept("RunObjective:Home");
         for (std::size_t angle = 3; angle < 6; ++angle) {
           for (const double turn : {-kTurn, kTurn}) {
             auto place = kHomePoints[0];
             place[angle] += turn;
             visit(server, place);
           }
         }
         server.expect_quiet(200ms);
         visit(server, kHomePoints[0]);
         server.expect(Event::kObjectiveDone);
       }),

    must("kinovazed.objective.no-timeout",
         "A target that is never reached ends by EStop, SetJoystickMode or another objective "
         "only.",
         "server; reference 9.2"),
    in(kIdle, "An arm that is held for two minutes, and then led there.",
       [](ServerBench& server) {
         visit(server, kReadyPlace);
         server.accept("RunObjective:Home");
         server.expect_quiet(2min);
         server.expect_beat(37);
         visit(server, kHomePoints[0]);
         server.expect(Event::kObjectiveDone);
       }),
};

}  // namespace

Chapter objective_chapter() { return chapter("Objectives", kObjectiveClauses); }

}  // namespace armjig::kinovazed::conformance
