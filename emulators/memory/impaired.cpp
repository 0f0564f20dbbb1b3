// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/impaired.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "emulators/memory/hosted_around.hpp"
#include "harness/link/emulated_bus_port.hpp"
#include "harness/link/impaired_bus.hpp"
#include "harness/link/impaired_path.hpp"
#include "harness/link/random_source.hpp"

namespace armjig {
namespace {

using End = ImpairedPath::End;

constexpr std::size_t kMostOnTheWay = std::size_t{1} << 20;

std::optional<Instant> first_of(std::optional<Instant> a, std::optional<Instant> b) noexcept {
  return a && b ? std::min(*a, *b) : (a ? a : b);
}

/// Whom a program must not outrun: 0 unless too much is on its way.
std::size_t too_much_on(const ImpairedPath& path) noexcept {
  const auto& s = path.statistics();
  const auto left = s.bytes_out + s.bytes_lost + s.bytes_cut_off;
  const auto size = s.bytes_in + s.bytes_doubled - left;
  return size > kMostOnTheWay ? static_cast<std::size_t>(size) : 0;
}

/// A device, and what is on its way to it and from it. `Links` knows the ways.
template <class HostedType, class Links>
class BehindLinks : public hosted_by::SenderAround<HostedType> {
 public:
  BehindLinks(std::unique_ptr<HostedType> device, const Impairment& impairment)
      : hosted_by::SenderAround<HostedType>{std::move(device)}, links_{impairment} {}

 protected:
  [[nodiscard]] Links& links() noexcept { return links_; }
  [[nodiscard]] const Links& links() const noexcept { return links_; }

  template <class Work>
  auto act(Instant time, Work work) {
    carry_to(time);
    return hosted_by::do_then([&] { return work(time); }, [this] { settle(); });
  }
  [[nodiscard]] std::optional<Instant> next_on_links() const {
    return first_of(this->device().next_event(), links_.next_due(reached_));
  }

 private:
  /// From one arrival or event to the next, because each answer begins its way when it is sent.
  void carry_to(Instant time) {
    for (auto next = next_on_links(); next && *next <= time; next = next_on_links()) {
      lead_to(*next);
    }
    lead_to(time);
  }
  void lead_to(Instant time) {
    reached_ = std::max(reached_, time);
    this->device().advance_to(reached_);
    settle();
  }
  void settle() {
    links_.deliver_out(reached_, this->device());
    this->take_sent([this](const auto& sent) { links_.push_in(sent, this->sent_); });
    links_.deliver_in(reached_, this->device(), this->sent_);
  }

  Links links_;
  Instant reached_{};
};

/// The two ways of a stream.
class StreamWays {
 public:
  explicit StreamWays(const Impairment& impairment) : paths_{impairment} {}

  void push_out(Instant time, Bytes bytes) { paths_.out.push(time, bytes); }
  [[nodiscard]] std::size_t too_much() const noexcept { return too_much_on(paths_.out); }
  [[nodiscard]] std::optional<Instant> next_due(Instant now) const noexcept {
    return first_of(paths_.out.next_due(now), paths_.in.next_due(now));
  }
  void deliver_out(Instant now, HostedStream& device) {
    while (const auto delivery = paths_.out.pop(now)) device.receive(now, delivery->bytes);
  }
  void push_in(const SentBytes& sent, std::vector<SentBytes>& /*sent_now*/) {
    paths_.in.push(sent.time, sent.bytes);
  }
  void deliver_in(Instant now, HostedStream& /*device*/, std::vector<SentBytes>& sent_now) {
    while (auto delivery = paths_.in.pop(now)) {
      sent_now.push_back({delivery->due, std::move(delivery->bytes)});
    }
  }

 private:
  ImpairedPaths paths_;
};

class ImpairedStreamDevice final : public hosted_by::Stream<BehindLinks<HostedStream, StreamWays>> {
 public:
  using Stream::Stream;

  void receive(Instant time, Bytes bytes) override {
    act(time, [&](Instant now) { links().push_out(now, bytes); });
  }
  [[nodiscard]] std::optional<Instant> next_event() const override { return next_on_links(); }
  [[nodiscard]] std::size_t unread() const override {
    return device().unread() + links().too_much();
  }
};

/// The ways of each connection.
class ServerWays {
 public:
  explicit ServerWays(const Impairment& impairment)
      : impairment_{impairment}, seeds_{impairment.seed} {}

