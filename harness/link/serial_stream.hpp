// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/link/serial_line.hpp"
#include "harness/link/stream_port.hpp"
#include "harness/link/usb_id.hpp"

/// Serial ports of this machine: USB boards, adapters, built-in ones. Not pseudo-terminals, which
/// have no hardware behind them that could be asked.
namespace armjig {

/// A serial port as the operating system describes it; what it does not know is empty.
struct SerialPort {
  std::string path;
  std::string description;  ///< for people
  std::optional<UsbId> usb;
  std::string manufacturer;
  std::string product;
  std::string serial_number;
};

/// All that are there now, by path. Problems: `kSystem`.
[[nodiscard]] Outcome<std::vector<SerialPort>> list_serial_ports();

/// Where a serial port is and how it is set.
struct SerialAddress {
  std::string path;  ///< may be a symbolic link, as in /dev/serial/by-id
  SerialLine line{};

  friend bool operator==(const SerialAddress&, const SerialAddress&) = default;
};

/// Reads `PATH` or `PATH,BAUD`; `usual` has what it does not say. Problems: `kBadTarget`.
[[nodiscard]] Outcome<SerialAddress> parse_serial_address(std::string_view text,
                                                          SerialLine usual = {});

/// Opens a port and sets its line; what came before is thrown away. Its time is monotonic since
/// opening; `write` gives up with `kTimedOut` when the other side takes nothing for two seconds; a
/// port that is unplugged is `kDisconnected`. The port is locked against other programs that lock
/// it as well, and against all that are not root's. Problems: `kNotFound`, `kNoPermission`,
/// `kBusy`, `kBadTarget` (not a serial port), `kUnsupported` (not with that speed, parity or stop
/// bits), `kDisconnected`, `kSystem`.
[[nodiscard]] Outcome<std::unique_ptr<StreamPort>> open_serial(const SerialAddress& address);

}  // namespace armjig
