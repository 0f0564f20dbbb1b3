// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "harness/core/error.hpp"
#include "harness/link/serial_line.hpp"
#include "harness/link/stream_port.hpp"

namespace armjig {

/// Opens the serial port (CDC-ACM) of a USB device without a kernel driver: `VID:PID`,
/// `VID:PID:SERIAL` or its place `BUS-PORT.PORT`, each with `,BAUD` if need be; `usual` has what
/// that does not say. What came before is thrown away; DTR and RTS are on while it is open. A
/// kernel driver that has the port is sent away, and has it again afterwards, unless another
/// program uses it.
///
/// Its time is monotonic since opening. `write` hands bytes to queued transfers and gives up with
/// `kTimedOut` when the board takes nothing for two seconds; a board that is unplugged is
/// `kDisconnected`, after everything that it had sent was read. What was written is waited for
/// when it is closed.
///
/// Problems: those of `open_usb`, and `kUnsupported` (no such port, or not with that line),
/// `kDisconnected`.
[[nodiscard]] Outcome<std::unique_ptr<StreamPort>> open_usb_stream(const std::string& address,
                                                                   SerialLine usual = {});

}  // namespace armjig
