// SPDX-License-Identifier: Apache-2.0
#include "harness/core/hex.hpp"

#include <cstdint>

namespace armjig {
namespace {

constexpr int kNotADigit = -1;

int digit_value(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return kNotADigit;
}

bool is_separator(char c) noexcept {
  return std::string_view{" \t\r\n,:"}.find(c) != std::string_view::npos;
}

std::string digits_of(Bytes bytes, std::string_view alphabet, std::string_view separator) {
  std::string out;
  out.reserve(bytes.size() * (2 + separator.size()));
  for (const auto byte : bytes) {
    if (!out.empty()) out += separator;
    out += alphabet[std::to_integer<unsigned>(byte) >> 4];
    out += alphabet[std::to_integer<unsigned>(byte) & 0x0F];
  }
  return out;
}

}  // namespace

std::string to_hex(Bytes bytes) { return digits_of(bytes, "0123456789abcdef", ""); }

std::string to_hex_dump(Bytes bytes) { return digits_of(bytes, "0123456789ABCDEF", " "); }

Result<std::vector<std::byte>> from_hex(std::string_view text) {
  std::vector<std::byte> out;
  out.reserve(text.size() / 2);
  int high = kNotADigit;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool between_bytes = high == kNotADigit;
    if (between_bytes && is_separator(text[i])) continue;
    if (between_bytes && text[i] == '0' && i + 1 < text.size() && (text[i + 1] | 0x20) == 'x') {
      ++i;
      continue;
    }
    if (is_separator(text[i])) return fail(ErrorCode::kOddHex, static_cast<std::int32_t>(i));
    const int digit = digit_value(text[i]);
    if (digit == kNotADigit) return fail(ErrorCode::kBadHex, static_cast<std::int32_t>(i));
    if (between_bytes) {
      high = digit;
    } else {
      out.push_back(static_cast<std::byte>(high << 4 | digit));
      high = kNotADigit;
    }
  }
  if (high != kNotADigit) return fail(ErrorCode::kOddHex, static_cast<std::int32_t>(text.size()));
  return out;
}

}  // namespace armjig
