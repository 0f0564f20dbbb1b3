// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/link/descriptor.hpp"

namespace armjig {

/// Where a TCP server is.
struct TcpAddress {
  std::string host;  ///< a name or a number, without brackets
  std::string port;  ///< a number, 1 to 65535
};

/// Reads `HOST:PORT`; an IPv6 address stands in brackets. Problems: `kBadTarget`.
[[nodiscard]] Outcome<TcpAddress> parse_tcp_address(std::string_view text);

/// Connects without delay of small segments; the socket is non-blocking. Looking up a host name may
/// take longer than `patience`. Errors: `kNotFound` (no such host, no way to it), `kRefused`,
/// `kTimedOut`, `kSystem` with the errno.
[[nodiscard]] Result<Descriptor> connect_tcp(const TcpAddress& address, Duration patience);

}  // namespace armjig
