// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "harness/arm/arm.hpp"

namespace armjig::arm {

using SixJoints = std::array<double, 6>;

/// One way to reach a pose.
struct Branch {
  SixJoints joints{};  ///< each in (-pi, pi], whatever the limits
  bool is_shoulder_back{};
  bool is_elbow_flipped{};
  bool is_wrist_flipped{};
};

/// All ways to reach a pose, at most eight.
class Branches {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] const Branch& operator[](std::size_t i) const noexcept { return branches_[i]; }
  [[nodiscard]] const Branch* begin() const noexcept { return branches_.data(); }
  [[nodiscard]] const Branch* end() const noexcept { return branches_.data() + size_; }
  void add(const Branch& branch) noexcept { branches_[size_++] = branch; }

 private:
  std::array<Branch, 8> branches_;
  std::size_t size_ = 0;
};

/// Inverse kinematics in closed form, for arms of six turning joints whose first axis is at right
/// angles to the second, the second parallel to the third, and whose last three meet in a point at
/// right angles, with any offsets between them: nearly all industrial arms, PAROL6, the Jaco with
/// spherical wrist.
class SphericalWrist {
 public:
  /// Nothing if the arm is of another kind.
  [[nodiscard]] static std::optional<SphericalWrist> of(const Arm& arm) noexcept;

  /// All postures that reach `pose`; none if it is out of reach. In a singular posture, joint 1
  /// (wrist above the base's axis) or joint 4 (wrist straight) is as in `seed`.
  [[nodiscard]] Branches solve(const Pose& pose, const SixJoints& seed = {}) const noexcept;

  /// How far a posture is from the three kinds of singularity, each 0 there.
  struct Clearance {
    double shoulder{};  ///< distance of the wrist's centre from axis 1, in the arm's plane, metres
    double elbow{};     ///< sine of the elbow's bend
    double wrist{};     ///< sine of the wrist's bend
  };
  [[nodiscard]] Clearance clearance(const SixJoints& joints) const noexcept;

 private:
  /// A link of the arm's plane: the plane turns about its y axis, and an angle is from z to x.
  struct Link {
    double length{};
    double angle{};  ///< at 0
  };
  /// Joint 1 turned; what is left lies in the arm's plane.
  struct Plane {
    double q1{};
    double x{};  ///< of the wrist's centre, from the shoulder
    double z{};
    bool is_back{};
  };

  SphericalWrist() = default;
  void solve_plane(const Plane& plane, const Rotation& target, const SixJoints& seed,
                   Branches& found) const noexcept;
  void solve_wrist(const Branch& arm, const Rotation& target, double seed,
                   Branches& found) const noexcept;

  // The base frame here: z is axis 1, y is axis 2, its origin is on axis 1. The wrist's frame: z is
  // axis 4, y is axis 5. All joints at 0.
  Pose to_base_;            ///< from the arm's base
  Vector3 centre_in_tool_;  ///< where the last three axes meet
  Rotation tool_to_wrist_;  ///< so that the wrist is Rz(q4) Ry(q5 + bend) Rz(q6)
  Rotation base_to_wrist_;  ///< the wrist's frame seen from the base, transposed
  double wrist_bend_{};     ///< angle between axes 4 and 6
  double shoulder_x_{};
  double shoulder_z_{};
  double lateral_{};  ///< of the wrist's centre, along axis 2 from axis 1
  Link upper_;
  Link fore_;
  double elbow_sign_{};  ///< +1 if axis 3 points as axis 2 does, -1 if against it
};

/// Turns each joint by whole turns until it is within the limits and there as near to `seed` as
/// can be. Nothing if a joint has no such place. A nanoradian beyond a limit counts as at it.
[[nodiscard]] std::optional<SixJoints> within_limits(const Arm& arm, const SixJoints& joints,
                                                     const SixJoints& seed) noexcept;

/// The branch within the limits that is nearest to `seed`: the smallest largest way of a joint.
[[nodiscard]] std::optional<SixJoints> nearest(const Arm& arm, const Branches& branches,
                                               const SixJoints& seed) noexcept;

}  // namespace armjig::arm
