// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "emulators/host/host.hpp"

namespace armjig::cli {

/// A hosted device, served until this is gone.
class Served {
 public:
  explicit Served(Host host) : host_{std::move(host)}, thread_{[this] { host_.run(); }} {}
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;
  ~Served() { host_.stop(); }

  [[nodiscard]] std::string target() const { return target_; }

 private:
  Host host_;
  std::string target_ = host_.targets().front();
  std::jthread thread_;
};

/// Signals are for the thread that calls this.
[[nodiscard]] std::unique_ptr<Served> serve_aside(Host host);

}  // namespace armjig::cli
