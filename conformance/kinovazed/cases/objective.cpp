// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/cases.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using enum emulation::State;

Heard run(ServerBench& server, std::string_view objective) {
  return server.perform("RunObjective:" + std::string{objective}, Event::kObjectiveDone,
                        2 * ServerBench::kMotionTime);
}

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

/// How long an objective takes, from its command on.
Duration time_of(ServerBench& server, std::string_view objective) {
  const auto said = server.now();
  return run(server, objective).time - said;
}

void current(ServerBench& server) {
  for (const auto* before : {"Home", "SuckDoor"}) {
    run(server, before);
    server.about("Current");
    expect_time(server, time_of(server, "Current"), 0ms, 500ms + server.noise());
  }
}

void seven(ServerBench& server) {
  server.refuse("RunObjective:FindBottle");
  server.refuse("RunObjective:PlaceBottle");
}

/// 0.8 m; no arm is faster than 0.6 m/s.
void takes_its_time(ServerBench& server) {
  expect_time(server, time_of(server, "SuckDoor"), 1200ms, 2 * ServerBench::kMotionTime);
}

void reached(ServerBench& server) {
  run(server, "Home");
  expect_time(server, time_of(server, "Home"), 0ms, 500ms + server.noise());
}

/// The two way-points are 2 rad apart; no arm turns faster than 2.5 rad/s.
template <Objective objective>
void all_points(ServerBench& server) {
  run(server, to_string(objective));
  server.about("to the first point and back to the second");
  expect_time(server, time_of(server, to_string(objective)), 1300ms, 2 * ServerBench::kMotionTime);
}

void one_word(ServerBench& server) {
  run(server, "Handle");
  server.expect_quiet(1s);
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

void hijack(ServerBench& server) {
  server.about("the way back behind a run that was replaced");
  expect_time(server, detour(server, kHijack), kDetour, ServerBench::kMotionTime);
}

void no_hijack(ServerBench& server) {
  server.about("the way back behind a run that was left alone");
  expect_time(server, detour(server, kHijack), -kDetour, kDetour);
}

void ends_idle(ServerBench& server) {
  run(server, "Home");
  server.expect_beat(21);
}

constexpr Case kCases[] = {
    in(kIdle, "kinovazed.objective.current", "Within half a second, twice.", on<current>),
    in(kIdle, "kinovazed.objective.home", "ObjectiveDone, and beat 21.",
       on<runs<Objective::kHome>>),
    in(kIdle, "kinovazed.objective.handle", "ObjectiveDone, and beat 21.",
       on<runs<Objective::kHandle>>),
    in(kIdle, "kinovazed.objective.suck-door", "ObjectiveDone, and beat 21.",
       on<runs<Objective::kSuckDoor>>),
    in(kIdle, "kinovazed.objective.antenna", "ObjectiveDone, and beat 21.",
       on<runs<Objective::kAntenna>>),
    in(kIdle, "kinovazed.objective.open-door", "Beat 37.", on<can_be_run<Objective::kOpenDoor>>),
    in(kIdle, "kinovazed.objective.pull-door", "Beat 37.", on<can_be_run<Objective::kPullDoor>>),
    in(kIdle, "kinovazed.objective.find-bottle", "ObjectiveDone, and beat 21.",
       on<runs<Objective::kFindBottle>>),
    in(kIdle, "kinovazed.objective.place-bottle", "ObjectiveDone, and beat 21.",
       on<runs<Objective::kPlaceBottle>>),
    in(kIdle, "kinovazed.objective.seven", "Two are Rejected.", on<seven>),
    in(kIdle, "kinovazed.objective.takes-its-time", "SuckDoor takes more than 1.2 s.",
       on<takes_its_time>),
    in(kIdle, "kinovazed.objective.reached", "A second Home takes less than half a second.",
       on<reached>),
    in(kIdle, "kinovazed.objective.all-points", "A second Antenna takes more than 1.3 s.",
       on<all_points<Objective::kAntenna>>),
    in(kIdle, "kinovazed.objective.all-points-of-bottles",
       "A second FindBottle takes more than 1.3 s.", on<all_points<Objective::kFindBottle>>,
       "find"),
    in(kIdle, "kinovazed.objective.all-points-of-bottles",
       "A second PlaceBottle takes more than 1.3 s.", on<all_points<Objective::kPlaceBottle>>,
       "place"),
    in(kIdle, "kinovazed.objective.one-word", "One ObjectiveDone for the two points of Handle.",
       on<one_word>),
    in(kSteering, "kinovazed.objective.ends-idle", "ObjectiveDone, and beat 21.", on<ends_idle>),
    in(kIdle, "kinovazed.objective.hijack", "Behind Handle the arm is not at its end.", on<hijack>),
    in(kIdle, "kinovazed.objective.no-hijack", "Behind Handle the arm is at its end.",
       on<no_hijack>),
};

}  // namespace

std::span<const Case> objective_cases() noexcept { return kCases; }

}  // namespace armjig::kinovazed::conformance
