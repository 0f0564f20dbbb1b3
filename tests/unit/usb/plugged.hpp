// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "emulators/usb/cdc_acm.hpp"
#include "emulators/usb/device.hpp"
#include "harness/core/hex.hpp"

namespace armjig::usb {

/// A board's serial port, and a host at the other end of its cable.
class Plugged {
 public:
  enum class Configured : std::uint8_t { kNo, kYes };

  explicit Plugged(Configured configured = Configured::kYes) {
    if (configured == Configured::kYes) set({0x00, 9, 1, 0, 0});
  }

  void submit(Transfer transfer) { device.submit(Instant{}, std::move(transfer)); }

  /// The next end that is told.
  Completion ended() {
    auto end = device.next(Instant{});
    EXPECT_TRUE(end) << "nothing has ended";
    return end.value_or(Completion{});
  }

  Completion get(const Setup& setup) {
    submit({.endpoint = kIn, .setup = setup, .room = setup.length});
    return ended();
  }
  Completion set(const Setup& setup, std::vector<std::byte> bytes = {}) {
    submit({.setup = setup, .bytes = std::move(bytes)});
    return ended();
  }

  void open() { set({0x21, 0x22, 3, 0, 0}); }
  void close() { set({0x21, 0x22, 0, 0, 0}); }
  void write(const std::string& hex) {
    submit({.endpoint = CdcAcm::kBulkOut, .bytes = from_hex(hex).value()});
  }
  void read(std::uint64_t id, std::size_t room) {
    submit({.id = id, .endpoint = CdcAcm::kBulkIn, .room = room});
  }
  /// The board sends a message.
  void say(const std::string& hex) {
    EXPECT_TRUE(port.send(from_hex(hex).value()));
    device.advance();
  }

  std::string heard;                 ///< by the board
  std::vector<std::size_t> packets;  ///< their sizes
  int appetite = 1000;               ///< packets that the board still takes
  CdcAcm port{{.vendor = 0x0483,
               .product = 0x5740,
               .manufacturer = "armjig",
               .product_name = "board",
               .serial_number = "7"},
              {.on_bytes =
                   [this](Bytes bytes) {
                     --appetite;
                     heard += to_hex(bytes);
                     packets.push_back(bytes.size());
                   },
               .wants_bytes = [this] { return appetite > 0; },
               .on_open = [](bool) {}}};
  Device device{port};
};

}  // namespace armjig::usb
