// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "harness/core/time.hpp"

/// Ways of an arm that nobody looks at: how far it goes until each way-point counts as reached, and
/// what that takes an arm that goes straight at an even speed. No message tells where an arm is;
/// how long objectives take does.
namespace armjig::kinovazed::conformance {

/// Metres, then radians: x, y, z, pitch, yaw, roll, as the server compares them.
using Place = std::array<double, 6>;

/// Within that a way-point counts as reached, in metres and radians (kinovazed.objective.near).
inline constexpr double kReachMetres = 0.05;
inline constexpr double kReachRadians = 0.25;

/// The reach of one component, from 0.
[[nodiscard]] constexpr double reach_of(std::size_t component) noexcept {
  return component < 3 ? kReachMetres : kReachRadians;
}

/// Where a place lies that `frame` has at `offset` (docs/spec/kinovazed.md, "Objectives"). Angles
/// are within half a turn.
[[nodiscard]] Place in_frame(const Place& frame, const Place& offset) noexcept;

/// Where an objective leads.
struct Course {
  std::string_view objective;
  std::span<const Place> points;
  bool is_relative;  ///< to the hand when the command comes
};

/// How fast an arm goes, and what a server adds to each way-point.
struct Pace {
  double metres_per_second;
  double radians_per_second;
  double seconds_beyond;     ///< the arm goes on after a way-point counts as reached
  double seconds_per_point;  ///< in which it does not, or stands
};

/// An objective that was run.
struct Leg {
  Course course;
  std::optional<Duration>
      time;              ///< none: it did not end, and the arm was put back to the beginning
  bool is_known = true;  ///< whether it began where the one before ended

  /// Whether its time tells anything.
  [[nodiscard]] bool counts() const noexcept { return time && is_known; }
};

/// What each of them takes at this pace, one after the other from `begin` on. Each ends a little
/// before its last way-point, so that the next one begins there.
[[nodiscard]] std::vector<Duration> times_at(const Pace& pace, const Place& begin,
                                             std::span<const Leg> legs);

/// The pace that most of the legs have whose beginning is known: the few that do not fit at all
/// hardly move it. From 0.02 to 2 m/s and 0.1 to 7 rad/s.
[[nodiscard]] Pace pace_of(const Place& begin, std::span<const Leg> legs);

}  // namespace armjig::kinovazed::conformance
