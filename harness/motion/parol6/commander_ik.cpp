// SPDX-License-Identifier: Apache-2.0
#include "harness/motion/parol6/commander_ik.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "harness/arm/angle.hpp"
#include "harness/arm/jacobian.hpp"

namespace armjig::parol6::planning {
namespace {

using std::numbers::pi;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// As the shipped program has it: exact for a turn by pi about a main axis only.
arm::Vector3 angle_axis(const arm::Rotation& r) noexcept {
  const arm::Vector3 l{r.rows[2].y - r.rows[1].z, r.rows[0].z - r.rows[2].x,
                       r.rows[1].x - r.rows[0].y};
  const double length = arm::norm(l);
  const double trace = r.rows[0].x + r.rows[1].y + r.rows[2].z;
  if (length != 0) return std::atan2(length, trace - 1) / length * l;
  if (trace > 0) return {};
  return pi / 2 * arm::Vector3{r.rows[0].x + 1, r.rows[1].y + 1, r.rows[2].z + 1};
}

Vector6 error_between(const arm::Pose& from, const arm::Pose& to) noexcept {
  const auto p = to.position - from.position;
  const auto a = angle_axis(to.rotation * inverse(from.rotation));
  return (Vector6() << p.x, p.y, p.z, a.x, a.y, a.z).finished();
}

Matrix6 jacobian_of(const arm::Arm& arm, const arm::SixJoints& joints) noexcept {
  const auto columns = arm::jacobian(arm, joints);
  Matrix6 matrix;
  for (Eigen::Index j = 0; j < 6; ++j) {
    const auto& [v, w] = columns[static_cast<std::size_t>(j)];
    matrix.col(j) << v.x, v.y, v.z, w.x, w.y, w.z;
  }
  return matrix;
}

}  // namespace

CommanderIkAnswer commander_ik(const arm::Arm& arm, const arm::Pose& pose,
                               const arm::SixJoints& seed, int iterations) noexcept {
  constexpr double kGoodEnough = 1e-10;
  constexpr double kDamping = 0.001;
  auto joints = seed;
  for (int i = 1; i <= iterations; ++i) {
    const auto error = error_between(forward(arm, joints), pose);
    const double squared = 0.5 * error.squaredNorm();
    if (squared < kGoodEnough) return {joints, true, i};
    const auto jacobian = jacobian_of(arm, joints);
    const Matrix6 normal =
        jacobian.transpose() * jacobian + (squared + kDamping) * Matrix6::Identity();
    const Vector6 way = normal.partialPivLu().solve(jacobian.transpose() * error);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      joints[j] = arm::wrapped(joints[j] + way[static_cast<Eigen::Index>(j)]);
    }
  }
  return {joints, false, iterations};
}

}  // namespace armjig::parol6::planning
