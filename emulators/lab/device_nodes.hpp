// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emulators/host/host.hpp"
#include "emulators/usb/description.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// Device nodes without root and without a kernel module, for programs that are started in their
/// environment; no other sees them. They need not know: their calls of the C library are led here
/// (umockdev). Any number of programs may be there, also at once; the nodes stay as long as this
/// object lives.
class DeviceNodes {
 public:
  DeviceNodes();
  DeviceNodes(const DeviceNodes&) = delete;
  DeviceNodes& operator=(const DeviceNodes&) = delete;
  ~DeviceNodes();

  /// /dev/i2c-N for a bus, which `host` has and which must run as long as this lives. Its path.
  /// Problems: `kSystem` if the test bed cannot be made.
  [[nodiscard]] Outcome<std::string> add_bus(int number, Host& host);

  /// /dev/ttyACM-N, the port of a USB board, with its entries in /sys, of which the far end is the
  /// terminal at that path. Its path. Problems: as above.
  [[nodiscard]] Outcome<std::string> add_board(int number, const usb::Identity& identity,
                                               const std::string& terminal);

  /// `NAME=VALUE`: what a program needs in its environment. Empty as long as nothing was added.
  [[nodiscard]] std::vector<std::string> environment() const;

 private:
  class Bed;
  Bed& bed();

  std::unique_ptr<Bed> bed_;  ///< made when it is needed
};

}  // namespace armjig
