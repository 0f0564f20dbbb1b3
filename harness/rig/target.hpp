// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "harness/core/error.hpp"
#include "harness/link/stream_port.hpp"

namespace armjig {

/// `NAME=VALUE` pairs that describe an emulated device.
using DeviceOptions = std::map<std::string, std::string, std::less<>>;

/// Where a device is, as users write it everywhere:
///
///     emulated:?OPTION=VALUE&...   in this process, in virtual time
///     serial:/dev/ttyACM0[,BAUD]   a serial port; 3,000,000 baud if nothing else is said
///     usb:0483:5740                the serial port of the only USB device with that VID:PID
///     pty:/dev/pts/5               a pseudo-terminal, such as that of an emulator
///     tcp:HOST:PORT                a byte stream over TCP
struct Target {
  std::string text;  ///< as written
  std::string scheme;
  std::string address;
  DeviceOptions options;

  [[nodiscard]] bool is_emulated() const noexcept { return scheme == "emulated"; }
};

/// Problems: `kBadTarget`.
[[nodiscard]] Outcome<Target> parse_target(std::string_view text);

/// Makes the port of an emulated device from the target's options. Registered by whoever knows
/// emulators, which this room does not.
using OpenEmulated = Outcome<std::unique_ptr<StreamPort>> (*)(const Target& target);

/// Opens a byte stream to the target. Problems name the target and say what to do.
[[nodiscard]] Outcome<std::unique_ptr<StreamPort>> open_stream(const Target& target,
                                                               OpenEmulated open_emulated);

}  // namespace armjig