  void begin(ConnectionId id) {
    auto own = impairment_;
    own.seed = seeds_.fork(id).next();
    ways_.try_emplace(id, own);
  }
  void push_out(Instant time, ConnectionId id, Bytes bytes) {
    if (auto* way = find(id)) way->paths.out.push(time, bytes);
  }
  void half_close(Instant time, ConnectionId id) {
    if (auto* way = find(id)) way->paths.out.close(time);
  }
  /// Hands over at once what is on its way out.
  void close(Instant time, ConnectionId id, HostedServer& server) {
    if (auto* way = find(id)) deliver(time, Instant::max(), id, *way, server);
    ways_.erase(id);
  }
  void forget(ConnectionId id) { ways_.erase(id); }
  [[nodiscard]] std::size_t too_much(ConnectionId id) const noexcept {
    const auto found = ways_.find(id);
    return found == ways_.end() ? 0 : too_much_on(found->second.paths.out);
  }

  [[nodiscard]] std::optional<Instant> next_due(Instant now) const noexcept {
    std::optional<Instant> next;
    for (const auto& [id, way] : ways_) {
      next = first_of(next, first_of(way.paths.out.next_due(now), way.paths.in.next_due(now)));
    }
    return next;
  }
  void deliver_out(Instant now, HostedServer& server) {
    for (auto& [id, way] : ways_) deliver(now, now, id, way, server);
  }
  void push_in(const ServerEvent& sent, std::vector<ServerEvent>& sent_now) {
    auto* way = find(sent.connection);
    if (way == nullptr) return;
    if (sent.kind == SessionEvent::Kind::kData) {
      way->paths.in.push(sent.time, sent.bytes);
    } else if (sent.kind == SessionEvent::Kind::kEnd) {
      way->paths.in.close(sent.time);
    } else {  // nothing is waited for
      ways_.erase(sent.connection);
      sent_now.push_back(sent);
    }
  }
  void deliver_in(Instant now, HostedServer& server, std::vector<ServerEvent>& sent_now) {
    const auto before = static_cast<std::ptrdiff_t>(sent_now.size());
    const auto add = [&](ServerEvent event) {
      const auto place = std::ranges::upper_bound(sent_now.begin() + before, sent_now.end(),
                                                  event.time, {}, &ServerEvent::time);
      sent_now.insert(place, std::move(event));
    };
    std::vector<ConnectionId> over;
    for (auto& [id, way] : ways_) {
      while (auto delivery = way.paths.in.pop(now)) {
        add({delivery->due, id, SessionEvent::Kind::kData, std::move(delivery->bytes)});
      }
      if (way.paths.is_broken(now)) {
        server.reset(now, id);
        add({now, id, SessionEvent::Kind::kReset, {}});
        over.push_back(id);
      } else if (way.paths.in.end(now) == End::kClosed) {
        add({now, id, SessionEvent::Kind::kEnd, {}});
        over.push_back(id);
      }
    }
    for (const auto id : over) ways_.erase(id);
  }

 private:
  struct Way {
    explicit Way(const Impairment& impairment) : paths{impairment} {}
    ImpairedPaths paths;
    bool is_half_closed = false;
  };

  [[nodiscard]] Way* find(ConnectionId id) {
    const auto found = ways_.find(id);
    return found == ways_.end() ? nullptr : &found->second;
  }
  /// What is due by `until` arrives at `now`.
  static void deliver(Instant now, Instant until, ConnectionId id, Way& way, HostedServer& server) {
    while (const auto delivery = way.paths.out.pop(until)) server.receive(now, id, delivery->bytes);
    if (way.is_half_closed || way.paths.out.end(until) != End::kClosed) return;
    way.is_half_closed = true;
    server.half_close(now, id);
  }

  Impairment impairment_;
  RandomSource seeds_;
  std::map<ConnectionId, Way> ways_;
};

class ImpairedServerDevice final : public hosted_by::Server<BehindLinks<HostedServer, ServerWays>> {
 public:
  using Server::Server;

