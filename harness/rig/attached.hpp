// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "harness/link/serial_stream.hpp"

/// What is plugged into this machine, in the terms of targets.
namespace armjig {

/// A device that can be told by the USB numbers of its serial port. They may be those of its chip's
/// maker; then other boards look like it.
struct KnownBoard {
  std::string_view device;
  UsbId usb;
};

/// The device that a port looks like; empty if it looks like none.
[[nodiscard]] std::string_view device_behind(const SerialPort& port,
                                             std::span<const KnownBoard> boards) noexcept;

/// Whether it is the port of a board that is meant; `place` is not looked at.
[[nodiscard]] bool is_meant(const SerialPort& port, const UsbChoice& choice);

/// What `--target` takes for it.
[[nodiscard]] std::string target_of(const SerialPort& port);

/// For people: maker, product, serial number as far as they are known, else the description.
[[nodiscard]] std::string describe(const SerialPort& port);

enum class FileAccess : std::uint8_t { kAllowed, kDenied };

/// Whether this process may read and write the file at `path`; it is not opened.
[[nodiscard]] FileAccess access_to(const std::string& path) noexcept;

}  // namespace armjig
