// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/emulation.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/demo/demo.hpp"

/// The demo device behind each of the three links. One machine, three thin ways in.
namespace armjig::demo::emulation {

/// What the device does with one operation.
class Machine {
 public:
  State act(Operation operation) noexcept;

  friend bool operator==(const Machine&, const Machine&) = default;

 private:
  State state_ = State::kReady;
};

/// Time from the last byte of a request to its reply.
inline constexpr Duration kReplyDelay = std::chrono::milliseconds{1};

/// On a serial line.
class StreamDevice : public Sending<SentBytes> {
 public:
  void receive(Instant time, Bytes bytes);
  void advance_to(Instant time);
  [[nodiscard]] std::optional<Instant> next_event() const noexcept;

 private:
  Machine machine_;
  Splitter splitter_{kRequestStart};
  std::vector<SentBytes> due_;
};

/// As a server: greets every connection with its state, throws away one that sends the byte 0, and
/// ends one that ends.
class SessionDevice : public Sending<SessionEvent> {
 public:
  void connect(Instant time);
  void receive(Instant time, Bytes segment);
  void half_close(Instant time);
  void close(Instant time);
  void reset(Instant time);
  void advance_to(Instant time);
  [[nodiscard]] std::optional<Instant> next_event() const noexcept { return stream_.next_event(); }

 private:
  StreamDevice stream_;
};

/// At an I2C address: write an operation, then read the state.
class BusDevice {
 public:
  static constexpr std::uint8_t kAddress = 0x2A;

  [[nodiscard]] bool acknowledges(std::uint8_t address) const noexcept {
    return address == kAddress;
  }
  [[nodiscard]] bool write(Instant time, std::byte byte) noexcept;
  [[nodiscard]] std::byte read(Instant time) noexcept;

 private:
  Machine machine_;
  std::byte answer_{};
};

}  // namespace armjig::demo::emulation
