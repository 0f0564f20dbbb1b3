// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/clocked.hpp"

#include <cassert>
#include <cmath>
#include <utility>

#include "emulators/memory/hosted_around.hpp"

namespace armjig {
namespace {

Duration rounded(long double nanoseconds) {
  return Duration{static_cast<Duration::rep>(nanoseconds)};
}

/// Time and inputs of any kind of device.
template <class Around, class Hosted>
class OnClock : public Around {
 public:
  OnClock(std::unique_ptr<Hosted> device, const DeviceClock& clock)
      : Around{std::move(device)}, clock_{clock} {
    assert(clock.rate > 0);
  }

  void advance_to(Instant time) override {
    this->device().advance_to(clock_.inside(time));
    take();
  }
  [[nodiscard]] std::optional<Instant> next_event() const override {
    const auto next = this->device().next_event();
    return next ? std::optional{clock_.outside(*next)} : std::nullopt;
  }
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
    const bool is_taken = this->device().set_input(clock_.inside(time), name, value);
    take();
    return is_taken;
  }
  void overlook(Instant from, Instant to) override {
    this->device().overlook(clock_.inside(from), clock_.inside(to));
  }
  void wake(Instant time) override {
    this->device().wake(clock_.inside(time));
    take();
  }

 protected:
  [[nodiscard]] const DeviceClock& clock() const noexcept { return clock_; }
  /// What was sent, with times outside.
  void take() {
    if constexpr (requires { this->sent_; }) {
      this->take_sent([this](auto sent) {
        sent.time = clock_.outside(sent.time);
        this->sent_.push_back(std::move(sent));
      });
    }
  }

 private:
  DeviceClock clock_;
};

class StreamOnClock final : public OnClock<SenderAround<HostedStream>, HostedStream> {
 public:
  using OnClock::OnClock;

  void receive(Instant time, Bytes bytes) override {
    device().receive(clock().inside(time), bytes);
    take();
  }
  [[nodiscard]] std::size_t unread() const override { return device().unread(); }
  [[nodiscard]] std::unique_ptr<HostedStream> clone() const override {
    auto inner = device().clone();
    if (!inner) return nullptr;
    auto copy = std::make_unique<StreamOnClock>(std::move(inner), clock());
    copy->sent_ = sent_;
    return copy;
  }
};

class ServerOnClock final : public OnClock<SenderAround<HostedServer>, HostedServer> {
 public:
  using OnClock::OnClock;

  [[nodiscard]] bool is_listening() const override { return device().is_listening(); }
  [[nodiscard]] std::optional<ConnectionId> connect(Instant time) override {
    const auto id = device().connect(clock().inside(time));
    take();
    return id;
  }
  void receive(Instant time, ConnectionId id, Bytes segment) override {
    device().receive(clock().inside(time), id, segment);
    take();
  }
  void half_close(Instant time, ConnectionId id) override {
    device().half_close(clock().inside(time), id);
    take();
  }
  void close(Instant time, ConnectionId id) override {
    device().close(clock().inside(time), id);
    take();
  }
  void reset(Instant time, ConnectionId id) override {
    device().reset(clock().inside(time), id);
    take();
  }
  [[nodiscard]] std::size_t unread(ConnectionId id) const override { return device().unread(id); }
  [[nodiscard]] std::unique_ptr<HostedServer> clone() const override {
    auto inner = device().clone();
    if (!inner) return nullptr;
    auto copy = std::make_unique<ServerOnClock>(std::move(inner), clock());
    copy->sent_ = sent_;
    return copy;
  }
};

/// The bits of a bus are its master's: only what the devices do by themselves goes by their clock.
class BusOnClock final : public OnClock<HostedAround<HostedBus>, HostedBus> {
 public:
  using OnClock::OnClock;

  BusReply start(Instant time, std::uint8_t address, bool is_read) override {
    return as_outside(time, device().start(clock().inside(time), address, is_read));
  }
  BusReply write(Instant time, std::byte byte) override {
    return as_outside(time, device().write(clock().inside(time), byte));
  }
  BusReply read(Instant time) override {
    return as_outside(time, device().read(clock().inside(time)));
  }
  BusReply stop(Instant time) override {
    return as_outside(time, device().stop(clock().inside(time)));
  }
  BusReply recover(Instant time) override {
    return as_outside(time, device().recover(clock().inside(time)));
  }
  [[nodiscard]] std::unique_ptr<HostedBus> clone() const override {
    auto inner = device().clone();
    if (!inner) return nullptr;
    return std::make_unique<BusOnClock>(std::move(inner), clock());
  }

 private:
  [[nodiscard]] BusReply as_outside(Instant time, BusReply reply) const {
    reply.end = time + (reply.end - clock().inside(time));
    return reply;
  }
};

}  // namespace

Instant DeviceClock::inside(Instant outside) const {
  const auto since = outside.time_since_epoch();
  if (rate == 1) return begin + since;
  return begin + rounded(std::floor(static_cast<long double>(since.count()) * rate));
}

Instant DeviceClock::outside(Instant inside) const {
  const auto since = inside - begin;
  if (rate == 1) return Instant{since};
  return Instant{rounded(std::ceil(static_cast<long double>(since.count()) / rate))};
}

std::unique_ptr<HostedStream> put_on_clock(std::unique_ptr<HostedStream> device,
                                           const DeviceClock& clock) {
  return std::make_unique<StreamOnClock>(std::move(device), clock);
}
std::unique_ptr<HostedServer> put_on_clock(std::unique_ptr<HostedServer> device,
                                           const DeviceClock& clock) {
  return std::make_unique<ServerOnClock>(std::move(device), clock);
}
std::unique_ptr<HostedBus> put_on_clock(std::unique_ptr<HostedBus> device,
                                        const DeviceClock& clock) {
  return std::make_unique<BusOnClock>(std::move(device), clock);
}

}  // namespace armjig
