// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

namespace armjig::kinovazed::emulation {

/// Where the hand is: metres, then radians with R = Rx(pitch) Ry(yaw) Rz(roll), in the arm's base
/// frame. Single precision, as the server computes.
struct Pose {
  float x{};
  float y{};
  float z{};
  float pitch{};
  float yaw{};
  float roll{};

  friend bool operator==(const Pose&, const Pose&) = default;
};

/// The same as a rotation matrix and a translation.
struct Frame {
  std::array<std::array<float, 3>, 3> rotation{};
  std::array<float, 3> translation{};
};

[[nodiscard]] Frame frame_of(const Pose& pose) noexcept;
/// Pitch and roll come out in (-pi, pi], yaw in [-pi/2, pi/2].
[[nodiscard]] Pose pose_of(const Frame& frame) noexcept;
[[nodiscard]] Frame inverse(const Frame& frame) noexcept;
/// `point`, given in `origin`, in the frame that `origin` is given in.
[[nodiscard]] Pose transformed(const Frame& origin, const Pose& point) noexcept;

/// The server's own limits, in metres: of |x|, of |y|, and of z, which stays below it.
namespace workspace {
inline constexpr double kX = 0.8;
inline constexpr double kY = 0.85;
inline constexpr double kZ = 1.15;
}  // namespace workspace

/// It compares single with double precision, so -0.8 is inside and 0.8, 0.85 and -0.85 are not.
[[nodiscard]] bool is_in_workspace(const Pose& pose) noexcept;

/// Whether any component differs by 0.00001 or more.
[[nodiscard]] bool has_changed(const Pose& before, const Pose& after) noexcept;

/// How near to a target counts as there, in each component.
struct Reach {
  float metres = 0.05F;
  float radians = 0.25F;
};

/// Nearer than `reach`; angles as plain numbers (kinovazed.objective.no-wrap).
[[nodiscard]] bool has_reached(const Pose& pose, const Pose& target,
                               const Reach& reach = {}) noexcept;

}  // namespace armjig::kinovazed::emulation
