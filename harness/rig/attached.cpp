// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/attached.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>

namespace armjig {
namespace {

constexpr std::array kKnownBoards{KnownBoard{"parol6", {0x0483, 0x5740}}};

}  // namespace

std::span<const KnownBoard> known_boards() noexcept { return kKnownBoards; }

std::string_view device_behind(const SerialPort& port) noexcept {
  if (!port.usb) return "";
  const auto known = std::ranges::find(kKnownBoards, *port.usb, &KnownBoard::usb);
  return known == kKnownBoards.end() ? "" : known->device;
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

Access access_to(const std::string& path) noexcept {
  return ::access(path.c_str(), R_OK | W_OK) == 0 ? Access::kAllowed : Access::kDenied;
}

}  // namespace armjig
