// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "harness/arm/pose.hpp"

namespace armjig::motion {

/// Which way round a tool turns.
enum class Turn : std::uint8_t {
  kShorter,
  kUncorrected,  ///< from one unit quaternion with w >= 0 to the other, be it the longer way
};

/// The straight way from one pose to another: the position on a line, the orientation about one
/// axis, both in proportion.
class PoseLine {
 public:
  PoseLine(const arm::Pose& from, const arm::Pose& to, Turn turn = Turn::kShorter) noexcept;

  /// After a share of the way, 0 to 1.
  [[nodiscard]] arm::Pose at(double share) const noexcept;

  /// By how much the tool turns, radians: 0 to pi on the shorter way, up to 2 pi uncorrected. Close
  /// to that `at` divides by nearly zero.
  [[nodiscard]] double turn() const noexcept { return 2 * angle_; }

 private:
  using Quaternion = std::array<double, 4>;  ///< w, x, y, z

  arm::Vector3 from_{};
  arm::Vector3 way_{};
  Quaternion first_{};
  Quaternion second_{};
  double angle_{};  ///< between the quaternions: half of the tool's turn
};

}  // namespace armjig::motion
