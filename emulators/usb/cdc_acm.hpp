// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "emulators/usb/function.hpp"

namespace armjig::usb {

/// How the host has set the line, which means nothing to a board that is on USB itself.
struct LineCoding {
  std::uint32_t baud = 115'200;
  std::uint8_t stop_bits = 0;  ///< 0: 1, 1: 1.5, 2: 2
  std::uint8_t parity = 0;     ///< 0: none, 1: odd, 2: even, 3: mark, 4: space
  std::uint8_t data_bits = 8;

  friend bool operator==(const LineCoding&, const LineCoding&) = default;
};

/// A serial port on USB (class CDC, subclass ACM; "USB Class Definitions for CDC, PSTN Subclass",
/// 1.2). A program has opened it while DTR is on, which is what systems turn on when one does. What
/// the board sends goes message by message: packets of 64 bytes, and a shorter one at the end of
/// each, which is empty if it has to be.
class CdcAcm final : public Function {
 public:
  static constexpr std::uint8_t kBulkOut = 0x01;
  static constexpr std::uint8_t kBulkIn = 0x81;
  static constexpr std::uint8_t kNotifications = 0x82;
  static constexpr std::uint16_t kPacketSize = 64;
  /// Bytes that wait for a host that does not read; beyond that whole messages are dropped.
  static constexpr std::size_t kCapacity = std::size_t{64} * 1024;

  /// What it tells and asks. The bytes are valid during the call, in which `send` may be called.
  struct Events {
    std::function<void(Bytes bytes)> on_bytes;
    std::function<bool()> wants_bytes;          ///< no: the host has to wait (NAK)
    std::function<void(bool is_open)> on_open;  ///< a program came or went
  };

  CdcAcm(Identity identity, Events events);

  /// Queues a message for the host. False: it is dropped, for no program is there or it does not
  /// read. Requires that it is not empty.
  bool send(Bytes message);

  [[nodiscard]] bool is_open() const noexcept { return is_open_; }
  [[nodiscard]] const LineCoding& line_coding() const noexcept { return coding_; }

  [[nodiscard]] const Description& description() const noexcept override { return description_; }
  [[nodiscard]] std::optional<ControlReply> control(Instant time, const Setup& setup,
                                                    Bytes bytes) override;
  [[nodiscard]] bool take(std::uint8_t endpoint, Bytes packet) override;
  [[nodiscard]] std::optional<std::vector<std::byte>> give(std::uint8_t endpoint) override;
  void reset(Instant time) override;

 private:
  [[nodiscard]] std::optional<ControlReply> set_line_coding(Bytes bytes);
  [[nodiscard]] ControlReply line_coding_reply() const;
  void set_open(bool is_open);

  Description description_;
  Events events_;
  LineCoding coding_;
  bool is_open_ = false;
  std::deque<std::vector<std::byte>> packets_;        ///< for `kBulkIn`
  std::size_t waiting_ = 0;                           ///< bytes in `packets_`
  std::deque<std::vector<std::byte>> notifications_;  ///< for `kNotifications`
};

}  // namespace armjig::usb
