// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "emulators/usb/description.hpp"
#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"

namespace armjig::usb {

/// What begins a control transfer.
struct Setup {
  std::uint8_t type{};  ///< direction, kind and recipient
  std::uint8_t request{};
  std::uint16_t value{};
  std::uint16_t index{};
  std::uint16_t length{};  ///< of the data, at most

  friend bool operator==(const Setup&, const Setup&) = default;
};

/// What a device answers to a control request that it knows.
struct ControlReply {
  std::vector<std::byte> bytes{};  ///< of a request that asks for some
  Instant due{};                   ///< the answer is there then
};

/// What one kind of USB device does; `Device` does what all of them do. Everything is asked by one
/// thread.
class Function {
 public:
  Function() = default;
  Function(const Function&) = delete;
  Function& operator=(const Function&) = delete;
  virtual ~Function() = default;

  [[nodiscard]] virtual const Description& description() const noexcept = 0;

  /// A request of its class or its vendor, with the data that the host sent. None: it stalls.
  [[nodiscard]] virtual std::optional<ControlReply> control(Instant time, const Setup& setup,
                                                            Bytes bytes) = 0;
  /// A packet from the host. False: not now (NAK); the host offers it again.
  [[nodiscard]] virtual bool take(std::uint8_t /*endpoint*/, Bytes /*packet*/) { return false; }
  /// The next packet for the host, which may be empty. None: not now (NAK).
  [[nodiscard]] virtual std::optional<std::vector<std::byte>> give(std::uint8_t /*endpoint*/) {
    return std::nullopt;
  }
  /// The host has forgotten it: the bus was reset, or the cable pulled out.
  virtual void reset(Instant /*time*/) {}
};

}  // namespace armjig::usb
