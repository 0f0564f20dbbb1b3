// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/emulation.hpp"
#include "harness/core/time.hpp"

namespace armjig::kinovazed::emulation {

/// The sockets of a server that takes one client at a time: those of clients that wait, the one
/// that is served, and what the kernel keeps for each.
class Connections {
 public:
  // The clients' side. Numbers that are not known (any more) are passed over.
  ConnectionId connect();
  void receive(ConnectionId id, Bytes bytes);
  void half_close(ConnectionId id);
  void close(ConnectionId id);
  /// True if it is this client's turn, or was going to be, and it has not heard anything yet.
  bool reset(ConnectionId id);
  /// Bytes that the server has not read.
  [[nodiscard]] std::size_t unread(ConnectionId id) const noexcept;

  // The server's side.
  enum class Accepted : std::uint8_t { kServed, kWasReset };
  [[nodiscard]] bool has_waiting() const noexcept { return !waiting_.empty(); }
  [[nodiscard]] bool is_serving() const noexcept { return served_.has_value(); }
  /// Serves the client that has waited longest. Requires one, and that nobody is served.
  Accepted accept();
  /// Whether reading would give bytes or an end now.
  [[nodiscard]] bool is_readable() const noexcept;
  /// Nothing more will come from the client that is served.
  [[nodiscard]] bool is_at_end() const noexcept;
  /// The next bytes, at most as many as fit; valid until the next `receive`.
  [[nodiscard]] Bytes read(std::size_t most);
  /// False: the socket is not connected any more.
  [[nodiscard]] bool write(Instant time, std::string_view text);
  /// Ends the connection that is served.
  void drop(Instant time);
  /// Ends all; those that wait are reset.
  void drop_all(Instant time);

  [[nodiscard]] std::span<const ServerEvent> sent() const noexcept {
    return std::span{sent_}.first(sent_count_);
  }
  void clear_sent() noexcept { sent_count_ = 0; }

 private:
  struct Client {
    ConnectionId id{};
    std::vector<std::byte> inbox;
    std::size_t taken = 0;  ///< of `inbox`
    bool has_ended = false;
    bool is_gone = false;  ///< closed: it answers the next write with a reset
    bool has_reset = false;
    bool was_told = false;  ///< anything
  };
  [[nodiscard]] Client* find(ConnectionId id) noexcept;
  void tell(Instant time, const Client& client, SessionEvent::Kind kind);
  void add(Instant time, ConnectionId id, SessionEvent::Kind kind, Bytes bytes);

  ConnectionId next_id_ = 0;
  std::optional<Client> served_;
  std::deque<Client> waiting_;
  std::vector<ServerEvent> sent_;  ///< and behind them some whose memory is used again
  std::size_t sent_count_ = 0;
};

}  // namespace armjig::kinovazed::emulation
