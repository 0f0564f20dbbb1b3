// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/arm_port.hpp"

namespace armjig::kinovazed::emulation {

bool ArmPort::attempt(ArmCall call) noexcept {
  if (!is_plugged_) return false;
  auto& failure = failures_[static_cast<std::size_t>(call)];
  if (failure.count == 0) return true;
  if (failure.skip > 0) {
    --failure.skip;
    return true;
  }
  if (failure.count > 0) --failure.count;
  return false;
}

bool ArmPort::call(Instant time, ArmCall call, ArmData& data) {
  if (!attempt(call)) return false;
  with_plant(time, [&](auto& plant) {
    switch (call) {
      case ArmCall::kTakeControl:
        return plant.take_control();
      case ArmCall::kReleaseControl:
        return plant.release_control();
      case ArmCall::kReadPosition:
        data.pose = plant.read_pose();
        return;
      case ArmCall::kReadStatus:
        data.mode = plant.mode();
        return;
      case ArmCall::kReadCurrent:
        data.current_sum = plant.current_sum();
        return;
      case ArmCall::kErase:
        return plant.erase();
      case ArmCall::kWriteAxes:
        return plant.move_stick(data.stick);
      case ArmCall::kReleaseStick:
        return plant.release_all();
      case ArmCall::kPressHome:
        return plant.press_home();
      case ArmCall::kWriteTarget:
        return plant.go_to(data.target);
      case ArmCall::kSelectCartesian:
        return plant.select(Control::kCartesian);
      case ArmCall::kSelectAngular:
        return plant.select(Control::kAngular);
      case ArmCall::kOpen:
      case ArmCall::kReadVelocity:
        return;
    }
  });
  return true;
}

}  // namespace armjig::kinovazed::emulation
