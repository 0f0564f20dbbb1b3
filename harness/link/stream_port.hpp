// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// A byte stream to a device: serial, USB CDC, pseudo-terminal, or an emulator in memory. Time is
/// the port's own: virtual for one in memory, where waiting costs nothing, monotonic since opening
/// for a real one. For one thread at a time.
class StreamPort {
 public:
  StreamPort() = default;
  StreamPort(const StreamPort&) = delete;
  StreamPort& operator=(const StreamPort&) = delete;
  virtual ~StreamPort() = default;

  /// Hands over all of `bytes`. Errors: `kDisconnected`, `kTimedOut` (the other side does not
  /// take them), `kSystem` with the errno.
  [[nodiscard]] virtual Result<void> write(Bytes bytes) = 0;

  /// Waits until something has come, but not beyond `deadline`, and takes at most `into.size()`
  /// bytes of it. 0 bytes: the deadline came first. Errors as for `write`, without `kTimedOut`.
  [[nodiscard]] virtual Result<std::size_t> read(std::span<std::byte> into, Instant deadline) = 0;

  [[nodiscard]] virtual Instant now() const = 0;

  /// The file descriptor behind a real port, for what has to outlive this process; none in memory.
  [[nodiscard]] virtual std::optional<int> descriptor() const { return std::nullopt; }

  /// Does at the device what its link cannot: sets a switch or an input, turns its power off and
  /// on. Names and values are the device's own. False: there is no such input, or nobody who could.
  [[nodiscard]] virtual bool touch(std::string_view input, std::int64_t value) {
    (void)input;
    (void)value;
    return false;
  }
};

}  // namespace armjig
