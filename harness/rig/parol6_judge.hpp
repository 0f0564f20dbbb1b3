// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/rig/judge.hpp"
#include "harness/wire/parol6/joint_bounds.hpp"

namespace armjig::parol6::rig {

/// Judges by what the shipped board would accept, and by whatever looks like a frame to a board
/// that keeps to the document. Bounds of position need a homed arm: without it jog is bounded in
/// speed only, and go-to is refused, but for one that ends homing where the arm stands. Of go-to
/// frames it judges how fast one follows the other (GoToWay), and stops an arm that does not follow
/// them. While the emergency stop is pressed, or the board has been silent for half a second of
/// frames, nothing may move. The built-in demonstration goes to places, and the board's own disable
/// does not keep it back: it needs a homed arm, whose bounds it keeps, and is stopped as all that
/// moves (any other code stops it).
///
/// Not covered: a board whose homing another program began and then paused goes on homing at our
/// first idle frame, and the first frame of all sets outputs and gripper, as every frame does.
[[nodiscard]] std::unique_ptr<Judge> make_judge();

}  // namespace armjig::parol6::rig
