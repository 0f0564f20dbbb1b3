// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/wire/parol6/splitter.hpp"

namespace armjig::parol6::emulation {

/// In what boards that speak the protocol differ: one named choice for each difference between the
/// shipped board and the one that the document promises (docs/spec/parol6.md, "Profiles and
/// differences"). The defaults are the shipped board.
struct BoardProfile {
  /// Which check bytes are taken (parol6.frame.check-ignored).
  CheckPolicy check = CheckPolicy::kIgnore;
  /// Takes frames of 52 bytes only, and loses none behind garbage (parol6.receive.resync).
  bool resynchronises = false;
  /// Gives each frame of a burst a pass of its own (parol6.loop.last-of-burst).
  bool acts_on_each_frame = false;
  /// Stops the joints after the silence that the timeout byte names, and reports it
  /// (parol6.command.sticky).
  bool minds_silence = false;
  /// Idle frames set all speeds to 0 instead of the commanded ones (parol6.telemetry.idle-speed).
  bool rests_when_idle = false;
  /// A home command that is held homes once (parol6.home.held).
  bool homes_once = false;
  /// What interrupts homing ends it, and the next one begins as the first
  /// (parol6.home.interrupted).
  bool homes_afresh = false;
  /// Code 69 has a meaning (parol6.demo).
  bool has_demo = true;
  /// Set-points that come with a calibration or clear-error are sent when the mode is 0 again
  /// (parol6.gripper.forgotten-set-point).
  bool remembers_set_points = false;
  /// Keeps the gripper's current within 0 to 1300 mA (parol6.gripper.current-range).
  bool bounds_current = false;
  /// Telemetry says which gripper was commanded, at which speed, and what it holds
  /// (parol6.telemetry.gripper-id).
  bool reports_gripper = false;
  /// Telemetry says which joints of a homed arm left their range, until clear error
  /// (parol6.telemetry.position-error).
  bool reports_position_errors = false;
  /// Speeds are bounded by the GUI's table instead of 50,000 steps/s (parol6.jog.clamp).
  bool bounds_speeds = false;
  /// A pressed emergency stop disables, and nothing enables while it is pressed
  /// (parol6.io.estop-reported).
  bool disables_at_estop = false;
  /// Jog and go-to do not drive a joint of a homed arm out of its range.
  bool stops_at_bounds = false;

  friend bool operator==(const BoardProfile&, const BoardProfile&) = default;
};

inline constexpr BoardProfile kFirmwareBoard{};

inline constexpr BoardProfile kDocumentedBoard{
    .check = CheckPolicy::kBoardOnly,
    .resynchronises = true,
    .acts_on_each_frame = true,
    .minds_silence = true,
    .rests_when_idle = true,
    .homes_once = true,
    .homes_afresh = true,
    .has_demo = false,
    .remembers_set_points = true,
    .bounds_current = true,
    .reports_gripper = true,
    .reports_position_errors = true,
    .bounds_speeds = true,
    .disables_at_estop = true,
    .stops_at_bounds = false,
};

}  // namespace armjig::parol6::emulation
