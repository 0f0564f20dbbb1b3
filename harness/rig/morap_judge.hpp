// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/rig/judge.hpp"

namespace armjig::morap::rig {

/// Judges by what the shipped node would do at each byte, and refuses whatever makes its firmware
/// or that of the pen write to memory that is not theirs, divide by zero or hang, whatever the
/// permissions: surplus payload of floats, filters without coefficients, a rate of 0, tuning
/// without inertia, references and angles that are no finite number, surplus bytes for the pen,
/// reading it, and writes so long that a byte counter wraps.
///
/// A reference moves. So does calibration, unless this judge has seen the node disabled since the
/// last reference: one that was sent before is followed from then on. Programming and tuning need
/// permission to program if the node is known to stand, and to move otherwise. Writing to a device
/// that is neither node nor pen is taken for a change of its state.
[[nodiscard]] std::unique_ptr<Judge> make_judge();

}  // namespace armjig::morap::rig
