// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "harness/core/time.hpp"
#include "harness/wire/parol6/frame.hpp"

/// What the numbers in frames say.
namespace armjig::parol6 {

/// Drives joints until something ends it, if the board obeys.
[[nodiscard]] constexpr bool moves(Command command) noexcept {
  using enum Command;
  return command == kJog || command == kGoTo || command == kHome || command == kDemo;
}

/// Ends a homing that is under way. Idle does not.
[[nodiscard]] constexpr bool ends_homing(Command command) noexcept {
  using enum Command;
  return command == kEnable || command == kDisable || command == kClearError || command == kJog ||
         command == kGoTo;
}

/// What the gripper has between its fingers.
enum class GripperObject : std::uint8_t {
  kNone,          ///< it is moving, or told nothing yet
  kWhileClosing,  ///< stopped by something between the fingers
  kWhileOpening,  ///< stopped by something around them
  kAtPosition,    ///< reached its set-point
};

/// From `GripperReport::status`; the object byte of telemetry is a constant. The low bit of the two
/// comes first, which both known host programs get wrong.
[[nodiscard]] constexpr GripperObject object_of(std::uint8_t status) noexcept {
  const unsigned low = (status & gripper_status::kObjectLow) != 0 ? 1 : 0;
  const unsigned high = (status & gripper_status::kObjectHigh) != 0 ? 2 : 0;
  return GripperObject{static_cast<std::uint8_t>(low + high)};
}

/// The time between two accepted frames, as the board's timer has it, to the nanosecond below. It
/// wraps after 93.2 ms.
[[nodiscard]] constexpr Duration interval_of(std::uint16_t timing) noexcept {
  return Duration{std::int64_t{timing} * 1'000'000'000 / kTicksPerSecond};
}

[[nodiscard]] constexpr bool is_homed(const TelemetryFrame& frame, std::size_t joint) noexcept {
  return (frame.homed & flag(joint)) != 0;
}

/// `homed`: a flag byte as telemetry has it.
[[nodiscard]] constexpr bool are_all_homed(std::uint8_t homed) noexcept {
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    if ((homed & flag(joint)) == 0) return false;
  }
  return true;
}

[[nodiscard]] constexpr bool is_homed(const TelemetryFrame& frame) noexcept {
  return are_all_homed(frame.homed);
}

[[nodiscard]] constexpr bool is_estop_pressed(const TelemetryFrame& frame) noexcept {
  return (frame.io & io_flag::kEstopReleased) == 0;
}

}  // namespace armjig::parol6
