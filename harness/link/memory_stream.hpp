// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/emulation.hpp"
#include "harness/link/stream_port.hpp"

namespace armjig {

/// A stream to an emulated device in the same process, on virtual time: reading advances the device
/// to whatever comes first, its next bytes or the deadline. `Held` is an `EmulatedStream`, or a
/// pointer to something like it.
template <class Held>
class MemoryStream final : public StreamPort {
 public:
  explicit MemoryStream(Held held) : held_{std::move(held)} {}

  Result<void> write(Bytes bytes) override {
    device().receive(now_, bytes);
    return {};
  }

  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    while (unread_.empty()) {
      const auto event = device().next_event();
      const bool is_due = event && *event <= deadline;
      now_ = std::max(now_, is_due ? *event : deadline);
      device().advance_to(now_);
      for (const auto& sent : device().sent()) {
        unread_.insert(unread_.end(), sent.bytes.begin(), sent.bytes.end());
      }
      device().clear_sent();
      if (!is_due && unread_.empty()) return 0;
    }
    const auto taken = std::min(into.size(), unread_.size());
    std::copy_n(unread_.begin(), taken, into.begin());
    unread_.erase(unread_.begin(), unread_.begin() + static_cast<std::ptrdiff_t>(taken));
    return taken;
  }

  [[nodiscard]] Instant now() const override { return now_; }

  /// For devices that have `set_input(time, name, value)`.
  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override {
    if constexpr (requires { device().set_input(now_, input, value); }) {
      return device().set_input(now_, input, value);
    } else {
      return false;
    }
  }

  /// To look at the device and to touch it. Its time is `now()`.
  [[nodiscard]] auto& device() noexcept { return device_in(held_); }

 private:
  Held held_;
  Instant now_{};
  std::vector<std::byte> unread_;
};

}  // namespace armjig
