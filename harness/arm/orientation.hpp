// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "harness/arm/pose.hpp"

namespace armjig::arm {

/// What three numbers named Rx, Ry, Rz mean. Each convention is somebody's, and the same numbers
/// mean different orientations in them: a pose without its convention says nothing.
enum class Convention : std::uint8_t {
  /// R = Rx(third) Ry(second) Rz(first): what the PAROL6 commander takes and displays. Its "Rx"
  /// turns about the tool's z axis.
  kCommander,
  /// R = Rx(first) Ry(second) Rz(third): the PAROL6 Python API, relative moves of the commander,
  /// and Kinova's ThetaX, ThetaY, ThetaZ (pitch, yaw, roll of KinovaZED).
  kXyz,
  /// R = Rz(third) Ry(second) Rx(first): roll, pitch, yaw of URDF.
  kRollPitchYaw,
};

struct ConventionName {
  Convention convention{};
  std::string_view name;
  std::string_view formula;
};
/// All of them: `commander`, `xyz`, `rpy`.
[[nodiscard]] std::span<const ConventionName> conventions() noexcept;

/// Radians, in the order in which people write them.
struct Angles {
  double rx{};
  double ry{};
  double rz{};
};

[[nodiscard]] Rotation rotation_of(const Angles& angles, Convention convention) noexcept;

/// The inverse, `ry` within +-pi/2. Where only a sum or difference of the outer two is determined
/// (|ry| = pi/2), one of them is 0: as the devices' programs do it, `rx` for `kCommander`, `rz` for
/// the others.
[[nodiscard]] Angles angles_of(const Rotation& rotation, Convention convention) noexcept;

}  // namespace armjig::arm
