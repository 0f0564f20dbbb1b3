// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/error.hpp"

/// By what USB devices are told apart.
namespace armjig {

/// Who made a USB device, and what it is.
struct UsbId {
  std::uint16_t vendor{};
  std::uint16_t product{};

  friend auto operator<=>(const UsbId&, const UsbId&) = default;
};

/// `0483:5740`.
[[nodiscard]] std::string to_string(UsbId id);

/// Reads two numbers of one to four hexadecimal digits with a colon between them. Fails with
/// `kBadValue`.
[[nodiscard]] Result<UsbId> parse_usb_id(std::string_view text);

/// Which device is meant: all that is said has to fit.
struct UsbChoice {
  std::vector<UsbId> ids{};     ///< one of these; empty: whatever it is
  std::string serial_number{};  ///< empty: whatever it has
  std::string place{};          ///< its bus and ports, as `1-2.3`; empty: wherever it is

  friend bool operator==(const UsbChoice&, const UsbChoice&) = default;
};

/// Reads `VID:PID` or `VID:PID:SERIAL`. Fails with `kBadValue`.
[[nodiscard]] Result<UsbChoice> parse_usb_board(std::string_view text);

/// Reads the same, or a place: `BUS-PORT`, with `.PORT` for each hub on the way. Fails with
/// `kBadValue`.
[[nodiscard]] Result<UsbChoice> parse_usb_choice(std::string_view text);

}  // namespace armjig
