// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

#include "conformance/kinovazed/cases.hpp"

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

/// How much longer the way back to Handle is behind Handle than it should be.
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

/// Shorter than any arm takes for the last 0.05 m.
constexpr Duration kStoppedFor = 80ms;

constexpr Clause kObjectiveClauses[] = {
    must("kinovazed.objective.current",
         "Current is done at once, for it moves to where the arm is.",
         "document; server, recording objectives-current"),
    in(kIdle, "Within half a second, twice.",
       [](ServerBench& server) {
         for (const auto* before : {"Home", "SuckDoor"}) {
           run(server, before);
           server.about("Current");
           expect_time(server, time_of(server, "Current"), 0ms, 500ms + server.noise());
         }
       }),

    must("kinovazed.objective.home", "Home runs and is done.",
         "document; server, recording objectives-absolute"),
    in(kIdle, "ObjectiveDone, and beat 21.", on<runs<Objective::kHome>>),

    must("kinovazed.objective.handle", "Handle runs and is done.",
         "document; server, recording objectives-absolute"),
    in(kIdle, "ObjectiveDone, and beat 21.", on<runs<Objective::kHandle>>),

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
         expect_time(server, time_of(server, "Home"), 0ms, 500ms + server.noise());
       }),

    must("kinovazed.objective.all-points", "Every way-point of an objective is visited, in order.",
         "server; reference 9.2"),
    in(kIdle, "A second Antenna takes more than 1.3 s.", on<all_points<Objective::kAntenna>>),

    must("kinovazed.objective.all-points-of-bottles",
         "Both way-points of FindBottle and of PlaceBottle are visited.", "server; reference 9.3",
         Profiles::kFirmware),
    variant("find", in(kIdle, "A second FindBottle takes more than 1.3 s.",
                       on<all_points<Objective::kFindBottle>>)),
    variant("place", in(kIdle, "A second PlaceBottle takes more than 1.3 s.",
                        on<all_points<Objective::kPlaceBottle>>)),

    must("kinovazed.objective.stops-there",
         "The arm is stopped where its last way-point counts as reached.", "server; reference 9.2"),
    /// An arm that goes on is 0.05 m further away when the next objective comes later.
    in(kIdle, "SuckDoor takes as long right behind Home as 3 s later.",
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
    in(kIdle, "Behind Handle the arm is not at its end.",
       [](ServerBench& server) {
         server.about("the way back behind a run that was replaced");
         expect_time(server, detour(server, kHijack), kDetour, ServerBench::kMotionTime);
       }),

    must("kinovazed.objective.no-hijack",
         "SetActiveObjective leaves the objective that runs alone.",
         "document: how-to; our reading", Profiles::kDocumented, "kinovazed.objective.hijack"),
    in(kIdle, "Behind Handle the arm is at its end.",
       [](ServerBench& server) {
         server.about("the way back behind a run that was left alone");
         expect_time(server, detour(server, kHijack), -kDetour, kDetour);
       }),

    unobservable(
        "no message tells where the arm is",
        must("kinovazed.objective.near",
             "A way-point is reached within 0.05 m and 0.25 rad in each component; then the arm is "
             "stopped, and the next one sent.",
             "server; reference 9.2")),

    unobservable(
        "an arm that stands without any noise cannot be had on the wire",
        must("kinovazed.objective.still-arm",
             "Only a reading that differs from the one before by 0.00001 somewhere can reach a "
             "way-point.",
             "server, transcript S10", Profiles::kFirmware)),

    unobservable("no published objective ends at the seam",
                 must("kinovazed.objective.no-wrap", "Angles are compared as plain numbers.",
                      "server; reference 9.2")),

    unobservable(
        "there is no limit of time after which one would know",
        must("kinovazed.objective.no-timeout",
             "A target that is never reached ends by EStop, SetJoystickMode or another objective "
             "only.",
             "server; reference 9.2")),
};

}  // namespace

Chapter objective_chapter() { return chapter("Objectives", kObjectiveClauses); }

}  // namespace armjig::kinovazed::conformance
