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

}  // namespace armjig::kinovazed::emulation
