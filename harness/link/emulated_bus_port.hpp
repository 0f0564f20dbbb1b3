// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>

#include "harness/core/emulation.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig {

/// A port to a whole emulated bus, on virtual time. An operation during which the clock is held for
/// longer than `clock_patience` fails with `kTimedOut`, as adapters do it; lost arbitration and a
/// data line that is held down with `kBusy`. `Held` is an `EmulatedBus`, or a pointer to something
/// like it.
template <class Held>
class EmulatedBusPort final : public BusPort {
 public:
  static constexpr Duration kClockPatience = std::chrono::milliseconds{25};

  explicit EmulatedBusPort(Held held, Duration clock_patience = kClockPatience)
      : held_{std::move(held)}, clock_patience_{clock_patience} {}

  Result<Ack> start(BusAddress address, Access access) override {
    return as_ack(bus().start(now_, address.value, access == Access::kRead));
  }
  Result<Ack> write(std::byte byte) override { return as_ack(bus().write(now_, byte)); }
  Result<std::byte> read(Ack /*reply*/) override {
    const auto reply = bus().read(now_);
    return as_ack(reply).map([&reply](Ack) { return reply.byte; });
  }
  Result<void> stop() override {
    return as_ack(bus().stop(now_)).map([](Ack) {});
  }
  Result<void> recover() override {
    return as_ack(bus().recover(now_)).map([](Ack) {});
  }
  void wait_until(Instant time) override { now_ = std::max(now_, time); }
  [[nodiscard]] Instant now() const override { return now_; }
  /// For buses that have `set_input(time, name, value)`.
  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override {
    if constexpr (requires { bus().set_input(now_, input, value); }) {
      return bus().set_input(now_, input, value);
    }
    return BusPort::touch(input, value);
  }
  /// For buses that have `observe(time, name)`.
  [[nodiscard]] std::optional<std::int64_t> observe(std::string_view output) override {
    if constexpr (requires { bus().observe(now_, output); }) return bus().observe(now_, output);
    return BusPort::observe(output);
  }
  [[nodiscard]] auto& bus() noexcept { return device_in(held_); }

 private:
  Result<Ack> as_ack(const BusReply& reply) {
    const auto deadline = now_ + clock_patience_;
    now_ = std::min(reply.end, deadline);
    if (reply.end > deadline) return fail(ErrorCode::kTimedOut);
    switch (reply.outcome) {
      case BusReply::Outcome::kAck:
        return Ack::kAck;
      case BusReply::Outcome::kNack:
        return Ack::kNack;
      case BusReply::Outcome::kArbitrationLost:
      case BusReply::Outcome::kDataHeld:
        break;
    }
    return fail(ErrorCode::kBusy);
  }

  Held held_;
  Duration clock_patience_;
  Instant now_{};
};

}  // namespace armjig
