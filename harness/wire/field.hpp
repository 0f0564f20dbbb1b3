// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "harness/core/bytes.hpp"

namespace armjig {

/// How the bytes of a field become a number. Multi-byte fields are big-endian but for those that
/// say otherwise.
enum class Encoding : std::uint8_t {
  kUnsigned,
  kSigned,          ///< two's complement in the width of the field
  kBits,            ///< one byte of flags; `Field::bits` names them from bit 7 down
  kCode,            ///< one byte with named values; a value without a name keeps its number
  kLiteral,         ///< the same bytes in every valid message
  kUnsignedLittle,  ///< little-endian
  kFloatLittle,     ///< IEEE single precision, little-endian; as a number its 32 bits
};

/// Where a field stands.
enum class Place : std::uint8_t {
  kBytes,  ///< `width` bytes at `offset`
  kPiece,  ///< text: the piece number `offset` of a line that colons divide; a decimal number, or
           ///< with `kCode` a word. What is neither reads as -1
};

struct NamedValue {
  std::int64_t value{};
  std::string_view name;
};

/// One field of a message: everything that text, JSON, comparison, mutation and documentation need.
/// Codecs do not use it; a test holds the two together.
struct Field {
  std::string_view name;  ///< dotted, as in `speed.j1`
  std::uint16_t offset{};
  std::uint8_t width{};  ///< in bytes, 1 to 4; 0 for a piece
  Encoding encoding{};
  std::string_view unit;
  std::string_view meaning;
  std::span<const std::string_view> bits{};  ///< eight names from bit 7 down; empty: no meaning
  std::span<const NamedValue> values{};      ///< for `kCode`
  std::int64_t literal{};                    ///< for `kLiteral`, read as `kUnsigned`
  Place place = Place::kBytes;
};

/// The number in the field. Requires a message at least `offset + width` long, or one with enough
/// pieces.
[[nodiscard]] std::int64_t field_value(const Field& field, Bytes message) noexcept;

/// That value as a quantity, whatever its bits mean.
[[nodiscard]] double number_of(const Field& field, std::int64_t value) noexcept;

/// Whether the field says what is so, and not how much.
[[nodiscard]] bool is_state(const Field& field) noexcept;

/// Writes the low `width` bytes of `value`. Requires a field of `kBytes`.
void set_field_value(const Field& field, std::span<std::byte> message, std::int64_t value) noexcept;

/// The value for people: `-3000 steps/s`, `123 (jog)`, `in1 estop_released (0x8F)`.
[[nodiscard]] std::string field_text(const Field& field, std::int64_t value);

/// The field of that name, or nullptr.
[[nodiscard]] const Field* find_field(std::span<const Field> fields,
                                      std::string_view name) noexcept;

}  // namespace armjig
