// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <deque>
#include <type_traits>
#include <utility>

#include "harness/core/emulation.hpp"
#include "harness/link/session_port.hpp"

namespace armjig {

/// A connection to an emulated server in the same process, on virtual time.
template <EmulatedServer Device>
class MemorySession final : public SessionPort {
 public:
  /// `start`: the device's time, if it is not new.
  explicit MemorySession(Device device, Instant start = {})
      : device_{std::move(device)}, now_{start} {}

  Result<void> connect(Instant /*deadline*/) override {
    if (is_open_) return fail(ErrorCode::kBusy);
    device_.clear_sent();
    if (!is_accepted()) return fail(ErrorCode::kRefused);
    is_open_ = true;
    arrived_.clear();
    return {};
  }

  Result<void> send(Bytes segment) override {
    if (!is_open_) return fail(ErrorCode::kDisconnected);
    device_.receive(now_, segment);
    return {};
  }

  Result<Received> receive(std::span<std::byte> into, Instant deadline) override {
    if (!is_open_) return fail(ErrorCode::kDisconnected);
    take_sent();
    while (arrived_.empty()) {
      const auto event = device_.next_event();
      const bool is_due = event && *event <= deadline;
      now_ = std::max(now_, is_due ? *event : deadline);
      device_.advance_to(now_);
      take_sent();
      if (!is_due && arrived_.empty()) return Received{Arrival::kDeadline, 0};
    }
    return next(into);
  }

  void half_close() override {
    if (is_open_) device_.half_close(now_);
  }
  void close() override {
    if (std::exchange(is_open_, false)) device_.close(now_);
  }
  void reset() override {
    if (std::exchange(is_open_, false)) device_.reset(now_);
  }

  [[nodiscard]] Instant now() const override { return now_; }
  [[nodiscard]] Device& device() noexcept { return device_; }

 private:
  /// A device whose `connect` answers nothing always listens.
  bool is_accepted() {
    if constexpr (std::is_void_v<decltype(device_.connect(now_))>) {
      device_.connect(now_);
      return true;
    } else {
      return device_.connect(now_);
    }
  }

  void take_sent() {
    for (const auto& event : device_.sent()) arrived_.push_back(event);
    device_.clear_sent();
  }

  Received next(std::span<std::byte> into) {
    auto& event = arrived_.front();
    if (event.kind != SessionEvent::Kind::kData) {
      const auto arrival = event.kind == SessionEvent::Kind::kEnd ? Arrival::kEnd : Arrival::kReset;
      if (arrival == Arrival::kReset) is_open_ = false;
      arrived_.pop_front();
      return {arrival, 0};
    }
    const auto taken = std::min(into.size(), event.bytes.size());
    std::copy_n(event.bytes.begin(), taken, into.begin());
    event.bytes.erase(event.bytes.begin(),
                      event.bytes.begin() + static_cast<std::ptrdiff_t>(taken));
    if (event.bytes.empty()) arrived_.pop_front();
    return {Arrival::kData, taken};
  }

  Device device_;
  Instant now_;
  bool is_open_ = false;
  std::deque<SessionEvent> arrived_;
};

}  // namespace armjig
