// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>

#include "harness/core/emulation.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig {

/// A 100 kHz bus with one emulated device, on virtual time: a byte takes nine clocks, a start or a
/// stop one.
template <EmulatedBusDevice Device>
class MemoryBus final : public BusPort {
 public:
  explicit MemoryBus(Device device) : device_{std::move(device)} {}

  Result<Ack> start(BusAddress address, Access /*access*/) override {
    now_ += kBit + kByte;
    is_addressed_ = device_.acknowledges(address.value);
    return as_ack(is_addressed_);
  }
  Result<Ack> write(std::byte byte) override {
    now_ += kByte;
    return as_ack(is_addressed_ && device_.write(now_, byte));
  }
  Result<std::byte> read(Ack /*reply*/) override {
    now_ += kByte;
    return is_addressed_ ? device_.read(now_) : std::byte{0xFF};  // an idle line reads as ones
  }
  Result<void> stop() override {
    now_ += kBit;
    is_addressed_ = false;
    return {};
  }
  void wait_until(Instant time) override { now_ = std::max(now_, time); }
  [[nodiscard]] Instant now() const override { return now_; }
  [[nodiscard]] Device& device() noexcept { return device_; }

 private:
  static constexpr Duration kBit = std::chrono::microseconds{10};
  static constexpr Duration kByte = 9 * kBit;

  static Ack as_ack(bool acknowledged) noexcept { return acknowledged ? Ack::kAck : Ack::kNack; }

  Device device_;
  Instant now_{};
  bool is_addressed_ = false;
};

}  // namespace armjig
