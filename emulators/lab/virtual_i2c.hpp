// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "emulators/lab/i2c_adapter.hpp"
#include "emulators/memory/hosted.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// A device node /dev/i2c-N, without root, for programs that are started in its environment; no
/// other sees it. They need not know: their calls of the C library are led here (umockdev). It is
/// there as long as this object lives.
class VirtualI2c {
 public:
  /// Problems: those of `I2cAdapter::open`, and `kSystem` if the test bed cannot be made.
  [[nodiscard]] static Outcome<VirtualI2c> open(std::unique_ptr<HostedBus> bus, int number,
                                                HostOptions options = {});
  VirtualI2c(VirtualI2c&&) noexcept;
  VirtualI2c& operator=(VirtualI2c&&) noexcept;
  VirtualI2c(const VirtualI2c&) = delete;
  VirtualI2c& operator=(const VirtualI2c&) = delete;
  ~VirtualI2c();

  [[nodiscard]] const std::string& path() const noexcept;
  /// `NAME=VALUE`: what a program needs in its environment.
  [[nodiscard]] std::vector<std::string> environment() const;
  /// For the inputs of the bus, and its statistics.
  [[nodiscard]] Host& host() noexcept;

 private:
  class Bed;
  explicit VirtualI2c(std::unique_ptr<Bed> bed) noexcept;

  std::unique_ptr<Bed> bed_;
};

}  // namespace armjig
