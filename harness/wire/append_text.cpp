// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/append_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <iterator>

#include "harness/wire/brief.hpp"

namespace armjig {
namespace {

constexpr std::string_view kDigits = "0123456789ABCDEF";

/// The low `digits` digits.
void append_hex_number(std::string& out, std::int64_t value, unsigned digits) {
  out += "0x";
  for (; digits > 0; --digits)
    out += kDigits[static_cast<std::uint64_t>(value) >> 4 * (digits - 1) & 0xF];
}

void append_bits(std::string& out, const Field& field, std::int64_t value) {
  for (std::size_t i = 0; i < field.bits.size(); ++i) {
    if ((value >> (7 - i) & 1) == 0 || field.bits[i].empty()) continue;
    out += field.bits[i];
    out += ' ';
  }
  out += '(';
  // A line may hold any number.
  if (value >= 0 && value <= 0xFF) {
    append_hex_number(out, value, 2);
  } else {
    out += fmt::format("0x{:02X}", value);
  }
  out += ')';
}

void append_code(std::string& out, const Field& field, std::int64_t value) {
  append_number(out, value);
  const auto named = std::ranges::find(field.values, value, &NamedValue::value);
  if (named == field.values.end()) return;
  out += " (";
  out += named->name;
  out += ')';
}

}  // namespace

void append_number(std::string& out, std::int64_t value) {
  char digits[20];
  const auto end = std::to_chars(std::begin(digits), std::end(digits), value).ptr;
  out.append(std::begin(digits), end);
}

void append_hex(std::string& out, Bytes bytes) {
  constexpr std::string_view kLowDigits = "0123456789abcdef";
  for (const auto byte : bytes) {
    out += kLowDigits[std::to_integer<unsigned>(byte) >> 4];
    out += kLowDigits[std::to_integer<unsigned>(byte) & 0x0F];
  }
}

void append_field_text(std::string& out, const Field& field, std::int64_t value) {
  switch (field.encoding) {
    case Encoding::kBits:
      return append_bits(out, field, value);
    case Encoding::kCode:
      return append_code(out, field, value);
    case Encoding::kLiteral:
      return append_hex_number(out, value, 2U * field.width);
    case Encoding::kFloatLittle:
      out += fmt::format("{}", std::bit_cast<float>(static_cast<std::uint32_t>(value)));
      break;
    case Encoding::kUnsigned:
    case Encoding::kSigned:
    case Encoding::kUnsignedLittle:
      append_number(out, value);
      break;
  }
  if (field.unit.empty()) return;
  out += ' ';
  out += field.unit;
}

void append_line(std::string& out, const Message& message) {
  constexpr std::size_t kDirectionWidth = 11;
  const auto direction = to_string(message.direction);
  out += direction;
  out.append(kDirectionWidth + 1 - direction.size(), ' ');
  append_content(out, message);
}

void append_content(std::string& out, const Message& message) {
  constexpr std::size_t kMany = 8;
  out += message.name;
  if (!message.fault.empty()) {
    out += fmt::format(": {}: {}", message.fault, to_short_dump(message.raw));
    return;
  }
  for (const auto& field : message.fields) {
    if (field.encoding == Encoding::kLiteral) continue;
    const auto value = field_value(field, message.raw);
    if (value == 0 && message.fields.size() > kMany) continue;
    out += "  ";
    out += field.name;
    out += ' ';
    append_field_text(out, field, value);
  }
}

}  // namespace armjig
