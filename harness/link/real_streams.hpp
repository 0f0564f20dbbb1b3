// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/link/serial_line.hpp"
#include "harness/link/stream_port.hpp"

/// Byte streams that leave the process. Their time is monotonic since opening; `write` gives up
/// with `kTimedOut` when the other side takes nothing for two seconds; the end of the other side is
/// `kDisconnected`, after everything that it had sent was read.
namespace armjig {

/// A pseudo-terminal or other terminal, in raw mode, its line set as far as it can be: a
/// pseudo-terminal knows neither parity nor speeds that have no name. What came before it was
/// opened is thrown away. The port is locked with flock(2), as other serial programs do, so that
/// only one of them has it; not with TIOCEXCL, which would outlive us on a pseudo-terminal.
/// Its settings are put back in the end, as `TerminalSettings` says. A terminal on which somebody
/// works is refused: it is `kBusy`.
/// Problems: `kNotFound`, `kNoPermission`, `kBusy`, `kBadTarget` (not a terminal), `kDisconnected`,
/// `kSystem`.
[[nodiscard]] Outcome<std::unique_ptr<StreamPort>> open_pty(const std::string& path,
                                                            SerialLine line = {});

/// A connection to `HOST:PORT` (an IPv6 address in brackets) as a byte stream: an emulator on TCP,
/// a serial-to-network box. Waits at most three seconds for the connection. Problems: `kBadTarget`,
/// `kNotFound`, `kRefused`, `kTimedOut`, `kSystem`.
[[nodiscard]] Outcome<std::unique_ptr<StreamPort>> open_tcp_stream(std::string_view address);

}  // namespace armjig
