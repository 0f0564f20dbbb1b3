// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "harness/core/quantity.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::emulation {

enum class Level : std::uint8_t { kLow, kHigh };

[[nodiscard]] constexpr Level opposite(Level level) noexcept {
  return level == Level::kLow ? Level::kHigh : Level::kLow;
}

/// The limit switch of one joint: closed while the physical position is on that side of the
/// threshold.
struct LimitSwitch {
  enum class Side : std::uint8_t { kAtOrBelow, kAtOrAbove };

  Steps threshold{};
  Side side = Side::kAtOrBelow;
  Level closed_level = Level::kLow;

  friend bool operator==(const LimitSwitch&, const LimitSwitch&) = default;
};

/// What turns behind one step output. The board sees of it only the switch.
struct Axis {
  enum class SwitchState : std::uint8_t { kWorking, kStuckClosed, kStuckOpen };

  Steps position{};  ///< physical; the board's counter is another number
  LimitSwitch limit{};
  SwitchState switch_state = SwitchState::kWorking;
  bool is_jammed = false;  ///< pulses move the counter, but not the axis

  /// The level on the board's input.
  [[nodiscard]] Level switch_level() const noexcept;

  /// The least number of steps in that direction (+1, -1) after which the input reads `level`;
  /// `kNever` if it never does.
  [[nodiscard]] std::uint32_t steps_until(Level level, std::int32_t direction) const noexcept;
  static constexpr std::uint32_t kNever = UINT32_MAX;

  /// Net step pulses, positive forward. The position wraps as the board's counter does.
  void pulse(std::int32_t steps) noexcept {
    if (is_jammed) return;
    position = Steps{static_cast<std::int32_t>(static_cast<std::uint32_t>(position.value) +
                                               static_cast<std::uint32_t>(steps))};
  }

  friend bool operator==(const Axis&, const Axis&) = default;
};

/// The external inputs of the board.
struct Inputs {
  Level in1 = Level::kLow;
  Level in2 = Level::kLow;
  Level estop = Level::kHigh;  ///< high is released

  friend bool operator==(const Inputs&, const Inputs&) = default;
};

/// Everything around the board that is not on the serial link or the gripper's CAN.
struct Plant {
  std::array<Axis, kJointCount> axes{};
  Inputs inputs{};

  friend bool operator==(const Plant&, const Plant&) = default;
};

/// An arm as it comes out of the box: switches where the vendor's homing expects them, standing
/// near its standby position (docs/spec/parol6.md, "Homing").
[[nodiscard]] Plant standard_plant() noexcept;

}  // namespace armjig::parol6::emulation
