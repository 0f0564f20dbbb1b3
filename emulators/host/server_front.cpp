// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <utility>

#include "emulators/host/loop.hpp"
#include "emulators/host/tcp_listener.hpp"

namespace armjig {
namespace {

/// A client whose bytes the server leaves is not read any further.
constexpr std::size_t kMostUnreadOfClient = std::size_t{16} * 1024;
/// More clients than that wait in the kernel's backlog.
constexpr std::size_t kMostClients = 16;

/// TCP connections, each with its segments, half-close and reset.
class ServerFront final : public Front {
 public:
  ServerFront(Loop& loop, HostedServer& server) : loop_{loop}, server_{server} {}

  [[nodiscard]] Instant begin() override { return wait_until_listening(server_); }

  [[nodiscard]] Outcome<void> listen(const HostOptions& options) override {
    if (!options.tcp || options.pty) {
      return problem(ErrorCode::kBadValue, "host",
                     "a server has connections: it is on a TCP port and nowhere else");
    }
    return listen_on_tcp(
               loop_.context(), *options.tcp,
               {.on_client =
                    [this](const std::shared_ptr<TcpConnection>& client) { admit(client); },
                .has_room = [this] { return clients_.size() < kMostClients; },
                .on_log = [this](std::string_view line) { loop_.log(line); }})
        .map([this](auto listener) { listener_ = std::move(listener); });
  }

  void forward() override {
    TcpConnection* client = nullptr;  // of the event before: mostly there is only one
    ConnectionId id{};
    const auto flush = [&client] {
      if (client != nullptr) client->flush();
    };
    for (const auto& event : server_.sent()) {
      if (client == nullptr || id != event.connection) {
        flush();
        id = event.connection;
        const auto found = clients_.find(id);
        client = found == clients_.end() ? nullptr : found->second.get();
      }
      if (client == nullptr) continue;
      if (event.kind == SessionEvent::Kind::kData) {
        client->push(event.bytes);
        continue;
      }
      flush();
      client = nullptr;
      forget(id, event.kind == SessionEvent::Kind::kReset ? TcpConnection::Farewell::kReset
                                                          : TcpConnection::Farewell::kEnd);
    }
    flush();
    server_.clear_sent();
    // Whose bytes the server has read meanwhile may send on.
    for (const auto& [each, connection] : clients_) connection->read_on();
    // A server that is dead refuses connections, and one that has come back takes them again.
    if (listener_) listener_->set_listening(server_.is_listening());
  }

  [[nodiscard]] std::vector<std::string> targets() const override { return {listener_->target()}; }

  [[nodiscard]] LinkStatistics statistics() const override {
    auto sum = statistics_;
    for (const auto& [id, connection] : clients_) sum.frames_dropped += connection->dropped();
    return sum;
  }

 private:
  void admit(const std::shared_ptr<TcpConnection>& client) {
    const auto id = server_.connect(loop_.catch_up());
    if (!id) {
      ++statistics_.refused;
      return;
    }
    ++statistics_.clients;
    clients_[*id] = client;
    client->start(
        {.wants_bytes = [this, id = *id] { return server_.unread(id) < kMostUnreadOfClient; },
         .on_bytes =
             [this, id = *id](Bytes bytes) {
               server_.receive(loop_.catch_up(), id, bytes);
               loop_.pump();
             },
         .on_end = [this, id = *id](TcpConnection::End end) { on_end(id, end); }},
        statistics_);
    loop_.pump();
  }

  /// Nobody is told any more of a connection that was reset, so it is forgotten here.
  void on_end(ConnectionId id, TcpConnection::End end) {
    if (end == TcpConnection::End::kSending) {
      server_.half_close(loop_.catch_up(), id);
    } else {
      server_.reset(loop_.catch_up(), id);
      forget(id, TcpConnection::Farewell::kReset);
    }
    loop_.pump();
  }

  void forget(ConnectionId id, TcpConnection::Farewell farewell) {
    const auto found = clients_.find(id);
    found->second->close(farewell);
    statistics_.frames_dropped += found->second->dropped();
    clients_.erase(found);
  }

  Loop& loop_;
  HostedServer& server_;
  std::unique_ptr<TcpListener> listener_;
  std::map<ConnectionId, std::shared_ptr<TcpConnection>> clients_;
  LinkStatistics statistics_;
};

}  // namespace

std::unique_ptr<Front> make_front(Loop& loop, HostedServer& server) {
  return std::make_unique<ServerFront>(loop, server);
}

}  // namespace armjig
