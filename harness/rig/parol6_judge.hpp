// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "harness/core/quantity.hpp"
#include "harness/rig/guard.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6 {

/// How far and how fast a joint may be driven.
struct JointBounds {
  Steps lower{};
  Steps upper{};
  StepsPerSecond max_speed{};  ///< of go-to set-points
  StepsPerSecond max_jog{};
};

/// The vendor GUI's figures, in robot coordinates, which the counters have after homing.
inline constexpr std::array<JointBounds, kJointCount> kJointBounds{{
    {Steps{-14000}, Steps{14000}, StepsPerSecond{6500}, StepsPerSecond{1500}},
    {Steps{-51558}, Steps{-1200}, StepsPerSecond{18000}, StepsPerSecond{3000}},
    {Steps{34699}, Steps{92604}, StepsPerSecond{20000}, StepsPerSecond{3600}},
    {Steps{-7500}, Steps{7500}, StepsPerSecond{22000}, StepsPerSecond{7000}},
    {Steps{-6400}, Steps{6400}, StepsPerSecond{22000}, StepsPerSecond{7000}},
    {Steps{0}, Steps{64000}, StepsPerSecond{22000}, StepsPerSecond{18000}},
}};

/// Judges by what the shipped board would accept, and by whatever looks like a frame to a board
/// that keeps to the document. Bounds of position need a homed arm: without it go-to is refused,
/// and jog is bounded in speed only. While the emergency stop is pressed, or the board has been
/// silent for half a second of frames, nothing may move. The built-in demonstration ignores the
/// board's own disable and is always refused.
///
/// Not covered: a board whose homing another program began and then paused goes on homing at our
/// first idle frame, and the first frame of all sets outputs and gripper, as every frame does.
[[nodiscard]] std::unique_ptr<Judge> make_judge();

}  // namespace armjig::parol6
