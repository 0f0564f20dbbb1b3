// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/error.hpp"
#include "harness/core/option.hpp"

namespace armjig {

/// Where a device is, as users write it everywhere:
///
///     emulated:?OPTION=VALUE&...   in this process, in virtual time
///     serial:/dev/ttyACM0[,BAUD]   a serial port; the device's usual speed if none is said
///     serial:0483:5740[:SERIAL]    that which the system has made of the only such USB device
///     usb:0483:5740[:SERIAL]       the only such USB device, without the system's driver
///     usb:1-2.3                    the one in that place: bus, port, port of a hub
///     pty:/dev/pts/5               a pseudo-terminal, such as that of an emulator
///     tcp:HOST:PORT                a byte stream over TCP, or a server
///     rfc2217:HOST:PORT[,BAUD]     a serial port of another machine over Telnet
///     i2c:/dev/i2c-1               an I2C bus of Linux
///     i2c-tiny-usb:[SERIAL]        the only adapter of that kind, or the one with that number
struct Target {
  std::string text;  ///< as written
  std::string scheme;
  std::string address;
  DeviceOptions options;

  [[nodiscard]] bool is_emulated() const noexcept { return scheme == "emulated"; }
};

/// Problems: `kBadTarget`.
[[nodiscard]] Outcome<Target> parse_target(std::string_view text);

/// What a target is refused with.
[[nodiscard]] tl::unexpected<Problem> bad_target(std::string_view text, std::string_view hint);
/// What something is refused with that begins like no target.
[[nodiscard]] tl::unexpected<Problem> no_target(std::string_view text);

}  // namespace armjig
