// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace armjig {

/// What targets begin with.
inline constexpr std::array<std::string_view, 8> kTargetSchemes{
    "emulated:", "serial:", "usb:", "pty:", "tcp:", "rfc2217:", "i2c:", "i2c-tiny-usb:"};

}  // namespace armjig
