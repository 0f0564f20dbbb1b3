// SPDX-License-Identifier: Apache-2.0
#include "harness/link/usb_id.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "harness/core/number.hpp"

namespace armjig {
namespace {

/// `1-2.3`: numbers with one dash, after which there may be dots.
bool is_place(std::string_view text) {
  const auto dash = text.find('-');
  if (dash == std::string_view::npos) return false;
  if (!whole_text_as<std::uint8_t>(text.substr(0, dash))) return false;
  for (auto rest = text.substr(dash + 1);;) {
    const auto dot = rest.find('.');
    if (!whole_text_as<std::uint8_t>(rest.substr(0, dot))) return false;
    if (dot == std::string_view::npos) return true;
    rest = rest.substr(dot + 1);
  }
}

}  // namespace

std::string to_string(UsbId id) { return fmt::format("{:04x}:{:04x}", id.vendor, id.product); }

Result<UsbId> parse_usb_id(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) return fail(ErrorCode::kBadValue);
  const auto number = [](std::string_view digits) -> std::optional<std::uint16_t> {
    return digits.size() > 4 ? std::nullopt : whole_text_as<std::uint16_t>(digits, 16);
  };
  const auto vendor = number(text.substr(0, colon));
  const auto product = number(text.substr(colon + 1));
  if (!vendor || !product) return fail(ErrorCode::kBadValue);
  return UsbId{*vendor, *product};
}

Result<UsbChoice> parse_usb_board(std::string_view text) {
  const auto second = text.find(':', std::min(text.find(':'), text.size() - 1) + 1);
  const auto id = parse_usb_id(text.substr(0, second));
  if (!id) return tl::unexpected{id.error()};
  UsbChoice choice{.ids = {*id}};
  if (second == std::string_view::npos) return choice;
  choice.serial_number = text.substr(second + 1);
  if (choice.serial_number.empty()) return fail(ErrorCode::kBadValue);
  return choice;
}

Result<UsbChoice> parse_usb_choice(std::string_view text) {
  if (is_place(text)) return UsbChoice{.place = std::string{text}};
  return parse_usb_board(text);
}

}  // namespace armjig
