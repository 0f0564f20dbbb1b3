// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "harness/core/bytes.hpp"

namespace armjig {

/// Where a USB device has a serial port of class CDC-ACM: a communication interface, which is told
/// about the line, and one with the data (USB class definitions for communications, 1.2).
struct AcmFunction {
  std::uint8_t configuration{};  ///< its value
  std::uint8_t control{};        ///< interface
  std::uint8_t data{};           ///< interface
  std::uint8_t bulk_in{};        ///< endpoint
  std::uint8_t bulk_out{};       ///< endpoint
  std::uint16_t packet_size{};   ///< bytes at most that come at once
  bool has_line = false;         ///< line coding and DTR may be set

  friend bool operator==(const AcmFunction&, const AcmFunction&) = default;
};

/// The first one in the descriptors of a device and its configurations, as the kernel gives them in
/// one piece. None: there is none that is whole.
[[nodiscard]] std::optional<AcmFunction> find_acm(Bytes descriptors) noexcept;

}  // namespace armjig
