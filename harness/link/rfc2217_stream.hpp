// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "harness/core/error.hpp"
#include "harness/link/serial_line.hpp"
#include "harness/link/stream_port.hpp"

namespace armjig {

/// The serial port of another machine over Telnet (RFC 2217), at `HOST:PORT` or `HOST:PORT,BAUD`;
/// `usual` has what that does not say. Within three seconds each it connects, and has every setting
/// acknowledged, DTR and RTS on among them. Otherwise as a stream on TCP.
/// Problems: those of `open_tcp_stream`, and `kTimedOut` or `kBadTarget` for a server without the
/// option or one that refuses a setting.
[[nodiscard]] Outcome<std::unique_ptr<StreamPort>> open_rfc2217(std::string_view address,
                                                                SerialLine usual = {});

/// The same on a connection that is open already.
[[nodiscard]] Outcome<std::unique_ptr<StreamPort>> speak_rfc2217(
    std::unique_ptr<StreamPort> connection, const SerialLine& line, std::string_view target);

}  // namespace armjig
