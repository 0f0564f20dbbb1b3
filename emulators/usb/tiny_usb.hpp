// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "emulators/usb/function.hpp"
#include "harness/link/bus_port.hpp"

namespace armjig::usb {

/// An I2C adapter of the i2c-tiny-usb family in front of a bus: whole messages by control requests
/// of its vendor, as Linux' driver of that name and libusb programs send them. A refused byte looks
/// like a refused address, for the adapter has one word for both.
class TinyUsb final : public Function {
 public:
  /// The numbers by which Linux' driver knows such adapters.
  static constexpr std::uint16_t kVendor = 0x0403;
  static constexpr std::uint16_t kProduct = 0xC631;

  /// `bus` outlives it, and can be led byte by byte. Vendor and product of `identity` are not
  /// looked at.
  TinyUsb(Identity identity, BusPort& bus);

  [[nodiscard]] const Description& description() const noexcept override { return description_; }
  /// The bus is led from `time` on; the answer is due when it has done that.
  [[nodiscard]] std::optional<ControlReply> control(Instant time, const Setup& setup,
                                                    Bytes bytes) override;
  void reset(Instant time) override;

 private:
  enum class Status : std::uint8_t { kIdle = 0, kAcknowledged = 1, kRefused = 2 };

  [[nodiscard]] std::optional<ControlReply> message(const Setup& setup, Bytes bytes);
  [[nodiscard]] bool lead(const Setup& setup, Bytes bytes, std::vector<std::byte>& received);
  [[nodiscard]] bool write_all(Bytes bytes);
  [[nodiscard]] bool read_all(std::vector<std::byte>& into);
  void stop();

  Description description_;
  BusPort& bus_;
  Status status_ = Status::kIdle;
  bool is_in_transaction_ = false;
};

}  // namespace armjig::usb
