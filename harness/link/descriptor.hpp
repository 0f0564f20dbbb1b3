// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/link/stream_port.hpp"

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

/// The same of one that somebody else owns, by any clock: `left()` is how long there is left.
/// Without `readiness` it is ready when there is an error to tell.
[[nodiscard]] Result<bool> wait_for(int descriptor, std::optional<Readiness> readiness,
                                    const std::function<Duration()>& left) noexcept;

/// Sends all of `bytes` on a connected socket. Requires non-blocking mode. Errors: `kTimedOut` if
/// nothing was taken for `patience`, `kDisconnected` with the errno, `kSystem`.
[[nodiscard]] Result<void> send_all(const Descriptor& socket, Bytes bytes, const Stopwatch& clock,
                                    Duration patience) noexcept;

/// The same for a terminal.
[[nodiscard]] Result<void> write_all(const Descriptor& terminal, Bytes bytes,
                                     const Stopwatch& clock, Duration patience) noexcept;

/// How long a peer may refuse to take bytes before a write gives up.
inline constexpr Duration kWritePatience = std::chrono::seconds{2};

/// What a terminal or a socket would take, as far as it goes; what came is thrown away, else the
/// answers pile up.
void send_last(int descriptor, Bytes message) noexcept;

/// Opens a terminal in non-blocking mode and locks it with flock(2), as other serial programs do.
/// Errors: `kBadTarget` if it is none, and those of errno.
[[nodiscard]] Result<Descriptor> open_terminal(const std::string& path) noexcept;

/// What a user can do about a file that cannot be opened.
struct OpenHints {
  std::string absent;
  std::string not_allowed;
  std::string busy;
  std::string gone;
  std::string wrong_kind;
};
[[nodiscard]] tl::unexpected<Problem> problem_of_open(const std::string& path, const Error& error,
                                                      const OpenHints& hints);

/// A terminal or a socket in non-blocking mode; they differ only in how bytes are written.
class DescriptorStream final : public StreamPort {
 public:
  using Put = Result<void> (*)(const Descriptor&, Bytes, const Stopwatch&, Duration) noexcept;

  DescriptorStream(Descriptor descriptor, Put put) noexcept
      : descriptor_{std::move(descriptor)}, put_{put} {}

  Result<void> write(Bytes bytes) override;
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override;
  [[nodiscard]] Instant now() const override { return clock_.now(); }
  [[nodiscard]] std::optional<Lifeline> lifeline() const override {
    return Lifeline{descriptor_.value(), send_last};
  }

 private:
  Descriptor descriptor_;
  Put put_;
  Stopwatch clock_;
};

}  // namespace armjig
