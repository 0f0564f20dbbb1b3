// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/field.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>

namespace armjig {
namespace {

std::string bits_text(const Field& field, std::int64_t value) {
  std::string text;
  for (std::size_t i = 0; i < field.bits.size(); ++i) {
    const bool is_set = (value >> (7 - i) & 1) != 0;
    if (is_set && !field.bits[i].empty()) text += fmt::format("{} ", field.bits[i]);
  }
  return text + fmt::format("(0x{:02X})", value);
}

std::string code_text(const Field& field, std::int64_t value) {
  const auto named = std::ranges::find(field.values, value, &NamedValue::value);
  return named == field.values.end() ? fmt::format("{}", value)
                                     : fmt::format("{} ({})", value, named->name);
}

/// The piece of that number, without the line end.
std::string_view piece(Bytes message, std::size_t number) {
  std::string_view line{reinterpret_cast<const char*>(message.data()), message.size()};
  line = line.substr(0, line.find_first_of("\r\n"));
  for (; number > 0; --number) line.remove_prefix(std::min(line.find(':'), line.size() - 1) + 1);
  return line.substr(0, line.find(':'));
}

std::int64_t piece_value(const Field& field, std::string_view text) {
  if (field.encoding == Encoding::kCode) {
    const auto named = std::ranges::find(field.values, text, &NamedValue::name);
    return named == field.values.end() ? -1 : named->value;
  }
  text.remove_prefix(std::min(text.find_first_not_of(" \t\v\f\r+"), text.size()));
  std::int64_t value = -1;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

std::string number_text(const Field& field, const std::string& number) {
  return field.unit.empty() ? number : fmt::format("{} {}", number, field.unit);
}

/// The place of the byte of rank `rank`, 0 being the most significant.
std::size_t place_of(const Field& field, std::size_t rank) noexcept {
  const bool is_little =
      field.encoding == Encoding::kUnsignedLittle || field.encoding == Encoding::kFloatLittle;
  return field.offset + (is_little ? field.width - 1U - rank : rank);
}

}  // namespace

std::int64_t field_value(const Field& field, Bytes message) noexcept {
  if (field.place == Place::kPiece) return piece_value(field, piece(message, field.offset));
  std::uint64_t raw = 0;
  for (std::size_t i = 0; i < field.width; ++i) {
    raw = raw << 8 | std::to_integer<std::uint64_t>(message[place_of(field, i)]);
  }
  if (field.encoding != Encoding::kSigned) return static_cast<std::int64_t>(raw);
  const int unused_bits = 64 - 8 * field.width;
  return static_cast<std::int64_t>(raw << unused_bits) >> unused_bits;
}

void set_field_value(const Field& field, std::span<std::byte> message,
                     std::int64_t value) noexcept {
  auto rest = static_cast<std::uint64_t>(value);
  for (std::size_t i = field.width; i-- > 0; rest >>= 8) {
    message[place_of(field, i)] = static_cast<std::byte>(rest);
  }
}

std::string field_text(const Field& field, std::int64_t value) {
  switch (field.encoding) {
    case Encoding::kBits:
      return bits_text(field, value);
    case Encoding::kCode:
      return code_text(field, value);
    case Encoding::kLiteral:
      return fmt::format("0x{:0{}X}", value, 2 * field.width);
    case Encoding::kFloatLittle:
      return number_text(
          field, fmt::format("{}", std::bit_cast<float>(static_cast<std::uint32_t>(value))));
    case Encoding::kUnsigned:
    case Encoding::kSigned:
    case Encoding::kUnsignedLittle:
      break;
  }
  return number_text(field, fmt::format("{}", value));
}

const Field* find_field(std::span<const Field> fields, std::string_view name) noexcept {
  const auto found = std::ranges::find(fields, name, &Field::name);
  return found == fields.end() ? nullptr : &*found;
}

}  // namespace armjig
