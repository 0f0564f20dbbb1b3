// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/field.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>

#include "harness/wire/append_text.hpp"

namespace armjig {
namespace {

/// The piece of that number, without the line end.
std::string_view piece(Bytes message, std::size_t number) {
  auto line = as_text(message);
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

double number_of(const Field& field, std::int64_t value) noexcept {
  if (field.encoding != Encoding::kFloatLittle) return static_cast<double>(value);
  return double{std::bit_cast<float>(static_cast<std::uint32_t>(value))};
}

bool is_state(const Field& field) noexcept {
  return field.encoding == Encoding::kBits || field.encoding == Encoding::kCode;
}

void set_field_value(const Field& field, std::span<std::byte> message,
                     std::int64_t value) noexcept {
  auto rest = static_cast<std::uint64_t>(value);
  for (std::size_t i = field.width; i-- > 0; rest >>= 8) {
    message[place_of(field, i)] = static_cast<std::byte>(rest);
  }
}

std::string field_text(const Field& field, std::int64_t value) {
  std::string text;
  append_field_text(text, field, value);
  return text;
}

const Field* find_field(std::span<const Field> fields, std::string_view name) noexcept {
  const auto found = std::ranges::find(fields, name, &Field::name);
  return found == fields.end() ? nullptr : &*found;
}

}  // namespace armjig
