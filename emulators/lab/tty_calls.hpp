// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "emulators/lab/client_memory.hpp"

namespace armjig::lab {

/// What a pseudo-terminal lacks of a serial port.
struct SerialLines {
  std::atomic<int> modem;           ///< as of TIOCMGET
  std::atomic<std::uint32_t> baud;  ///< as set last by TCSETS2; 0: nobody has
};

/// Answers what programs ask of a device node of a USB serial port that leads to a pseudo-terminal:
/// modem lines, as Linux has them of CDC-ACM while the port is open, and hands on everything else
/// to the terminal. `lines` must outlive it.
[[nodiscard]] GObjectRef<UMockdevIoctlBase> answer_tty_calls(SerialLines& lines);

}  // namespace armjig::lab
