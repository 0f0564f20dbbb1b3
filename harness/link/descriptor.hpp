// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"

/// What the real ports are made of on POSIX systems.
namespace armjig {

/// Owns a file descriptor.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) noexcept : fd_{fd} {}
  Descriptor(Descriptor&& other) noexcept : fd_{std::exchange(other.fd_, -1)} {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  [[nodiscard]] int value() const noexcept { return fd_; }
  [[nodiscard]] bool is_open() const noexcept { return fd_ >= 0; }
  void close() noexcept;

 private:
  int fd_ = -1;
};

/// Monotonic time since it was made, as the time of a port.
class Stopwatch {
 public:
  [[nodiscard]] Instant now() const noexcept {
    return at(std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now() - start_));
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

enum class Readiness : std::uint8_t { kReadable, kWritable };

/// Waits until the descriptor is ready, or has an error to tell, but not beyond `deadline` on
/// `clock`. False: the deadline came first. Signals do not end the wait. Errors: `kSystem`.
[[nodiscard]] Result<bool> wait_for(const Descriptor& descriptor, Readiness readiness,
                                    const Stopwatch& clock, Instant deadline) noexcept;

/// Sends all of `bytes` on a connected socket. Requires non-blocking mode. Errors: `kTimedOut` if
/// nothing was taken for `patience`, `kDisconnected` with the errno, `kSystem`.
[[nodiscard]] Result<void> send_all(const Descriptor& socket, Bytes bytes, const Stopwatch& clock,
                                    Duration patience) noexcept;

/// The same for a terminal.
[[nodiscard]] Result<void> write_all(const Descriptor& terminal, Bytes bytes,
                                     const Stopwatch& clock, Duration patience) noexcept;

/// How long a peer may refuse to take bytes before a write gives up.
inline constexpr Duration kWritePatience = std::chrono::seconds{2};

}  // namespace armjig
