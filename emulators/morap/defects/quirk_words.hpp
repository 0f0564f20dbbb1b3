// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "emulators/morap/defects/quirks.hpp"
#include "harness/wire/morap/message.hpp"

/// The words in which quirks are written.
namespace armjig::morap::emulation {

/// Those about parameter messages, tuning and what is cut short.
[[nodiscard]] std::span<const Quirk> programming_quirks() noexcept;

using Words = std::vector<std::byte>;
using Change = void (*)(Words& bytes, QuirkMemory& memory, const Node& node);

inline CommandId id_of(const Words& command) noexcept {
  return CommandId{std::to_integer<std::uint8_t>(command[0])};
}
inline bool is(const Words& command, CommandId id) noexcept {
  return !command.empty() && id_of(command) == id;
}
inline void become(Words& command, CommandId id) { command.assign(1, static_cast<std::byte>(id)); }

/// Makes a message that is refused at its third byte, or whatever else is left of a command.
inline void become_refused(Words& command) {
  command = {std::byte{32}, std::byte{0}, std::byte{200}, std::byte{0}, std::byte{5}};
}

inline void set_float(Words& bytes, std::size_t place, float value) {
  std::ranges::copy(morap::encode(value), bytes.begin() + static_cast<std::ptrdiff_t>(place));
}
inline float float_at(const Words& bytes, std::size_t place) {
  return load_f32_le(slice<4>(Bytes{bytes}, place));
}

inline bool answers_set(const Node& node) noexcept {
  return find_reading(node.selected())->kind == ReadKind::kControllerSet;
}

}  // namespace armjig::morap::emulation
