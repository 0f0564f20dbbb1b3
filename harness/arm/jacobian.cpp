// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/jacobian.hpp"

#include <Eigen/Core>
#include <Eigen/SVD>
#include <array>
#include <cassert>
#include <limits>

namespace armjig::arm {
namespace {

/// Six rows, a column for each joint, never on the heap.
using Matrix6N = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints>;

}  // namespace

Jacobian jacobian(const Arm& arm, std::span<const double> joints) noexcept {
  std::array<Pose, kMaxJoints + 1> storage;
  const std::span frames{storage.data(), joints.size() + 1};
  forward_all(arm, joints, frames);
  const auto tool = frames.back().position;
  Jacobian columns(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto axis = frames[j].rotation * arm.joints[j].axis;
    columns[j] = arm.joints[j].kind == Joint::Kind::kPrismatic
                     ? Twist{axis, {}}
                     : Twist{cross(axis, tool - frames[j].position), axis};
  }
  return columns;
}

Dexterity dexterity(const Jacobian& columns, double unit_length) noexcept {
  assert(unit_length > 0);
  Matrix6N matrix{6, static_cast<Eigen::Index>(columns.size())};
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const auto [v, w] = columns[j];
    matrix.col(static_cast<Eigen::Index>(j)) << v.x / unit_length, v.y / unit_length,
        v.z / unit_length, w.x, w.y, w.z;
  }
  if (columns.size() < 6) return {0, 0, std::numeric_limits<double>::infinity()};
  const auto values = matrix.jacobiSvd().singularValues().eval();
  const double smallest = values.minCoeff();
  return {values.prod(), smallest, values.maxCoeff() / smallest};
}

}  // namespace armjig::arm
