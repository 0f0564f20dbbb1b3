// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/overheard.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

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

/// A device whose traffic is told in the order of time.
template <class Hosted>
class Overheard : public Hosted {
 public:
  Overheard(std::unique_ptr<Hosted> device, Overhearer& overhearer)
      : device_{std::move(device)}, overhearer_{overhearer} {}

  void advance_to(Instant time) override {
    do_and_tell([&] { device_->advance_to(time); });
    overhearer_.wait_until(time);
  }
  [[nodiscard]] std::optional<Instant> next_event() const override { return device_->next_event(); }
  void overlook(Instant from, Instant to) override {
    overhearer_.overlook(from, to);
    device_->overlook(from, to);
  }
  [[nodiscard]] std::span<const DeviceInput> inputs() const override { return device_->inputs(); }
  [[nodiscard]] std::vector<std::string> take_log() override { return device_->take_log(); }
  [[nodiscard]] std::optional<int> wakes_by() const override { return device_->wakes_by(); }
  void wake(Instant time) override {
    do_and_tell([&] { device_->wake(time); });
  }
  [[nodiscard]] bool is_gone() const override { return device_->is_gone(); }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
    bool is_taken = false;
    do_and_tell([&] {
      is_taken = device_->set_input(time, name, value);
      if (is_taken) overhearer_.on_input(time, name, value);
    });
    return is_taken;
  }

 protected:
  [[nodiscard]] Hosted& device() noexcept { return *device_; }
  [[nodiscard]] const Hosted& device() const noexcept { return *device_; }
  [[nodiscard]] Overhearer& overhearer() noexcept { return overhearer_; }

  /// Does something, and tells what the device sends at once.
  template <class Do>
  void do_and_tell(Do do_it) {
    do_it();
    if constexpr (requires { device_->sent(); }) {
      const auto sent = device_->sent();
      for (const auto& one : sent.subspan(told_)) tell(overhearer_, one);
      told_ = sent.size();
    }
  }

  void forget_told() noexcept { told_ = 0; }

 private:
  std::unique_ptr<Hosted> device_;
  Overhearer& overhearer_;
  std::size_t told_ = 0;  ///< of what was sent and not cleared
};

/// One that sends by itself.
template <class Hosted>
class OverheardSender : public Overheard<Hosted> {
 public:
  using Overheard<Hosted>::Overheard;

  [[nodiscard]] auto sent() const -> decltype(std::declval<const Hosted&>().sent()) override {
    return this->device().sent();
  }
  void clear_sent() override {
    this->device().clear_sent();
    this->forget_told();
  }
};

class OverheardStream final : public OverheardSender<HostedStream> {
 public:
  using OverheardSender::OverheardSender;

  void receive(Instant time, Bytes bytes) override {
    overhearer().to_device(time, bytes);
    do_and_tell([&] { device().receive(time, bytes); });
  }
  [[nodiscard]] std::size_t unread() const override { return device().unread(); }
};

class OverheardServer final : public OverheardSender<HostedServer> {
 public:
  using OverheardSender::OverheardSender;

  [[nodiscard]] bool is_listening() const override { return device().is_listening(); }
  [[nodiscard]] std::optional<ConnectionId> connect(Instant time) override {
    const auto id = device().connect(time);
    if (id) pass({time, *id, Kind::kBegun, {}}, [] {});
    return id;
  }
  void receive(Instant time, ConnectionId id, Bytes segment) override {
    pass({time, id, Kind::kToServer, segment}, [&] { device().receive(time, id, segment); });
  }
  void half_close(Instant time, ConnectionId id) override {
    pass({time, id, Kind::kHalfClosed, {}}, [&] { device().half_close(time, id); });
  }
  void close(Instant time, ConnectionId id) override {
    pass({time, id, Kind::kClosed, {}}, [&] { device().close(time, id); });
  }
  void reset(Instant time, ConnectionId id) override {
    pass({time, id, Kind::kReset, {}}, [&] { device().reset(time, id); });
  }
  [[nodiscard]] std::size_t unread(ConnectionId id) const override { return device().unread(id); }

 private:
  template <class Do>
  void pass(const ConnectionEvent& event, Do do_it) {
    overhearer().on_connection(event);
    do_and_tell(do_it);
  }
};

class OverheardBus final : public Overheard<HostedBus> {
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
