// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "harness/core/emulation.hpp"
#include "harness/latency/probe.hpp"

namespace armjig::test {

/// A device that sends each byte back, `delay(n)` after the n-th one came, from 0; none: never.
class DelayedEcho {
 public:
  using Delay = std::function<std::optional<Duration>(std::uint64_t)>;

  explicit DelayedEcho(Delay delay) : delay_{std::move(delay)} {}

  void receive(Instant time, Bytes bytes) {
    for (const auto byte : bytes) {
      const auto delay = delay_(received_++);
      if (delay) due_.push_back({std::max(time + *delay, last_), {byte}});
      if (delay) last_ = due_.back().time;
    }
  }
  void advance_to(Instant time) {
    while (!due_.empty() && due_.front().time <= time) {
      sent_.push_back(due_.front());
      due_.erase(due_.begin());
    }
  }
  [[nodiscard]] std::optional<Instant> next_event() const {
    return due_.empty() ? std::nullopt : std::optional{due_.front().time};
  }
  [[nodiscard]] const std::vector<SentBytes>& sent() const { return sent_; }
  void clear_sent() { sent_.clear(); }

 private:
  Delay delay_;
  std::uint64_t received_ = 0;
  Instant last_{};
  std::vector<SentBytes> due_;
  std::vector<SentBytes> sent_;
};

/// Asks it with one byte.
class EchoProbe final : public Probe {
 public:
  [[nodiscard]] std::string_view exchange() const noexcept override { return "byte to its echo"; }
  [[nodiscard]] Hazard hazard() const noexcept override { return Hazard::kObserve; }
  [[nodiscard]] Messages request() override { return {&message_, 1}; }
  [[nodiscard]] std::size_t receive(Instant /*now*/, Bytes bytes) override { return bytes.size(); }

 private:
  std::array<std::byte, 1> byte_{std::byte{0x55}};
  Bytes message_{byte_};
};

}  // namespace armjig::test
