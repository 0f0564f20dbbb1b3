// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "conformance/kinovazed/route.hpp"
#include "conformance/kinovazed/server_bench.hpp"

/// An arm whose hand somebody holds and puts to places: what no message tells, the server's
/// reaction to a place does. Cases with it are skipped where nobody can do that.
namespace armjig::kinovazed::conformance {

/// The hand stays where it is, whatever the server asks for, until it is let go or the case is
/// over.
void hold(ServerBench& server);
void let_go(ServerBench& server);

/// In which a server has looked at its arm: it does every 10 ms and five calls, and stopping the
/// arm before takes three pauses of 10 ms.
[[nodiscard]] Duration look_time(const ServerBench& server);

/// The calls of a stop, by the names of the inputs that let them fail, behind `arm.fail.`.
inline constexpr std::array<std::string_view, 3> kStopping{
    "trajectory_erase", "joystick_axes_write", "joystick_release"};
/// All that a command may make.
inline constexpr std::array<std::string_view, 9> kAllCalls{
    "take_control",        "release_control",       "trajectory_erase",
    "joystick_axes_write", "joystick_release",      "home_button_press",
    "target_write",        "cartesian_mode_select", "angular_mode_select"};

/// Puts the hand there and holds it. The server may not have looked at the arm yet.
void hold_at(ServerBench& server, const Place& place);
/// The same of one component, from 0; the others stay.
void hold_at(ServerBench& server, std::size_t component, double value);

/// The hand is held there for as long as the server needs to look, and to send the next way-point.
void visit(ServerBench& server, const Place& place);

/// `place` with all components `share` of the reach away from it, every other one to the other
/// side.
[[nodiscard]] Place near(const Place& place, double share);

/// Runs an objective by hand. Each of `points` is reached where it should be and not a little
/// further away in any component, either way; those before and behind do not stand for it. `first`
/// is where the command is given.
void expect_points(ServerBench& server, std::string_view objective, const Place& first,
                   std::span<const Place> points);

}  // namespace armjig::kinovazed::conformance
