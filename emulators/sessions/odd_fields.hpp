// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "emulators/sessions/dice.hpp"
#include "harness/wire/field.hpp"

namespace armjig::sessions {

/// A number that programs get wrong: an end of a range, one beside it, a small one, or any.
[[nodiscard]] inline std::int64_t odd_number(Dice& dice) {
  constexpr std::array<std::int64_t, 15> kEnds{
      0,      1,        -1,       2,        127,
      128,    255,      256,      0x7FFF,   0x8000,
      0xFFFF, 0x7FFFFF, 0x800000, 0xFFFFFF, std::numeric_limits<std::int32_t>::max()};
  switch (dice.between(0, 2)) {
    case 0:
      return dice.one_of(kEnds);
    case 1:
      return dice.between(-100, 100);
    default:
      return dice.between(std::numeric_limits<std::int32_t>::min(),
                          std::numeric_limits<std::int32_t>::max());
  }
}

/// Writes an odd number, or a value that has a name, into one of the message's fields.
inline void spoil_a_field(Dice& dice, std::span<const Field> fields, std::span<std::byte> message) {
  const auto& field = dice.one_of(fields);
  if (field.place != Place::kBytes || field.offset + field.width > message.size()) return;
  const bool is_named = !field.values.empty() && !dice.one_in(3);
  set_field_value(field, message, is_named ? dice.one_of(field.values).value : odd_number(dice));
}

}  // namespace armjig::sessions
