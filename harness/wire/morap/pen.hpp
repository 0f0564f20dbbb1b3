// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/bytes.hpp"
#include "harness/core/time.hpp"

/// The pen end-effector: an Arduino-style board with a servo, on the same bus as the motor nodes.
/// There is nothing to read from it. Source: docs/spec/morap.md, section Pen.
namespace armjig::morap::pen {

inline constexpr std::uint8_t kAddress = 0x19;

/// The first byte of a write. Its numbers mean something else to motor nodes.
enum class CommandId : std::uint8_t { kDeploy = 1, kRetract = 2, kSetPosition = 7 };

/// That it needs between two commands.
inline constexpr Duration kPause = std::chrono::milliseconds{25};

inline constexpr int kDeployedDegrees = 8;
inline constexpr int kRetractedDegrees = 45;

/// One write.
struct Command {
  CommandId id{};
  std::uint8_t position{};  ///< of `kSetPosition`: 0 retracted to 255 deployed

  friend bool operator==(const Command&, const Command&) = default;
};

[[nodiscard]] constexpr BoundedBytes<2> encode(Command command) noexcept {
  BoundedBytes<2> out;
  out.push_back(static_cast<std::byte>(command.id));
  if (command.id == CommandId::kSetPosition) out.push_back(std::byte{command.position});
  return out;
}

/// The servo angle of a position byte: 45 for 0, 8 for 255, divided towards zero between.
[[nodiscard]] constexpr int servo_degrees(std::uint8_t position) noexcept {
  return kRetractedDegrees + (kDeployedDegrees - kRetractedDegrees) * position / 255;
}

/// The angle that the data bytes of a write ask for. Whatever is neither deploying nor a complete
/// position retracts. Requires at least one byte; those that the command does not need are not
/// looked at (a real pen hangs on them).
[[nodiscard]] constexpr int servo_degrees(Bytes data) noexcept {
  const CommandId id{std::to_integer<std::uint8_t>(data[0])};
  if (id == CommandId::kDeploy) return kDeployedDegrees;
  if (id != CommandId::kSetPosition || data.size() < 2) return kRetractedDegrees;
  return servo_degrees(std::to_integer<std::uint8_t>(data[1]));
}

}  // namespace armjig::morap::pen
