// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/link/bus_port.hpp"
#include "harness/link/usb_control.hpp"

namespace armjig {

/// Opens an adapter of the i2c-tiny-usb family, without a kernel driver. `serial_number` is needed
/// only if there are several. The bus does whole transactions only.
///
/// Problems: those of `open_usb_control`, and `kUnsupported` if the device does not answer as such
/// an adapter does.
[[nodiscard]] Outcome<std::unique_ptr<BusPort>> open_i2c_tiny_usb(const std::string& serial_number);

/// The same over control transfers that are given. `where` is for problems.
[[nodiscard]] Outcome<std::unique_ptr<BusPort>> make_i2c_tiny_usb(std::unique_ptr<UsbControl> usb,
                                                                  const std::string& where);

}  // namespace armjig
