// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/jaco_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "harness/arm/models.hpp"

namespace armjig::kinovazed::emulation {
namespace {

using Vector6 = std::array<double, 6>;
using Matrix6 = std::array<Vector6, 6>;

constexpr double kRadian = std::numbers::pi / 180;

const arm::Arm& model() noexcept {
  static const auto kModel = arm::jaco(arm::JacoVariant::kJaco2Curved);
  return kModel;
}

arm::Pose hand(JointAngles angles) noexcept {
  for (double& angle : angles) angle *= kRadian;
  return arm::forward(model(), angles);
}

/// How far `is` from `wanted`: metres, then a rotation vector in radians (exact for small ones).
Vector6 error(const arm::Pose& wanted, const arm::Pose& is) noexcept {
  const auto way = wanted.position - is.position;
  const auto turn = 0.5 * (cross(is.rotation.x_axis(), wanted.rotation.x_axis()) +
                           cross(is.rotation.y_axis(), wanted.rotation.y_axis()) +
                           cross(is.rotation.z_axis(), wanted.rotation.z_axis()));
  return {way.x, way.y, way.z, turn.x, turn.y, turn.z};
}

double norm(const Vector6& vector) noexcept {
  double square = 0;
  for (const double value : vector) square += value * value;
  return std::sqrt(square);
}

/// Solves by elimination with pivots; the matrix is positive definite thanks to the damping.
Vector6 solve_linear(Matrix6 matrix, Vector6 right) noexcept {
  for (std::size_t column = 0; column < 6; ++column) {
    auto pivot = column;
    for (std::size_t row = column + 1; row < 6; ++row) {
      if (std::abs(matrix[row][column]) > std::abs(matrix[pivot][column])) pivot = row;
    }
    std::swap(matrix[column], matrix[pivot]);
    std::swap(right[column], right[pivot]);
    for (std::size_t row = column + 1; row < 6; ++row) {
      const double factor = matrix[row][column] / matrix[column][column];
      for (std::size_t k = column; k < 6; ++k) matrix[row][k] -= factor * matrix[column][k];
      right[row] -= factor * right[column];
    }
  }
  Vector6 result{};
  for (std::size_t row = 6; row-- > 0;) {
    double sum = right[row];
    for (std::size_t k = row + 1; k < 6; ++k) sum -= matrix[row][k] * result[k];
    result[row] = sum / matrix[row][row];
  }
  return result;
}

/// One step of damped least squares, in degrees.
Vector6 step(const JointAngles& angles, const Vector6& wrong) noexcept {
  constexpr double kProbe = 1e-4;  // degrees
  constexpr double kDamping = 1e-3;
  const auto here = hand(angles);
  Matrix6 jacobian{};  // [joint][component]
  for (std::size_t i = 0; i < 6; ++i) {
    auto moved = angles;
    moved[i] += kProbe;
    jacobian[i] = error(hand(moved), here);
    for (double& value : jacobian[i]) value /= kProbe * kRadian;
  }
  Matrix6 normal{};
  Vector6 right{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      for (std::size_t k = 0; k < 6; ++k) normal[i][j] += jacobian[i][k] * jacobian[j][k];
    }
    normal[i][i] += kDamping * kDamping;
    for (std::size_t k = 0; k < 6; ++k) right[i] += jacobian[i][k] * wrong[k];
  }
  auto result = solve_linear(normal, right);
  const double largest =
      std::abs(*std::ranges::max_element(result, {}, [](double value) { return std::abs(value); }));
  constexpr double kLongest = 0.3;  // radians in one step
  const double scale = largest > kLongest ? kLongest / largest : 1;
  for (double& value : result) value *= scale / kRadian;
  return result;
}

bool is_in_range(JointAngles angles) noexcept {
  for (const std::size_t j : {1U, 2U}) angles[j] -= 360 * std::floor(angles[j] / 360);
  for (double& angle : angles) angle *= kRadian;
  return arm::first_outside(model(), angles) == angles.size();
}

}  // namespace

Pose forward(const JointAngles& angles) noexcept {
  const auto [rotation, position] = hand(angles);
  const auto single = [](const arm::Vector3& v) {
    return std::array{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  const auto& rows = rotation.rows;
  return pose_of({{single(rows[0]), single(rows[1]), single(rows[2])}, single(position)});
}

JointAngles turned(JointAngles angles, const std::array<double, 6>& speeds,
                   double seconds) noexcept {
  for (std::size_t j = 0; j < angles.size(); ++j) {
    const auto& joint = model().joints[j];
    angles[j] = std::clamp(angles[j] + speeds[j] * joint.max_speed / kRadian * seconds,
                           joint.lower / kRadian, joint.upper / kRadian);
  }
  return angles;
}

std::optional<JointAngles> solve(const Pose& pose, const JointAngles& seed) noexcept {
  const auto frame = frame_of(pose);
  const auto vector = [](const std::array<float, 3>& v) { return arm::Vector3{v[0], v[1], v[2]}; };
  const auto& rows = frame.rotation;
  const arm::Pose wanted{{{vector(rows[0]), vector(rows[1]), vector(rows[2])}},
                         vector(frame.translation)};
  constexpr int kSteps = 200;
  constexpr double kClose = 1e-5;
  // Other elbows and wrists, should the way from the seed not lead there.
  constexpr std::array<JointAngles, 4> kOtherSeeds{{kReadyAngles,
                                                    {0, 190, 110, 190, 40, 0},
                                                    {90, 190, 150, 200, 110, 200},
                                                    {270, 130, 90, 70, 110, 130}}};
  for (std::size_t i = 0; i <= kOtherSeeds.size(); ++i) {
    auto angles = i == 0 ? seed : kOtherSeeds[i - 1];
    for (int n = 0; n < kSteps; ++n) {
      const auto wrong = error(wanted, hand(angles));
      if (norm(wrong) < kClose) {
        if (is_in_range(angles)) return angles;
        break;
      }
      const auto move = step(angles, wrong);
      for (std::size_t j = 0; j < 6; ++j) angles[j] += move[j];
    }
  }
  return std::nullopt;
}

}  // namespace armjig::kinovazed::emulation
