// SPDX-License-Identifier: Apache-2.0
#include "emulators/memory/clocked.hpp"

#include <cassert>
#include <cmath>
#include <type_traits>
#include <utility>

#include "emulators/memory/hosted_around.hpp"

namespace armjig {
namespace {

Duration rounded(long double nanoseconds) {
  return Duration{static_cast<Duration::rep>(nanoseconds)};
}

/// Time outside and inside, of any kind of device.
template <class Around>
class OnClock : public Around {
 public:
  using Hosted = typename Around::Hosted;

  OnClock(std::unique_ptr<Hosted> device, const DeviceClock& clock)
      : Around{std::move(device)}, clock_{clock} {
    assert(clock.rate > 0);
  }

 protected:
  [[nodiscard]] const DeviceClock& clock() const noexcept { return clock_; }

  template <class Work>
  auto act(Instant time, Work work) {
    const auto inside = clock_.inside(time);
    return hosted_by::do_then(
        [&] {
          if constexpr (std::is_same_v<decltype(work(inside)), BusReply>) {
            return as_outside(time, work(inside));
          } else {
            return work(inside);
          }
        },
        [this] { take(); });
  }

 private:
  /// The bits of a bus are its master's: only what the devices do by themselves goes by their
  /// clock.
  [[nodiscard]] BusReply as_outside(Instant time, BusReply reply) const {
    reply.end = time + (reply.end - clock_.inside(time));
    return reply;
  }

  /// What was sent, with times outside.
  void take() {
    if constexpr (requires { this->sent_; }) {
      this->take_sent([this](auto sent) {
        sent.time = clock_.outside(sent.time);
        this->sent_.push_back(std::move(sent));
      });
    }
  }

  DeviceClock clock_;
};

/// All of it, on any kind of port.
template <class Layers>
class Clocked final : public Layers {
 public:
  using Layers::Layers;

  [[nodiscard]] std::optional<Instant> next_event() const override {
    const auto next = this->device().next_event();
    return next ? std::optional{this->clock().outside(*next)} : std::nullopt;
  }
  void overlook(Instant from, Instant to) override {
    this->device().overlook(this->clock().inside(from), this->clock().inside(to));
  }
  [[nodiscard]] std::unique_ptr<typename Layers::Hosted> clone() const override {
    auto inner = this->device().clone();
    if (!inner) return nullptr;
    auto copy = std::make_unique<Clocked>(std::move(inner), this->clock());
    if constexpr (requires { this->sent_; }) copy->sent_ = this->sent_;
    return copy;
  }
};

template <class Hosted>
using SenderOnClock = OnClock<hosted_by::SenderAround<Hosted>>;
using StreamOnClock = Clocked<hosted_by::Stream<SenderOnClock<HostedStream>>>;
using ServerOnClock = Clocked<hosted_by::Server<SenderOnClock<HostedServer>>>;
using BusOnClock = Clocked<hosted_by::Bus<OnClock<hosted_by::Around<HostedBus>>>>;

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
