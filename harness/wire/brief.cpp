// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/brief.hpp"

#include <fmt/core.h>

#include "harness/core/hex.hpp"
#include "harness/wire/append_text.hpp"

namespace armjig {

std::string to_line(const Message& message) {
  std::string text;
  append_line(text, message);
  return text;
}

std::string to_short_dump(Bytes bytes) {
  constexpr std::size_t kShown = 16;
  constexpr std::size_t kWorthIt = 4;  // fewer than these take no more room than the count of them
  if (bytes.size() <= kShown + kWorthIt) return to_hex_dump(bytes);
  return fmt::format("{} ... {} more", to_hex_dump(bytes.first(kShown)), bytes.size() - kShown);
}

std::string text_in_both(const Field& field, std::int64_t value) {
  auto text = field_text(field, value);
  const bool has_hex = field.encoding == Encoding::kBits || field.encoding == Encoding::kLiteral;
  if (has_hex || field.place == Place::kPiece) return text;
  const int width = 8 * field.width;
  const auto raw = static_cast<std::uint64_t>(value) & ((std::uint64_t{1} << width) - 1);
  return text + fmt::format(" = 0x{:0{}X}", raw, 2 * field.width);
}

}  // namespace armjig
