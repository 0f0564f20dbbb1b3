// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/overheard.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "emulators/memory/hosted_around.hpp"

namespace armjig {
namespace {

using Kind = ConnectionEvent::Kind;

// What a device sent.
void tell(Overhearer& overhearer, const SentBytes& sent) {
  overhearer.from_device(sent.time, sent.bytes);
}
void tell(Overhearer& overhearer, const ServerEvent& sent) {
  const bool is_data = sent.kind == SessionEvent::Kind::kData;
  overhearer.on_connection(
      {sent.time, sent.connection, is_data ? Kind::kFromServer : Kind::kDropped, sent.bytes});
}

/// What the inner one sends at once when something is done to it is told.
template <class Hosted>
class Telling : public hosted_by::Around<Hosted> {
 public:
  Telling(std::unique_ptr<Hosted> device, Overhearer& overhearer)
      : hosted_by::Around<Hosted>{std::move(device)}, overhearer_{overhearer} {}

 protected:
  [[nodiscard]] Overhearer& overhearer() noexcept { return overhearer_; }

  template <class Work>
  auto act(Instant time, Work work) {
    return hosted_by::do_then([&] { return work(time); }, [this] { tell_sent(); });
  }
  void forget_told() noexcept { told_ = 0; }

 private:
  void tell_sent() {
    if constexpr (requires { this->device().sent(); }) {
      const auto sent = this->device().sent();
      for (const auto& one : sent.subspan(told_)) tell(overhearer_, one);
      told_ = sent.size();
    }
  }

  Overhearer& overhearer_;
  std::size_t told_ = 0;  ///< of what was sent and not cleared
};

/// A device whose traffic is told in the order of time.
template <class Layers>
class Overheard : public Layers {
 public:
  using Layers::Layers;

  void advance_to(Instant time) override {
    Layers::advance_to(time);
    this->overhearer().wait_until(time);
  }
  void overlook(Instant from, Instant to) override {
    this->overhearer().overlook(from, to);
    Layers::overlook(from, to);
  }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
    return this->act(time, [&](Instant now) {
      const bool is_taken = this->device().set_input(now, name, value);
      if (is_taken) this->overhearer().on_input(now, name, value);
      return is_taken;
    });
  }
};

/// One that sends by itself.
template <class Layers>
class OverheardSender : public Overheard<Layers> {
 public:
  using Overheard<Layers>::Overheard;

  void clear_sent() override {
    Layers::clear_sent();
    this->forget_told();
  }
};

template <class Hosted>
using TellingSender = hosted_by::Sender<Telling<Hosted>>;

class OverheardStream final
    : public OverheardSender<hosted_by::Stream<TellingSender<HostedStream>>> {
 public:
  using OverheardSender::OverheardSender;

  void receive(Instant time, Bytes bytes) override {
    overhearer().to_device(time, bytes);
    OverheardSender::receive(time, bytes);
  }
};

class OverheardServer final
    : public OverheardSender<hosted_by::Server<TellingSender<HostedServer>>> {
 public:
  using OverheardSender::OverheardSender;

  [[nodiscard]] std::optional<ConnectionId> connect(Instant time) override {
    return act(time, [this](Instant now) {
      const auto id = device().connect(now);
      if (id) tell_that({now, *id, Kind::kBegun, {}});
      return id;
    });
  }
  void receive(Instant time, ConnectionId id, Bytes segment) override {
    tell_that({time, id, Kind::kToServer, segment});
    OverheardSender::receive(time, id, segment);
  }
  void half_close(Instant time, ConnectionId id) override {
    tell_that({time, id, Kind::kHalfClosed, {}});
    OverheardSender::half_close(time, id);
  }
  void close(Instant time, ConnectionId id) override {
    tell_that({time, id, Kind::kClosed, {}});
    OverheardSender::close(time, id);
  }
  void reset(Instant time, ConnectionId id) override {
    tell_that({time, id, Kind::kReset, {}});
    OverheardSender::reset(time, id);
  }

 private:
  void tell_that(const ConnectionEvent& event) { overhearer().on_connection(event); }
};

class OverheardBus final : public Overheard<hosted_by::Bus<Telling<HostedBus>>> {
 public:
  using Overheard::Overheard;

  BusReply start(Instant time, std::uint8_t address, bool is_read) override {
    end_part(time, BusPart::Ending::kNextStart);
    part_ = BusPart{.begin = time, .address = address, .is_read = is_read};
    return keep_ack(device().start(time, address, is_read));
  }
  BusReply write(Instant time, std::byte byte) override {
    const auto reply = device().write(time, byte);
    if (is_answered(reply)) bytes_.push_back(byte);
    return keep_ack(reply);
  }
  BusReply read(Instant time) override {
    const auto reply = device().read(time);
    if (reply.outcome == BusReply::Outcome::kAck) bytes_.push_back(reply.byte);
    return is_answered(reply) ? reply : keep_ack(reply);
  }
  BusReply stop(Instant time) override {
    end_part(time, BusPart::Ending::kStop);
    return device().stop(time);
  }
  BusReply recover(Instant time) override {
    end_part(time, BusPart::Ending::kNextStart);
    return device().recover(time);
  }

 private:
  static bool is_answered(const BusReply& reply) noexcept {
    return reply.outcome == BusReply::Outcome::kAck || reply.outcome == BusReply::Outcome::kNack;
  }

  BusReply keep_ack(const BusReply& reply) {
    if (!is_answered(reply)) {
      if (part_) part_->error = ErrorCode::kBusy;
    } else {
      acks_ += reply.outcome == BusReply::Outcome::kAck ? 'A' : 'N';
    }
    return reply;
  }

  void end_part(Instant time, BusPart::Ending ending) {
    auto part = std::exchange(part_, std::nullopt);
    const auto bytes = std::exchange(bytes_, {});
    const auto acks = std::exchange(acks_, {});
    if (!part) return;
    part->end = time;
    part->bytes = bytes;
    part->acks = acks;
    part->ending = ending;
    overhearer().on_bus(*part);
  }

  std::optional<BusPart> part_;
  std::vector<std::byte> bytes_;
  std::string acks_;
};

}  // namespace

std::unique_ptr<HostedStream> overhear(std::unique_ptr<HostedStream> device,
                                       Overhearer& overhearer) {
  return std::make_unique<OverheardStream>(std::move(device), overhearer);
}
std::unique_ptr<HostedServer> overhear(std::unique_ptr<HostedServer> device,
                                       Overhearer& overhearer) {
  return std::make_unique<OverheardServer>(std::move(device), overhearer);
}
std::unique_ptr<HostedBus> overhear(std::unique_ptr<HostedBus> device, Overhearer& overhearer) {
  return std::make_unique<OverheardBus>(std::move(device), overhearer);
}

}  // namespace armjig
