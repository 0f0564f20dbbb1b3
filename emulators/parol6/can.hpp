// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "harness/core/bytes.hpp"

namespace armjig::parol6::emulation {

/// A CAN data frame with an 11-bit identifier.
struct CanFrame {
  std::uint16_t id{};
  std::uint8_t size{};  ///< 0 to 8
  std::array<std::byte, 8> data{};

  [[nodiscard]] Bytes payload() const noexcept { return std::span{data}.first(size); }

  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

/// The gripper's use of the identifier: node (4 bits), command (6 bits), error (1 bit).
enum class GripperCan : std::uint8_t {
  kClearError = 1,
  kAnswer = 60,
  kSetPoint = 61,  ///< five bytes, or none as a poll
  kCalibrate = 62,
};

[[nodiscard]] constexpr std::uint16_t can_id(std::uint8_t node, GripperCan command) noexcept {
  return static_cast<std::uint16_t>((node & 0x0FU) << 7 | static_cast<unsigned>(command) << 1);
}
[[nodiscard]] constexpr std::uint8_t can_node(std::uint16_t id) noexcept {
  return static_cast<std::uint8_t>(id >> 7 & 0x0FU);
}
[[nodiscard]] constexpr GripperCan can_command(std::uint16_t id) noexcept {
  return GripperCan{static_cast<std::uint8_t>(id >> 1 & 0x3FU)};
}
inline constexpr std::uint16_t kCanErrorBit = 1;

}  // namespace armjig::parol6::emulation
