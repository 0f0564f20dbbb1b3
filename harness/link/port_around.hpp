// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "harness/link/bus_port.hpp"
#include "harness/link/session_source.hpp"
#include "harness/link/stream_port.hpp"

/// What is put around a port: each passes on whatever it does not change.
namespace armjig {

/// Requires a port.
template <class Port>
class PortAround : public Port {
 public:
  explicit PortAround(std::unique_ptr<Port> inner) noexcept : inner_{std::move(inner)} {
    assert(inner_ != nullptr);
  }

  [[nodiscard]] Instant now() const override { return inner_->now(); }
  [[nodiscard]] std::optional<Lifeline> lifeline() const override { return inner_->lifeline(); }
  [[nodiscard]] bool touch(std::string_view input, std::int64_t value) override {
    return inner_->touch(input, value);
  }
  [[nodiscard]] std::optional<std::int64_t> observe(std::string_view output) override {
    return inner_->observe(output);
  }

 protected:
  [[nodiscard]] Port& inner() noexcept { return *inner_; }
  [[nodiscard]] const Port& inner() const noexcept { return *inner_; }

 private:
  std::unique_ptr<Port> inner_;
};

using StreamAround = PortAround<StreamPort>;
using SessionAround = PortAround<SessionPort>;

class BusAround : public PortAround<BusPort> {
 public:
  using PortAround::PortAround;
  [[nodiscard]] bool has_operations() const noexcept override { return inner().has_operations(); }
  Result<void> recover() override { return inner().recover(); }
  void wait_until(Instant time) override { inner().wait_until(time); }
};

/// The same around every port to a server.
class SourceAround : public PortAround<SessionSource> {
 public:
  using Wrap = std::function<std::unique_ptr<SessionPort>(std::unique_ptr<SessionPort>)>;

  SourceAround(std::unique_ptr<SessionSource> inner, Wrap wrap) noexcept
      : PortAround{std::move(inner)}, wrap_{std::move(wrap)} {}
  std::unique_ptr<SessionPort> make_port() override { return wrap_(inner().make_port()); }
  void pause(Duration duration) override { inner().pause(duration); }

 private:
  Wrap wrap_;
};

}  // namespace armjig
