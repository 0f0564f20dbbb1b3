// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "harness/core/emulation.hpp"

namespace armjig {

/// An emulated device whose type is forgotten, so that hosting is compiled once for all of them.
/// The functions are those of `EmulatedStream`.
class HostedStream {
 public:
  HostedStream() = default;
  HostedStream(const HostedStream&) = delete;
  HostedStream& operator=(const HostedStream&) = delete;
  virtual ~HostedStream() = default;

  virtual void receive(Instant time, Bytes bytes) = 0;
  virtual void advance_to(Instant time) = 0;
  [[nodiscard]] virtual std::optional<Instant> next_event() const = 0;
  [[nodiscard]] virtual std::span<const SentBytes> sent() const = 0;
  virtual void clear_sent() = 0;
  /// Does beside the device what no client can. False: nothing has that name and takes the value.
  [[nodiscard]] virtual bool set_input(Instant time, std::string_view name, std::int64_t value) = 0;
};

template <EmulatedStream Device>
[[nodiscard]] std::unique_ptr<HostedStream> make_hosted(Device device) {
  class Hosted final : public HostedStream {
   public:
    explicit Hosted(Device hosted) : device_{std::move(hosted)} {}
    void receive(Instant time, Bytes bytes) override { device_.receive(time, bytes); }
    void advance_to(Instant time) override { device_.advance_to(time); }
    [[nodiscard]] std::optional<Instant> next_event() const override {
      return device_.next_event();
    }
    [[nodiscard]] std::span<const SentBytes> sent() const override { return device_.sent(); }
    void clear_sent() override { device_.clear_sent(); }
    [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value) override {
      if constexpr (requires { device_.set_input(time, name, value); }) {
        return device_.set_input(time, name, value);
      } else {
        return false;
      }
    }

   private:
    Device device_;
  };
  return std::make_unique<Hosted>(std::move(device));
}

}  // namespace armjig
