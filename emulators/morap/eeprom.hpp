// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "emulators/morap/profile.hpp"
#include "harness/wire/morap/controller_set.hpp"
#include "harness/wire/morap/figures.hpp"

namespace armjig::morap::emulation {

/// What a node reads from its EEPROM when it starts.
struct Eeprom {
  static constexpr std::uint16_t kMarker = 0xBEEF;

  std::uint16_t marker = kMarker;
  std::uint8_t node = 0;
  MotorConstants motor;
  ControllerSet position;
  ControllerSet speed;
};

/// What a node sends of a set, with its checksum. It trusts the counts: one above four leads it on
/// into the fields after the coefficients, as they lie in EEPROM and memory
/// (recording random/mini-count5-active). Zeros stand for what comes after the set.
inline constexpr std::size_t kLongestReadBack = kSmallestSetSize + std::size_t{3} * 4 * UINT8_MAX;
using ReadBack = BoundedBytes<kLongestReadBack>;
[[nodiscard]] ReadBack read_back(const ControllerSet& set) noexcept;

/// 83 words, low byte first.
inline constexpr std::size_t kEepromSize = 166;
using EepromImage = std::array<std::byte, kEepromSize>;

/// Reads an image. Counts above four, with which a node could not start, become four.
[[nodiscard]] Eeprom decode_eeprom(std::span<const std::byte, kEepromSize> image) noexcept;
/// Unused bytes are those of an erased EEPROM.
[[nodiscard]] EepromImage encode(const Eeprom& eeprom) noexcept;

/// Whether a node with these contents joins the bus: marker, kinds of the two controllers and
/// identifier have to be right.
[[nodiscard]] bool is_usable(const Eeprom& eeprom, const Profile& profile) noexcept;

/// The contents of the two joints that were built, with their controllers.
[[nodiscard]] Eeprom dcx22l(std::uint8_t node = 2) noexcept;
[[nodiscard]] Eeprom dcx26l(std::uint8_t node = 1) noexcept;
[[nodiscard]] Eeprom eeprom_of(const KnownMotor& motor, std::uint8_t node) noexcept;

}  // namespace armjig::morap::emulation
