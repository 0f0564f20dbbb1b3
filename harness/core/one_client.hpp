// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "harness/core/emulation.hpp"

namespace armjig {

/// An `EmulatedServer` as an `EmulatedMultiServer`, which refuses a second client while it has one.
/// A connection that the device has ended or reset makes room for the next.
template <EmulatedServer Device>
class OneClient : public Sending<ServerEvent>, public InputsOf<Device> {
 public:
  explicit OneClient(Device device) : device_{std::move(device)} {}

  [[nodiscard]] bool is_listening() const noexcept { return true; }
  [[nodiscard]] std::optional<ConnectionId> connect(Instant time) {
    if (phase_ == Phase::kOpen) return std::nullopt;
    ++client_;
    phase_ = Phase::kOpen;
    if (!is_accepted(time)) phase_ = Phase::kGone;
    take_sent();
    return phase_ == Phase::kGone ? std::nullopt : std::optional{client_};
  }
  void receive(Instant time, ConnectionId id, Bytes segment) {
    if (is_known(id)) device_.receive(time, segment);
    take_sent();
  }
  void half_close(Instant time, ConnectionId id) {
    if (is_known(id)) device_.half_close(time);
    take_sent();
  }
  void close(Instant time, ConnectionId id) {
    if (is_known(id)) device_.close(time);
    forget(id);
  }
  void reset(Instant time, ConnectionId id) {
    if (is_known(id)) device_.reset(time);
    forget(id);
  }
  [[nodiscard]] std::size_t unread(ConnectionId /*id*/) const noexcept { return 0; }

  void advance_to(Instant time) {
    device_.advance_to(time);
    take_sent();
  }
  [[nodiscard]] std::optional<Instant> next_event() const { return device_.next_event(); }

  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value)
    requires requires(Device device) { device.set_input(time, name, value); }
  {
    const bool is_taken = device_.set_input(time, name, value);
    take_sent();
    return is_taken;
  }
  [[nodiscard]] auto take_log()
    requires requires(Device device) { device.take_log(); }
  {
    return device_.take_log();
  }

  [[nodiscard]] Device& device() noexcept { return device_; }

 private:
  enum class Phase : std::uint8_t { kGone, kOpen, kEnded };

  [[nodiscard]] bool is_known(ConnectionId id) const noexcept {
    return id == client_ && phase_ != Phase::kGone;
  }
  bool is_accepted(Instant time) {
    if constexpr (std::is_void_v<decltype(device_.connect(time))>) {
      device_.connect(time);
      return true;
    } else {
      return device_.connect(time);
    }
  }
  void forget(ConnectionId id) {
    if (is_known(id)) phase_ = Phase::kGone;
    take_sent();
  }
  /// What a device says to nobody is lost.
  void take_sent() {
    for (const auto& event : device_.sent()) {
      if (phase_ == Phase::kGone) break;
      sent_.push_back({event.time, client_, event.kind, event.bytes});
      if (event.kind == SessionEvent::Kind::kEnd) phase_ = Phase::kEnded;
      if (event.kind == SessionEvent::Kind::kReset) phase_ = Phase::kGone;
    }
    device_.clear_sent();
  }

  Device device_;
  ConnectionId client_ = ConnectionId(-1);  ///< the last one
  Phase phase_{};
};

}  // namespace armjig
