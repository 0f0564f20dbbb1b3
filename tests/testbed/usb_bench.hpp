// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <umockdev.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "emulators/lab/tty_calls.hpp"

namespace armjig::testing {

/// A USB serial board as far as this process and its children can see: entries in /sys and a node
/// in /dev that leads to a pseudo-terminal. It answers the ioctls that a pseudo-terminal lacks and
/// passes on all others. Runs under umockdev-wrapper, without root.
class UsbBench {
 public:
  struct Board {
    std::string name;    ///< of the port: `ttyACM0`
    std::string vendor;  ///< four hexadecimal digits
    std::string product;
    std::string serial_number;
  };

  UsbBench();
  UsbBench(const UsbBench&) = delete;
  UsbBench& operator=(const UsbBench&) = delete;
  ~UsbBench();

  /// Plugs a board in whose far end is the pseudo-terminal at `terminal`.
  void plug_in(const Board& board, const std::string& terminal);
  void pull_out(const Board& board);

  /// An entry in /sys, below `parent` if that is not null; its path.
  std::string add(const char* subsystem, const std::string& name, const char* parent,
                  std::vector<const char*> attributes, std::vector<const char*> properties) const;

  /// A symbolic link on the bench, as udev rules make them.
  void link(const std::string& path, const std::string& to) const;

  /// The speed to which a port was set last, in baud; 0 if none was, or one of those that have a
  /// name in <termios.h>: they do not pass the bench.
  [[nodiscard]] std::uint32_t baud_of(const std::string& path) const;

  [[nodiscard]] UMockdevTestbed* bed() const noexcept { return bed_; }
  /// The folder that /sys and /dev are in.
  [[nodiscard]] std::string root() const;

 private:
  UMockdevTestbed* bed_;
  struct Port {
    lab::SerialLines lines;
    lab::GObjectRef<UMockdevIoctlBase> calls;
  };
  std::map<std::string, Port> ports_;  ///< by node
};

}  // namespace armjig::testing
