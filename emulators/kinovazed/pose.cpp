// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/pose.hpp"

#include <cmath>

namespace armjig::kinovazed::emulation {
namespace {

constexpr float kStill = 1e-5F;
constexpr float kRightAngle = 1.5708F;

std::array<float, 6> components(const Pose& pose) noexcept {
  return {pose.x, pose.y, pose.z, pose.pitch, pose.yaw, pose.roll};
}

}  // namespace

Frame frame_of(const Pose& pose) noexcept {
  const float sa = std::sin(pose.pitch);
  const float ca = std::cos(pose.pitch);
  const float sb = std::sin(pose.yaw);
  const float cb = std::cos(pose.yaw);
  const float sc = std::sin(pose.roll);
  const float cc = std::cos(pose.roll);
  return {{{{cb * cc, -cb * sc, sb},
            {ca * sc + sa * cc * sb, ca * cc - sa * sc * sb, -sa * cb},
            {sa * sc - ca * cc * sb, sa * cc + ca * sc * sb, ca * cb}}},
          {pose.x, pose.y, pose.z}};
}

Pose pose_of(const Frame& frame) noexcept {
  const auto& r = frame.rotation;
  const auto& t = frame.translation;
  Pose pose{.x = t[0], .y = t[1], .z = t[2]};
  if (r[0][2] >= 1) {
    pose.pitch = std::atan2(r[1][0], r[1][1]);
    pose.yaw = kRightAngle;
  } else if (r[0][2] <= -1) {
    pose.pitch = -std::atan2(r[1][0], r[1][1]);
    pose.yaw = -kRightAngle;
  } else {
    pose.pitch = std::atan2(-r[1][2], r[2][2]);
    pose.yaw = std::asin(r[0][2]);
    pose.roll = std::atan2(-r[0][1], r[0][0]);
  }
  return pose;
}

Frame inverse(const Frame& frame) noexcept {
  Frame inverted;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      inverted.rotation[i][j] = frame.rotation[j][i];
      inverted.translation[i] -= frame.rotation[j][i] * frame.translation[j];
    }
  }
  return inverted;
}

Pose transformed(const Frame& origin, const Pose& point) noexcept {
  const auto local = frame_of(point);
  Frame result{.rotation = {}, .translation = origin.translation};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      result.translation[i] += origin.rotation[i][j] * local.translation[j];
      for (std::size_t k = 0; k < 3; ++k) {
        result.rotation[i][k] += origin.rotation[i][j] * local.rotation[j][k];
      }
    }
  }
  return pose_of(result);
}

bool is_in_workspace(const Pose& pose) noexcept {
  // Only the lower limit in x is compared in single precision.
  constexpr auto kLeastX = static_cast<float>(-workspace::kX);
  const bool is_x_inside = pose.x >= kLeastX && static_cast<double>(pose.x) <= workspace::kX;
  return is_x_inside && std::abs(static_cast<double>(pose.y)) <= workspace::kY &&
         static_cast<double>(pose.z) < workspace::kZ;
}

bool has_changed(const Pose& before, const Pose& after) noexcept {
  const auto a = components(before);
  const auto b = components(after);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(a[i] - b[i]) >= kStill) return true;
  }
  return false;
}

bool has_reached(const Pose& pose, const Pose& target, const Reach& reach) noexcept {
  const auto a = components(pose);
  const auto b = components(target);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(a[i] - b[i]) >= (i < 3 ? reach.metres : reach.radians)) return false;
  }
  return true;
}

}  // namespace armjig::kinovazed::emulation
