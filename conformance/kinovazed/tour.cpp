// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/tour.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "conformance/kinovazed/ways.hpp"
#include "conformance/kinovazed/wording.hpp"

namespace armjig::kinovazed::conformance {
namespace {

using namespace std::chrono_literals;

/// How far a leg may be off the pace of the others: the server looks every 10 ms and five calls,
/// and the arm goes on meanwhile, at the beginning and at each way-point.
Duration slack(const ServerBench& server, Duration time) {
  return 40ms + 8 * server.noise() + time / 100;
}

/// How long it takes; none: a relative one that does not end, whose way-points may be out of this
/// arm's reach from here.
std::optional<Duration> time_of(ServerBench& server, const Course& course) {
  if (!course.is_relative) return time_of(server, course.objective);
  const auto said = server.now();
  const auto command = fmt::format("RunObjective:{}", course.objective);
  const auto word = server.event_of(command, Event::kObjectiveDone);
  if (!word) return std::nullopt;
  if (!word->is(Event::kObjectiveDone)) server.fail_by("ObjectiveDone", *word);
  return word->time - said;
}

/// Where the first one begins is not known exactly, nor where one does that comes after one without
/// an end.
std::vector<Leg> run_all(ServerBench& server, std::span<const Course> courses) {
  std::vector<Leg> legs;
  bool is_known = false;
  for (const auto& course : courses) {
    const auto time = time_of(server, course);
    if (server.is_over()) break;
    legs.push_back({course, time, is_known});
    is_known = time.has_value();
    if (!is_known) initialize_afresh(server);
  }
  return legs;
}

void expect_each(ServerBench& server, std::span<const Leg> legs) {
  for (const auto& [course, time, is_known] : legs) {
    const bool ends = std::ranges::any_of(legs, [&](const Leg& other) {
      return other.course.objective == course.objective && other.time;
    });
    server.about(fmt::format("{}, wherever it was run", course.objective));
    server.expect_true(ends, "ObjectiveDone", "none within 40 s, each time");
  }
}

/// Those whose ends do not depend on where the hand was.
std::vector<Leg> between_fixed_places(std::span<const Leg> legs) {
  std::vector<Leg> fixed{legs.begin(), legs.end()};
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const bool is_fixed =
        !legs[i].course.is_relative && (i == 0 || !legs[i - 1].course.is_relative);
    fixed[i].is_known = legs[i].is_known && is_fixed;
  }
  return fixed;
}

[[nodiscard]] std::ptrdiff_t count(std::span<const Leg> legs) {
  return std::ranges::count_if(legs, &Leg::counts);
}

[[nodiscard]] std::ptrdiff_t count_off_pace(const ServerBench& server, std::span<const Leg> legs,
                                            std::span<const Duration> due) {
  std::ptrdiff_t off = 0;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const bool is_on =
        std::chrono::abs(legs[i].time.value_or(due[i]) - due[i]) <= slack(server, due[i]);
    if (legs[i].counts() && !is_on) ++off;
  }
  return off;
}

/// What each should take at the pace that most have in common; if relative ones spoil it, at that
/// of the others. None: there is no such pace.
std::optional<std::vector<Duration>> due_times(const ServerBench& server, const Place& begin,
                                               std::span<const Leg> legs) {
  constexpr std::ptrdiff_t kEnough = 7;
  auto due = times_at(pace_of(begin, legs), begin, legs);
  if (2 * count_off_pace(server, legs, due) <= count(legs)) return due;
  const auto fixed = between_fixed_places(legs);
  auto due_by_fixed = times_at(pace_of(begin, fixed), begin, legs);
  const bool is_sure = count(fixed) >= kEnough && count_off_pace(server, fixed, due_by_fixed) <= 1;
  if (!is_sure) return std::nullopt;
  return due_by_fixed;
}

}  // namespace

void expect_tour(ServerBench& server, const Place& begin, std::span<const Course> courses) {
  const auto legs = run_all(server, courses);
  expect_each(server, legs);
  if (server.is_over()) return;
  const auto due = due_times(server, begin, legs);
  if (!due) {
    return server.skip("an arm that goes straight at an even speed, which its times do not show");
  }
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (!legs[i].counts()) continue;
    const auto time = (*due)[i];
    server.about(fmt::format("{} after {}, at the pace of the others", legs[i].course.objective,
                             legs[i - 1].course.objective));
    expect_time(server, *legs[i].time, time - slack(server, time), time + slack(server, time));
  }
}

}  // namespace armjig::kinovazed::conformance
