// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/attached.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>

namespace armjig {

std::string_view device_behind(const SerialPort& port,
                               std::span<const KnownBoard> boards) noexcept {
  if (!port.usb) return "";
  const auto known = std::ranges::find(boards, *port.usb, &KnownBoard::usb);
  return known == boards.end() ? "" : known->device;
}

bool is_meant(const SerialPort& port, const UsbChoice& choice) {
  const bool has_id = port.usb && std::ranges::count(choice.ids, *port.usb) > 0;
  return has_id && (choice.serial_number.empty() || choice.serial_number == port.serial_number);
}

std::string target_of(const SerialPort& port) { return "serial:" + port.path; }

std::string describe(const SerialPort& port) {
  auto text = port.manufacturer;
  if (!text.empty() && !port.product.empty()) text += ' ';
  text += port.product;
  if (text.empty()) text = port.description;
  if (!port.serial_number.empty()) text += fmt::format(" (serial number {})", port.serial_number);
  return text;
}

FileAccess access_to(const std::string& path) noexcept {
  return ::access(path.c_str(), R_OK | W_OK) == 0 ? FileAccess::kAllowed : FileAccess::kDenied;
}

}  // namespace armjig
