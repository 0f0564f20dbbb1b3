// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/orientation.hpp"

#include <array>
#include <cmath>

namespace armjig::arm {
namespace {

constexpr std::array kConventions{
    ConventionName{Convention::kCommander, "commander", "R = Rx(rz) Ry(ry) Rz(rx)"},
    ConventionName{Convention::kXyz, "xyz", "R = Rx(rx) Ry(ry) Rz(rz)"},
    ConventionName{Convention::kRollPitchYaw, "rpy", "R = Rz(rz) Ry(ry) Rx(rx)"},
};

/// Below that cosine of the middle angle the outer two cannot be told apart.
constexpr double kGimbalLock = 1e-9;

struct XyzAngles {
  double x{};
  double y{};
  double z{};
};

/// Of R = Rx Ry Rz; z is 0 in gimbal lock.
XyzAngles xyz_angles(const Rotation& r) noexcept {
  const auto& [first, second, third] = r.rows;
  const double cosine = std::hypot(first.x, first.y);
  const double y = std::atan2(first.z, cosine);
  if (cosine > kGimbalLock) {
    return {std::atan2(-second.z, third.z), y, std::atan2(-first.y, first.x)};
  }
  const double side = first.z > 0 ? 1 : -1;
  return {side * std::atan2(second.x, second.y), y, 0};
}

}  // namespace

std::span<const ConventionName> conventions() noexcept { return kConventions; }

Rotation rotation_of(const Angles& angles, Convention convention) noexcept {
  const auto [rx, ry, rz] = angles;
  switch (convention) {
    case Convention::kCommander:
      return rotation_x(rz) * rotation_y(ry) * rotation_z(rx);
    case Convention::kXyz:
      return rotation_x(rx) * rotation_y(ry) * rotation_z(rz);
    case Convention::kRollPitchYaw:
      return rotation_z(rz) * rotation_y(ry) * rotation_x(rx);
  }
  return {};
}

Angles angles_of(const Rotation& rotation, Convention convention) noexcept {
  switch (convention) {
    case Convention::kCommander: {
      const auto [x, y, z] = xyz_angles(rotation);
      return {z, y, x};
    }
    case Convention::kXyz: {
      const auto [x, y, z] = xyz_angles(rotation);
      return {x, y, z};
    }
    case Convention::kRollPitchYaw: {
      // The transpose of Rz(c) Ry(b) Rx(a) is Rx(-a) Ry(-b) Rz(-c).
      const auto [x, y, z] = xyz_angles(inverse(rotation));
      return {-x, -y, -z};
    }
  }
  return {};
}

}  // namespace armjig::arm
