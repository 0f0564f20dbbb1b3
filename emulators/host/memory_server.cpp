// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/memory_server.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <utility>

namespace armjig {
namespace {

using ConnectionId = HostedServer::ConnectionId;
using Event = HostedServer::Event;

/// The server, its time, and what has arrived at each client.
struct Wire {
  /// The server looks for its arm before it listens; nobody shall have to wait for that.
  explicit Wire(std::unique_ptr<HostedServer> hosted) : server{std::move(hosted)} {
    constexpr auto kPatience = at(std::chrono::seconds{1});
    for (auto next = server->next_event(); !server->is_listening() && next && *next <= kPatience;
         next = server->next_event()) {
      advance_to(*next);
    }
  }

  void advance_to(Instant time) {
    now = std::max(now, time);
    server->advance_to(now);
    for (const auto& event : server->sent()) arrived[event.connection].push_back(event);
    server->clear_sent();
  }

  std::unique_ptr<HostedServer> server;
  Instant now{};
  std::map<ConnectionId, std::deque<Event>> arrived;
};

class MemoryPort final : public SessionPort {
 public:
  explicit MemoryPort(Wire& wire) : wire_{wire} {}
  ~MemoryPort() override { close(); }

  Result<void> connect(Instant /*deadline*/) override {
    if (id_) return fail(ErrorCode::kBusy);
    id_ = wire_.server->connect(wire_.now);
    if (!id_) return fail(ErrorCode::kRefused);
    return {};
  }

  Result<void> send(Bytes segment) override {
    if (!id_) return fail(ErrorCode::kDisconnected);
    wire_.server->receive(wire_.now, *id_, segment);
    return {};
  }

  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    if (!id_) return fail(ErrorCode::kDisconnected);
    auto& arrived = wire_.arrived[*id_];
    wire_.advance_to(wire_.now);
    while (arrived.empty()) {
      const auto event = wire_.server->next_event();
      const bool is_due = event && *event <= deadline;
      wire_.advance_to(is_due ? *event : deadline);
      if (!is_due && arrived.empty()) return Received{Arrival::kDeadline, 0};
    }
    return next(arrived, into);
  }

  void half_close() override {
    if (id_) wire_.server->half_close(wire_.now, *id_);
  }
  void close() override {
    if (id_) wire_.server->close(wire_.now, *id_);
    forget();
  }
  void reset() override {
    if (id_) wire_.server->reset(wire_.now, *id_);
    forget();
  }

  [[nodiscard]] Instant now() const override { return wire_.now; }

 private:
  Received next(std::deque<Event>& arrived, std::span<std::byte> into) {
    auto& event = arrived.front();
    if (event.kind == SessionEvent::Kind::kEnd) return {Arrival::kEnd, 0};
    if (event.kind == SessionEvent::Kind::kReset) {
      forget();
      return {Arrival::kReset, 0};
    }
    const auto taken = std::min(into.size(), event.bytes.size());
    std::copy_n(event.bytes.begin(), taken, into.begin());
    event.bytes.erase(event.bytes.begin(),
                      event.bytes.begin() + static_cast<std::ptrdiff_t>(taken));
    if (event.bytes.empty()) arrived.pop_front();
    return {Arrival::kData, taken};
  }

  void forget() {
    if (id_) wire_.arrived.erase(*id_);
    id_.reset();
  }

  Wire& wire_;
  std::optional<ConnectionId> id_;
};

class MemoryServer final : public SessionSource {
 public:
  explicit MemoryServer(std::unique_ptr<HostedServer> server) : wire_{std::move(server)} {}

  std::unique_ptr<SessionPort> make_port() override { return std::make_unique<MemoryPort>(wire_); }
  [[nodiscard]] Instant now() const override { return wire_.now; }
  void pause(Duration duration) override { wire_.advance_to(wire_.now + duration); }
  bool touch(std::string_view input, std::int64_t value) override {
    return wire_.server->set_input(wire_.now, input, value);
  }

 private:
  Wire wire_;
};

}  // namespace

std::unique_ptr<SessionSource> make_memory_server(std::unique_ptr<HostedServer> server) {
  return std::make_unique<MemoryServer>(std::move(server));
}

}  // namespace armjig
