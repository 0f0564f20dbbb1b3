// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/plant.hpp"

#include "emulators/parol6/homing.hpp"

namespace armjig::parol6::emulation {

Level Axis::switch_level() const noexcept {
  const bool is_closed = [this] {
    switch (switch_state) {
      case SwitchState::kStuckClosed:
        return true;
      case SwitchState::kStuckOpen:
        return false;
      case SwitchState::kWorking:
        break;
    }
    return limit.side == LimitSwitch::Side::kAtOrBelow ? position <= limit.threshold
                                                       : position >= limit.threshold;
  }();
  return is_closed ? limit.closed_level : opposite(limit.closed_level);
}

std::uint32_t Axis::steps_until(Level level, std::int32_t direction) const noexcept {
  if (switch_level() == level) return 0;
  const bool can_change = switch_state == SwitchState::kWorking && !is_jammed;
  if (!can_change) return kNever;
  // The last position that reads the present level, and the first that reads the other one.
  const std::int32_t inward = limit.side == LimitSwitch::Side::kAtOrBelow ? -1 : 1;
  const bool moves_inward = direction == inward;
  const bool wants_closed = level == limit.closed_level;
  if (moves_inward != wants_closed) return kNever;
  const std::int64_t edge =
      wants_closed ? limit.threshold.value : std::int64_t{limit.threshold.value} - inward;
  return static_cast<std::uint32_t>((edge - position.value) * direction);
}

Plant standard_plant() noexcept {
  Plant plant;
  // The arm stands at its standby position, J6 a little off, so that homing has something to do.
  constexpr Steps kBeside{1000};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& homing = kHomingTable[j];
    plant.axes[j].position = kStandby[j] + (j + 1 == kJointCount ? kBeside : Steps{});
    plant.axes[j].limit = {
        .threshold = homing.standby - homing.standby_from_switch,
        .side = homing.seek_speed > StepRate{} ? LimitSwitch::Side::kAtOrAbove
                                               : LimitSwitch::Side::kAtOrBelow,
        .closed_level = homing.pressed_level,
    };
  }
  return plant;
}

}  // namespace armjig::parol6::emulation
