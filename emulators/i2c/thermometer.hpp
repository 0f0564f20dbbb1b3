// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "harness/core/emulation.hpp"

namespace armjig::i2c {

/// How to put a device of one's own on the bus: a sensor with registers, as most are. The first
/// byte of a write chooses a register, reads go on from there; register 0 and 1 are the temperature
/// in 1/256 degree, high byte first, register 2 can be written and changes nothing.
class Thermometer {
 public:
  explicit Thermometer(std::uint8_t address) noexcept : address_{address} {}

  [[nodiscard]] bool acknowledges(std::uint8_t address) const noexcept {
    return address == address_;
  }
  void start(Instant /*time*/, bool is_read) noexcept { expects_register_ = !is_read; }

  /// A register that it does not have is not acknowledged.
  [[nodiscard]] bool write(Instant /*time*/, std::byte byte) noexcept {
    if (!expects_register_) {
      if (register_ == 2) configuration_ = byte;
      return register_++ == 2;
    }
    expects_register_ = false;
    register_ = std::to_integer<std::uint8_t>(byte);
    return register_ <= 2;
  }
  [[nodiscard]] std::byte read(Instant /*time*/) noexcept {
    const std::byte registers[]{static_cast<std::byte>(temperature_ >> 8),
                                static_cast<std::byte>(temperature_), configuration_};
    return register_ <= 2 ? registers[register_++] : std::byte{0xFF};
  }

  void set_temperature(double degrees) noexcept {
    temperature_ = static_cast<std::int16_t>(degrees * 256);
  }

 private:
  std::uint8_t address_;
  std::uint8_t register_ = 0;
  std::int16_t temperature_ = 0;
  std::byte configuration_{};
  bool expects_register_ = false;
};
static_assert(EmulatedBusDevice<Thermometer>);

}  // namespace armjig::i2c
