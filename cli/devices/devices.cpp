// SPDX-License-Identifier: Apache-2.0
#include "cli/devices/devices.hpp"

#include <array>

namespace armjig::cli {

Devices shipped_devices() {
  static const std::array kDevices{parol6::device(), kinovazed::device(), morap::device(),
                                   demo::device()};
  return kDevices;
}

}  // namespace armjig::cli
