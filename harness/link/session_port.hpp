// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/link/endpoint.hpp"

namespace armjig {

/// Connections to a server, as TCP has them: what a byte stream lacks is that they begin, end in
/// more than one way, and that what was written at once may matter as a segment. One connection at
/// a time; a second one needs a second port.
class SessionPort : public Endpoint {
 public:
  /// How reading ended.
  enum class Arrival : std::uint8_t {
    kData,      ///< `size` bytes
    kDeadline,  ///< nothing came in time
    kEnd,       ///< the server sends no more
    kReset,     ///< the server threw the connection away
  };
  struct Received {
    Arrival arrival{};
    std::size_t size{};
  };

  /// Begins a connection. Errors: `kRefused`, `kTimedOut`, `kBusy` (there is one already).
  [[nodiscard]] virtual Result<void> connect(Instant deadline) = 0;

  /// Sends one segment. Errors: `kDisconnected`.
  [[nodiscard]] virtual Result<void> send(Bytes segment) = 0;

  /// Waits for data, an end or the deadline. Errors: `kDisconnected` if there is no connection.
  [[nodiscard]] virtual Result<Received> receive(std::span<std::byte> into, Instant deadline) = 0;

  /// Sends no more, but still reads.
  virtual void half_close() = 0;
  /// Ends both directions in good order.
  virtual void close() = 0;
  /// Throws the connection away.
  virtual void reset() = 0;
};

}  // namespace armjig
