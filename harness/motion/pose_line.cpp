// SPDX-License-Identifier: Apache-2.0
#include "harness/motion/pose_line.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace armjig::motion {
namespace {

/// With w >= 0.
Eigen::Vector4d quaternion_of(const arm::Rotation& r) noexcept {
  Eigen::Matrix3d matrix;
  matrix << r.rows[0].x, r.rows[0].y, r.rows[0].z, r.rows[1].x, r.rows[1].y, r.rows[1].z,
      r.rows[2].x, r.rows[2].y, r.rows[2].z;
  const Eigen::Quaterniond q{matrix};
  const double side = q.w() < 0 ? -1 : 1;
  return side * Eigen::Vector4d{q.w(), q.x(), q.y(), q.z()};
}

arm::Rotation rotation_of(const Eigen::Vector4d& q) noexcept {
  const Eigen::Matrix3d m = Eigen::Quaterniond{q[0], q[1], q[2], q[3]}.toRotationMatrix();
  return {{arm::Vector3{m(0, 0), m(0, 1), m(0, 2)}, arm::Vector3{m(1, 0), m(1, 1), m(1, 2)},
           arm::Vector3{m(2, 0), m(2, 1), m(2, 2)}}};
}

}  // namespace

PoseLine::PoseLine(const arm::Pose& from, const arm::Pose& to, Turn turn) noexcept
    : from_{from.position}, way_{to.position - from.position} {
  const auto first = quaternion_of(from.rotation);
  auto second = quaternion_of(to.rotation);
  if (turn == Turn::kShorter && first.dot(second) < 0) second = -second;
  angle_ = std::acos(std::clamp(first.dot(second), -1.0, 1.0));
  Eigen::Vector4d::Map(first_.data()) = first;
  Eigen::Vector4d::Map(second_.data()) = second;
}

arm::Pose PoseLine::at(double share) const noexcept {
  const auto first = Eigen::Vector4d::Map(first_.data());
  const auto second = Eigen::Vector4d::Map(second_.data());
  const auto position = from_ + share * way_;
  constexpr double kNoTurn = 10 * std::numeric_limits<double>::epsilon();
  if (angle_ < kNoTurn) return {rotation_of(first), position};
  const Eigen::Vector4d between =
      (std::sin((1 - share) * angle_) * first + std::sin(share * angle_) * second) /
      std::sin(angle_);
  return {rotation_of(between.normalized()), position};
}

}  // namespace armjig::motion
