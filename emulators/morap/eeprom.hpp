// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "emulators/morap/profile.hpp"
#include "harness/wire/morap/controller_set.hpp"

namespace armjig::morap::emulation {

/// Motor and gear as the node believes them to be.
struct MotorConstants {
  float resistance{};       ///< ohm, driver included
  float inductance{};       ///< henry; stored, never used
  float torque_constant{};  ///< N m / A and V s, at the motor
  float gear_ratio{};
  float friction{};  ///< N m s, at the output shaft
  float efficiency{};
  float rated_current{};    ///< A
  float pulses_per_turn{};  ///< of the encoder; four counts each
};

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

/// The contents of the two joints that were built: a Maxon DCX22L with gear 231:1, and a DCX26L
/// with 149:1.
[[nodiscard]] Eeprom dcx22l(std::uint8_t node = 2) noexcept;
[[nodiscard]] Eeprom dcx26l(std::uint8_t node = 1) noexcept;

}  // namespace armjig::morap::emulation
