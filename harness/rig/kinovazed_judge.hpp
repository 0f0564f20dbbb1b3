// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/rig/judge.hpp"

namespace armjig::kinovazed::rig {

/// Judges by words alone: whatever completes the word of a command counts as that command, wherever
/// it stands in a line and whatever the line is worth. So nothing slips past the shipped server's
/// reading of lines, which swallows bytes and keeps some for the next client. EStop is always
/// allowed; Initialize is homing; GetObjectivePosition may end the shipped server and changes state
/// therefore.
///
/// The arm may be moving from the first word that moves it, until two beats behind the last one
/// have shown a state of rest.
[[nodiscard]] std::unique_ptr<Judge> make_judge();

}  // namespace armjig::kinovazed::rig
