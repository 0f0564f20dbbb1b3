// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/link/endpoint.hpp"

namespace armjig {

/// A byte stream to a device: serial, USB CDC, pseudo-terminal, or an emulator in memory.
class StreamPort : public Endpoint {
 public:
  /// Hands over all of `bytes`. Errors: `kDisconnected`, `kTimedOut` (the other side does not
  /// take them), `kSystem` with the errno.
  [[nodiscard]] virtual Result<void> write(Bytes bytes) = 0;

  /// Waits until something has come, but not beyond `deadline`, and takes at most `into.size()`
  /// bytes of it. 0 bytes: the deadline came first. Errors as for `write`, without `kTimedOut`.
  [[nodiscard]] virtual Result<std::size_t> read(std::span<std::byte> into, Instant deadline) = 0;
};

}  // namespace armjig
