// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "harness/core/error.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/rig/direct_line.hpp"

namespace armjig {

/// Who receives looks about so often, whether to end.
inline constexpr Duration kLookAbout = std::chrono::milliseconds{100};

/// How requests leave and answers come. Between `send` and the `receive` that has the answer,
/// nothing else is done.
class Path {
 public:
  struct Arrival {
    std::size_t size{};               ///< 0: the deadline came first
    Instant time{};                   ///< when it was read
    std::optional<Instant> kernel{};  ///< when the kernel had it
  };

  Path() = default;
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;
  virtual ~Path() = default;

  [[nodiscard]] virtual Instant now() const = 0;
  /// Before a message is sent, outside of what is measured; what was not announced may be refused
  /// (`kForbidden`). Errors: those of sending it.
  [[nodiscard]] virtual Result<void> announce(Bytes /*message*/) { return {}; }
  /// What has come without being waited for, outside of what is measured.
  [[nodiscard]] virtual Result<Arrival> drain(std::span<std::byte> into) = 0;
  [[nodiscard]] virtual Result<void> send(Bytes message) = 0;
  /// The same beside what is measured, and how long after the call the kernel handed the message to
  /// the link. None: nobody tells.
  [[nodiscard]] virtual Result<std::optional<Duration>> time_send(Bytes message) {
    return send(message).map([] { return std::optional<Duration>{}; });
  }
  /// Waits until something comes, but not beyond `deadline`.
  [[nodiscard]] virtual Result<Arrival> receive(std::span<std::byte> into, Instant deadline) = 0;
  /// What `receive` had, outside of what is measured.
  virtual void overhear(Bytes /*bytes*/) {}
  /// What it is made of, for the report.
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
};

/// Through all layers of a port, which outlives it.
[[nodiscard]] std::unique_ptr<Path> path_through(StreamPort& port);

/// Plain poll, write and read on its file; on a socket recvmsg, with the time at which the kernel
/// had what came where it tells. The port and its guard are only asked outside of what is measured.
[[nodiscard]] std::unique_ptr<Path> path_on(StreamPort& port, const DirectLine& line);

}  // namespace armjig
