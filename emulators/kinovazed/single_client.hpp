// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "emulators/kinovazed/server.hpp"

namespace armjig::kinovazed {

/// A server that listens, as its only client sees it: an `EmulatedServer`. `AnyServer` is a
/// `Server` or what looks like one.
template <class AnyServer>
class SingleClient {
 public:
  /// Lets the server find its arm, which takes it a second at most unless there is none.
  explicit SingleClient(AnyServer server) : server_{std::move(server)} {
    constexpr auto kPatience = at(std::chrono::seconds{1});
    while (!server_.is_listening()) {
      const auto next = server_.next_event();
      if (!next || *next > kPatience) return;
      start_ = *next;
      server_.advance_to(start_);
    }
  }

  /// When the server began to listen; times given are not before.
  [[nodiscard]] Instant start() const noexcept { return start_; }

  /// False: nobody listens.
  bool connect(Instant time) {
    sent_.clear();
    server_.clear_sent();
    const auto client = server_.connect(time);
    if (client) client_ = *client;
    return client.has_value();
  }
  void receive(Instant time, Bytes segment) { server_.receive(time, client_, segment); }
  void half_close(Instant time) { server_.half_close(time, client_); }
  void close(Instant time) { server_.close(time, client_); }
  void reset(Instant time) { server_.reset(time, client_); }
  void advance_to(Instant time) {
    server_.advance_to(time);
    for (const auto& event : server_.sent()) {
      if (event.connection == client_) sent_.push_back({event.time, event.kind, event.bytes});
    }
    server_.clear_sent();
  }
  [[nodiscard]] std::optional<Instant> next_event() const noexcept { return server_.next_event(); }
  [[nodiscard]] std::span<const SessionEvent> sent() const noexcept { return sent_; }
  void clear_sent() noexcept { sent_.clear(); }

  [[nodiscard]] AnyServer& server() noexcept { return server_; }

 private:
  AnyServer server_;
  Instant start_{};
  ConnectionId client_{};
  std::vector<SessionEvent> sent_;
};

}  // namespace armjig::kinovazed
