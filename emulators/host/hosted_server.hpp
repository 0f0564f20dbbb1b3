// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/kinovazed/defects/defective_server.hpp"

namespace armjig {

/// An emulated server that knows its connections, with its type forgotten, so that hosting is
/// compiled once. Times given never decrease; connections are numbered by the server.
class HostedServer {
 public:
  using ConnectionId = kinovazed::ConnectionId;
  using Event = kinovazed::ServerEvent;

  HostedServer() = default;
  HostedServer(const HostedServer&) = delete;
  HostedServer& operator=(const HostedServer&) = delete;
  virtual ~HostedServer() = default;

  /// False: connections are to be refused.
  [[nodiscard]] virtual bool is_listening() const = 0;
  [[nodiscard]] virtual std::optional<ConnectionId> connect(Instant time) = 0;
  virtual void receive(Instant time, ConnectionId id, Bytes segment) = 0;
  virtual void half_close(Instant time, ConnectionId id) = 0;
  /// The client has closed both directions.
  virtual void close(Instant time, ConnectionId id) = 0;
  virtual void reset(Instant time, ConnectionId id) = 0;
  /// Bytes of a client that the server has not read.
  [[nodiscard]] virtual std::size_t unread(ConnectionId id) const = 0;

  virtual void advance_to(Instant time) = 0;
  [[nodiscard]] virtual std::optional<Instant> next_event() const = 0;
  [[nodiscard]] virtual std::span<const Event> sent() const = 0;
  virtual void clear_sent() = 0;
  /// Does at the server's machine what no client can. False: nothing has that name and takes the
  /// value.
  [[nodiscard]] virtual bool set_input(Instant time, std::string_view name, std::int64_t value) = 0;
  /// What the server has written to its log since the last call.
  [[nodiscard]] virtual std::vector<std::string> take_log() = 0;
};

[[nodiscard]] std::unique_ptr<HostedServer> make_hosted_server(kinovazed::DefectiveServer server);

}  // namespace armjig
