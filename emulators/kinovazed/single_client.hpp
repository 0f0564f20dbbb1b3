// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "emulators/kinovazed/server.hpp"

namespace armjig::kinovazed {

/// A server that listens, as its only client sees it: an `EmulatedServer`.
class SingleClient {
 public:
  /// Lets the server find its arm, which takes it a second at most unless there is none.
  explicit SingleClient(Server server);

  /// When the server began to listen; times given are not before.
  [[nodiscard]] Instant start() const noexcept { return start_; }

  /// False: nobody listens.
  bool connect(Instant time);
  void receive(Instant time, Bytes segment) { server_.receive(time, client_, segment); }
  void half_close(Instant time) { server_.half_close(time, client_); }
  void close(Instant time) { server_.close(time, client_); }
  void reset(Instant time) { server_.reset(time, client_); }
  void advance_to(Instant time);
  [[nodiscard]] std::optional<Instant> next_event() const noexcept { return server_.next_event(); }
  [[nodiscard]] std::span<const SessionEvent> sent() const noexcept { return sent_; }
  void clear_sent() noexcept { sent_.clear(); }

  [[nodiscard]] Server& server() noexcept { return server_; }

 private:
  Server server_;
  Instant start_{};
  ConnectionId client_{};
  std::vector<SessionEvent> sent_;
};

}  // namespace armjig::kinovazed
