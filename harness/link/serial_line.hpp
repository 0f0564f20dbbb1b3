// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace armjig {

enum class Parity : std::uint8_t { kNone, kOdd, kEven };

[[nodiscard]] constexpr std::string_view to_string(Parity parity) noexcept {
  return parity == Parity::kNone ? "no" : parity == Parity::kOdd ? "odd" : "even";
}

/// How bytes go over a serial line: 8 data bits, no flow control, and this.
struct SerialLine {
  std::uint32_t baud = 3'000'000;  ///< a USB port takes any number and ignores it
  Parity parity{};
  std::uint8_t stop_bits = 1;  ///< or 2

  friend bool operator==(const SerialLine&, const SerialLine&) = default;
};

}  // namespace armjig
