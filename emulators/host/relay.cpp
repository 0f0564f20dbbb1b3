// SPDX-License-Identifier: Apache-2.0
#include "emulators/host/relay.hpp"

#include <sys/epoll.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <map>
#include <utility>
#include <vector>

#include "emulators/host/client_link.hpp"
#include "harness/link/descriptor.hpp"

namespace armjig {
namespace {

constexpr Duration kConnectPatience = std::chrono::seconds{2};

using Wall = std::chrono::steady_clock;

/// What both kinds have. `Event` is what they send.
template <class Kind, class Event>
class Relay : public Kind {
 public:
  explicit Relay(RelayStatistics& statistics) : statistics_{statistics} {}

  void advance_to(Instant /*time*/) override {}
  [[nodiscard]] std::optional<Instant> next_event() const override { return std::nullopt; }
  [[nodiscard]] bool set_input(Instant /*time*/, std::string_view /*name*/,
                               std::int64_t /*value*/) override {
    return false;
  }
  void overlook(Instant from, Instant to) override {
    ++statistics_.overlooks;
    statistics_.overlooked += to - from;
  }
  [[nodiscard]] bool is_gone() const override { return statistics_.failure.has_value(); }
  [[nodiscard]] std::span<const Event> sent() const override { return sent_; }
  void clear_sent() override {
    for (const auto came : std::exchange(came_, {})) note_held(came);
    sent_.clear();
  }

 protected:
  void send(Event event) {
    came_.push_back(Wall::now());
    sent_.push_back(std::move(event));
  }

  /// Hands a piece to the device.
  template <class Do>
  void pass(Do do_it) {
    const auto came = Wall::now();
    do_it();
    note_held(came);
  }

  void fail_with(const Error& error) {
    if (!statistics_.failure) statistics_.failure = error;
  }

 private:
  void note_held(Wall::time_point came) {
    const auto held = std::chrono::duration_cast<Duration>(Wall::now() - came);
    ++statistics_.pieces;
    statistics_.held += held;
    statistics_.longest_held = std::max(statistics_.longest_held, held);
  }

  RelayStatistics& statistics_;
  std::vector<Event> sent_;
  std::vector<Wall::time_point> came_;  ///< of those in `sent_`
};

class StreamRelay final : public Relay<HostedStream, SentBytes> {
 public:
  StreamRelay(std::unique_ptr<StreamPort> port, RelayStatistics& statistics)
      : Relay{statistics}, port_{std::move(port)} {}

  void receive(Instant /*time*/, Bytes bytes) override {
    pass([&] {
      if (const auto written = port_->write(bytes); !written) fail_with(written.error());
    });
  }

  [[nodiscard]] std::optional<int> wakes_by() const override {
    const auto file = port_->lifeline();
    return file ? std::optional{file->descriptor} : std::nullopt;
  }

  void wake(Instant time) override {
    std::array<std::byte, kReadTurn> buffer;
    const auto size = port_->read(buffer, port_->now());
    if (!size) return fail_with(size.error());
    if (*size == 0) return;
    send({time, {buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(*size)}});
  }

 private:
  std::unique_ptr<StreamPort> port_;
};

class ServerRelay final : public Relay<HostedServer, ServerEvent> {
 public:
  ServerRelay(std::unique_ptr<SessionSource> server, Descriptor ready, RelayStatistics& statistics)
      : Relay{statistics}, server_{std::move(server)}, ready_{std::move(ready)} {}

  [[nodiscard]] bool is_listening() const override { return true; }

  [[nodiscard]] std::optional<ConnectionId> connect(Instant /*time*/) override {
    auto port = server_->make_port();
    if (!port->connect(port->now() + kConnectPatience)) {
      log_.emplace_back("the server refused a connection, so its program was refused");
      return std::nullopt;
    }
    const auto id = next_++;
    const auto file = port->lifeline();
    epoll_event event{.events = EPOLLIN | EPOLLRDHUP, .data = {.u32 = id}};
    if (file) ::epoll_ctl(ready_.value(), EPOLL_CTL_ADD, file->descriptor, &event);
    ports_[id] = std::move(port);
    return id;
  }

  void receive(Instant /*time*/, ConnectionId id, Bytes segment) override {
    // What became of a connection that takes nothing, reading tells.
    with(id, [&](SessionPort& port) { pass([&] { (void)port.send(segment); }); });
  }
  void half_close(Instant /*time*/, ConnectionId id) override {
    with(id, [](SessionPort& port) { port.half_close(); });
  }
  void close(Instant /*time*/, ConnectionId id) override {
    with(id, [](SessionPort& port) { port.close(); });
    ports_.erase(id);
  }
  void reset(Instant /*time*/, ConnectionId id) override {
    with(id, [](SessionPort& port) { port.reset(); });
    ports_.erase(id);
  }
  [[nodiscard]] std::size_t unread(ConnectionId /*id*/) const override { return 0; }

  [[nodiscard]] std::optional<int> wakes_by() const override { return ready_.value(); }

  void wake(Instant time) override {
    std::array<epoll_event, 16> events{};
    const int count = ::epoll_wait(ready_.value(), events.data(), events.size(), 0);
    for (int i = 0; i < count; ++i) {
      const ConnectionId id = events.at(static_cast<std::size_t>(i)).data.u32;
      with(id, [&](SessionPort& port) { read(time, id, port); });
    }
  }

  [[nodiscard]] std::vector<std::string> take_log() override { return std::exchange(log_, {}); }

 private:
  template <class Use>
  void with(ConnectionId id, Use use) {
    if (const auto found = ports_.find(id); found != ports_.end()) use(*found->second);
  }

  void read(Instant time, ConnectionId id, SessionPort& port) {
    std::array<std::byte, kReadTurn> buffer;
    const auto got = port.receive(buffer, port.now());
    using Arrival = SessionPort::Arrival;
    if (got && got->arrival == Arrival::kDeadline) return;
    if (got && got->arrival == Arrival::kData) {
      const auto end = buffer.begin() + static_cast<std::ptrdiff_t>(got->size);
      return send({time, id, SessionEvent::Kind::kData, {buffer.begin(), end}});
    }
    const bool is_end = got && got->arrival == Arrival::kEnd;
    send({time, id, is_end ? SessionEvent::Kind::kEnd : SessionEvent::Kind::kReset, {}});
    ports_.erase(id);
  }

  std::unique_ptr<SessionSource> server_;
  Descriptor ready_;  ///< readable when a connection is
  std::map<ConnectionId, std::unique_ptr<SessionPort>> ports_;
  ConnectionId next_ = 0;
  std::vector<std::string> log_;
};

}  // namespace

std::unique_ptr<HostedStream> relay(std::unique_ptr<StreamPort> port, RelayStatistics& statistics) {
  return std::make_unique<StreamRelay>(std::move(port), statistics);
}

Result<std::unique_ptr<HostedServer>> relay(std::unique_ptr<SessionSource> server,
                                            RelayStatistics& statistics) {
  Descriptor ready{::epoll_create1(EPOLL_CLOEXEC)};
  if (!ready.is_open()) return fail(ErrorCode::kSystem, errno);
  return std::make_unique<ServerRelay>(std::move(server), std::move(ready), statistics);
}

}  // namespace armjig
