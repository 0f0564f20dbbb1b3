// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "harness/core/error.hpp"
#include "harness/link/session_source.hpp"

namespace armjig {

/// Connections to the server at `HOST:PORT` (an IPv6 address in brackets). Nothing is connected
/// yet. Time is monotonic since making. Each `send` is one write without delay, hence one segment
/// while it is small and the server reads; it gives up with `kTimedOut` when the server takes
/// nothing for two seconds. After the server's end `receive` keeps saying `kEnd`: at once,
/// then when its deadline has come or a tenth of a second has passed. Problems: `kBadTarget`.
[[nodiscard]] Outcome<std::unique_ptr<SessionPort>> make_tcp_session(std::string_view address);

/// As many of them as are wanted. Problems: `kBadTarget`.
[[nodiscard]] Outcome<std::unique_ptr<SessionSource>> open_tcp_server(std::string_view address);

}  // namespace armjig
