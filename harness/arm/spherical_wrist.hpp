// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "harness/arm/arm.hpp"

namespace armjig::arm {

using SixJoints = std::array<double, 6>;

/// One way to reach a pose.
struct Branch {
  SixJoints joints{};  ///< each in (-pi, pi], whatever the limits
  bool shoulder_back{};
  bool elbow_flipped{};
  bool wrist_flipped{};
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
  std::array<Branch, 8> branches_{};
  std::size_t size_ = 0;
};

/// Inverse kinematics in closed form, for arms of six turning joints whose first axis is at right
/// angles to the second, the second parallel to the third, and whose last three meet in a point at
/// right angles, with any offsets between them: nearly all industrial arms, PAROL6, the Jaco with
/// spherical wrist.
class SphericalWrist {
 public:
  /// Nothing if the arm is of another kind.
  [[nodiscard]] static std::optional<SphericalWrist> of(const Arm& arm);

  /// All postures that reach `pose`; none if it is out of reach. In a singular posture, joint 1
  /// (wrist centre above the base) or joint 4 (wrist straight) is as in `seed`.
  [[nodiscard]] Branches solve(const Pose& pose, const SixJoints& seed = {}) const noexcept;

 private:
  SphericalWrist() = default;
};

/// Turns each joint by whole turns until it is within the limits and there as near to `seed` as
/// can be. Nothing if a joint has no such place.
[[nodiscard]] std::optional<SixJoints> within_limits(const Arm& arm, const SixJoints& joints,
                                                     const SixJoints& seed) noexcept;

/// The branch within the limits that is nearest to `seed`: the smallest largest way of a joint.
[[nodiscard]] std::optional<SixJoints> nearest(const Arm& arm, const Branches& branches,
                                               const SixJoints& seed) noexcept;

}  // namespace armjig::arm
