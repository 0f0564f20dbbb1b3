// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "emulators/host/host.hpp"

namespace armjig {

/// A hosted device, served in a thread of its own until this is gone.
class Served {
 public:
  /// `when_over` is called in that thread when the host ends, also by itself (its device has gone).
  Served(Host host, std::function<void()> when_over);
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;
  ~Served() { end(); }

  /// Ends it, and waits for that; what it listens on stays. Does nothing if it has ended.
  void end();

  /// Requires one; a bus without USB has none.
  [[nodiscard]] const std::string& target() const { return targets_.front(); }
  [[nodiscard]] const std::vector<std::string>& targets() const noexcept { return targets_; }
  /// For `set_input` and `with_bus`. Its statistics are for after `end`.
  [[nodiscard]] Host& host() noexcept { return host_; }

 private:
  Host host_;
  std::vector<std::string> targets_ = host_.targets();
  std::function<void()> when_over_;
  std::jthread thread_;
};

/// Signals are for the thread that calls this.
[[nodiscard]] std::unique_ptr<Served> serve_aside(
    Host host, std::function<void()> when_over = [] {});

}  // namespace armjig
