// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "harness/core/bytes.hpp"
#include "harness/link/descriptor.hpp"

/// The other side of TCP connections, so plain that a test sees every FIN and RST.
namespace armjig::testing {

/// A socket that listens on a free port of this machine and accepts only when told to.
class Listener {
 public:
  /// `backlog` as in listen(2).
  explicit Listener(int backlog = 8);

  /// `127.0.0.1:PORT`.
  [[nodiscard]] std::string address() const;
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

  /// Waits for a connection; blocking mode.
  [[nodiscard]] Descriptor accept() const;

 private:
  Descriptor socket_;
  std::uint16_t port_{};
};

/// Sends all of it.
void send_plain(const Descriptor& socket, Bytes bytes);
/// Reads until `size` bytes or the end.
[[nodiscard]] std::string receive_plain(const Descriptor& socket, std::size_t size);
/// Closes with a reset.
void close_with_reset(Descriptor& socket);

}  // namespace armjig::testing