  [[nodiscard]] std::optional<ConnectionId> connect(Instant time) override {
    return act(time, [this](Instant now) {
      const auto id = device().connect(now);
      if (id) links().begin(*id);
      return id;
    });
  }
  void receive(Instant time, ConnectionId id, Bytes segment) override {
    act(time, [&](Instant now) { links().push_out(now, id, segment); });
  }
  void half_close(Instant time, ConnectionId id) override {
    act(time, [&](Instant now) { links().half_close(now, id); });
  }
  void close(Instant time, ConnectionId id) override {
    act(time, [&](Instant now) {
      links().close(now, id, device());
      device().close(now, id);
    });
  }
  void reset(Instant time, ConnectionId id) override {
    act(time, [&](Instant now) {
      links().forget(id);
      device().reset(now, id);
    });
  }
  [[nodiscard]] std::optional<Instant> next_event() const override { return next_on_links(); }
  [[nodiscard]] std::size_t unread(ConnectionId id) const override {
    return device().unread(id) + links().too_much(id);
  }
};

/// A bus whose operations come through a port that is bad.
class BadBus : public hosted_by::Around<HostedBus> {
 public:
  explicit BadBus(std::unique_ptr<HostedBus> bus) : Around{std::move(bus)} {}

  [[nodiscard]] Outcome<void> make_bad(const Impairment& impairment) {
    // Who is asked for a bus is patient himself.
    constexpr Duration kNoLimit = std::chrono::hours{1};
    auto port = std::make_unique<EmulatedBusPort<HostedBus*>>(&device(), kNoLimit);
    return ImpairedBus::make(std::move(port), impairment).map([this](auto bad) {
      port_ = std::move(bad);
    });
  }

 protected:
  template <class Work>
  auto act(Instant time, Work work) {
    return work(time);
  }
  /// Does `operate(port)` at that time: its answer is an acknowledgement, a byte or nothing.
  template <class Operate>
  [[nodiscard]] BusReply at_port(Instant time, Operate operate) {
    port_->wait_until(time);
    const auto done = operate(*port_);
    BusReply reply{.outcome = BusReply::Outcome::kAck, .end = port_->now()};
    if (!done) {
      reply.outcome = BusReply::Outcome::kArbitrationLost;
    } else if constexpr (std::is_same_v<decltype(done), const Result<Ack>>) {
      if (*done == Ack::kNack) reply.outcome = BusReply::Outcome::kNack;
    } else if constexpr (std::is_same_v<decltype(done), const Result<std::byte>>) {
      reply.byte = *done;
    }
    return reply;
  }

 private:
  std::unique_ptr<ImpairedBus> port_;
};

class ImpairedBusDevice final : public hosted_by::Bus<BadBus> {
 public:
  using Bus::Bus;

  BusReply start(Instant time, std::uint8_t address, bool is_read) override {
    return at_port(time, [&](BusPort& port) {
      return port.start(BusAddress{address}, is_read ? Access::kRead : Access::kWrite);
    });
  }
  BusReply write(Instant time, std::byte byte) override {
    return at_port(time, [&](BusPort& port) { return port.write(byte); });
  }
  BusReply read(Instant time) override {
    return at_port(time, [](BusPort& port) { return port.read(Ack::kAck); });
  }
  BusReply stop(Instant time) override {
    return at_port(time, [](BusPort& port) { return port.stop(); });
  }
  BusReply recover(Instant time) override {
    return at_port(time, [](BusPort& port) { return port.recover(); });
  }
};

}  // namespace

Outcome<std::unique_ptr<HostedStream>> impair(std::unique_ptr<HostedStream> device,
                                              const Impairment& impairment) {
  for (const auto* path : {&impairment.out, &impairment.in}) {
    if (path->disconnect == 0 && path->disconnect_after == 0) continue;
    return problem(ErrorCode::kUnsupported, "impairment 'disconnect'",
                   "a byte stream that is served has no connection that breaks; on USB its cable "
                   "can be pulled out by hand ('usb.plugged 0')");
  }
  return std::make_unique<ImpairedStreamDevice>(std::move(device), impairment);
}

Outcome<std::unique_ptr<HostedServer>> impair(std::unique_ptr<HostedServer> device,
                                              const Impairment& impairment) {
  return std::make_unique<ImpairedServerDevice>(std::move(device), impairment);
}

Outcome<std::unique_ptr<HostedBus>> impair(std::unique_ptr<HostedBus> device,
                                           const Impairment& impairment) {
  auto bus = std::make_unique<ImpairedBusDevice>(std::move(device));
  if (auto made = bus->make_bad(impairment); !made) return tl::unexpected{std::move(made.error())};
  return bus;
}

}  // namespace armjig
