// SPDX-License-Identifier: Apache-2.0
#include "harness/motion/parol6/cartesian_jog.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <optional>

#include "harness/arm/models.hpp"
#include "harness/motion/parol6/conversion.hpp"

namespace armjig::parol6::planning {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Vector6 vector_of(const arm::Twist& twist) noexcept {
  const auto& [v, w] = twist;
  return (Vector6() << v.x, v.y, v.z, w.x, w.y, w.z).finished();
}

/// In the base's frame.
arm::Twist wanted_twist(const CartesianJog& jog, const arm::Rotation& tool) noexcept {
  if (jog.frame == JogFrame::kWorld) return jog.velocity;
  return {tool * jog.velocity.linear, tool * jog.velocity.angular};
}

/// Joint speeds, rad/s, that give the tool this twist; none where the arm can no more than nearly.
std::optional<Vector6> joint_speeds(const arm::Jacobian& jacobian, const Vector6& twist) noexcept {
  constexpr double kDamping = 1e-6;
  constexpr double kNearly = 0.01;  // of the twist
  Matrix6 matrix;
  for (Eigen::Index j = 0; j < 6; ++j) {
    matrix.col(j) = vector_of(jacobian[static_cast<std::size_t>(j)]);
  }
  const Matrix6 normal = matrix.transpose() * matrix + kDamping * Matrix6::Identity();
  Vector6 speeds = normal.ldlt().solve(matrix.transpose() * twist);
  if ((matrix * speeds - twist).norm() > kNearly * twist.norm()) return std::nullopt;
  return speeds;
}

}  // namespace

CartesianJogger::CartesianJogger() : arm_{arm::parol6_commander()} {}

tl::expected<JointSpeeds, Refusal> CartesianJogger::speeds(const CartesianJog& jog,
                                                           const JointSteps& now) const noexcept {
  const auto here = radians_of(now);
  const auto twist = wanted_twist(jog, forward(arm_, here).rotation);
  const auto wanted = joint_speeds(arm::jacobian(arm_, here), vector_of(twist));
  if (!wanted) return tl::unexpected{Refusal{.reason = Refusal::Reason::kSingular}};
  JointSpeeds speeds;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double speed = step_rate_of(j, (*wanted)[static_cast<Eigen::Index>(j)]);
    const double limit = kJoints[j].max_jog.value;
    if (std::abs(speed) > limit) {
      return tl::unexpected{Refusal{Refusal::Reason::kTooFast, j, speed, limit}};
    }
    const auto& range = kJoints[j];
    const double end = (speed > 0 ? range.upper : range.lower).value;
    const double angle = degrees_of(j, now[j]);
    speeds[j] = StepsPerSecond{cut_off(speed)};
    const bool goes_beyond = speeds[j].value > 0 ? angle >= end : angle <= end;
    if (speeds[j].value != 0 && goes_beyond) {
      return tl::unexpected{Refusal{Refusal::Reason::kOutOfLimits, j, angle, end}};
    }
  }
  return speeds;
}

}  // namespace armjig::parol6::planning
