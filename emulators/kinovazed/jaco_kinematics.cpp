// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/jaco_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace armjig::kinovazed::emulation {
namespace {

using Matrix = std::array<std::array<double, 4>, 3>;  // rotation and translation
using Vector6 = std::array<double, 6>;
using Matrix6 = std::array<Vector6, 6>;

constexpr double kRadian = std::numbers::pi / 180;

/// One link: Rz(theta) Tz(d) Tx(a) Rx(alpha), theta = sign * Q + offset.
struct Link {
  double alpha;
  double a;
  double d;
  double sign;
  double offset;
};
constexpr double kQuarter = std::numbers::pi / 2;
constexpr std::array<Link, 6> kLinks{{{kQuarter, 0, 0.2755, -1, 0},
                                      {std::numbers::pi, 0.41, 0, 1, -kQuarter},
                                      {kQuarter, 0, -0.0098, 1, kQuarter},
                                      {60 * kRadian, 0, -0.2500817, 1, 0},
                                      {60 * kRadian, 0, -0.0855633, 1, -std::numbers::pi},
                                      {std::numbers::pi, 0, -0.2027817, 1, kQuarter}}};

Matrix product(const Matrix& left, const Matrix& right) noexcept {
  Matrix result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      result[i][j] = j == 3 ? left[i][3] : 0;
      for (std::size_t k = 0; k < 3; ++k) result[i][j] += left[i][k] * right[k][j];
    }
  }
  return result;
}

Matrix link_matrix(const Link& link, double angle) noexcept {
  const double theta = link.sign * angle * kRadian + link.offset;
  const double ct = std::cos(theta);
  const double st = std::sin(theta);
  const double ca = std::cos(link.alpha);
  const double sa = std::sin(link.alpha);
  return {{{ct, -st * ca, st * sa, link.a * ct},
           {st, ct * ca, -ct * sa, link.a * st},
           {0, sa, ca, link.d}}};
}

Matrix hand(const JointAngles& angles) noexcept {
  auto matrix = link_matrix(kLinks[0], angles[0]);
  for (std::size_t i = 1; i < kLinks.size(); ++i) {
    matrix = product(matrix, link_matrix(kLinks[i], angles[i]));
  }
  return matrix;
}

/// How far `is` from `wanted`: metres, then a rotation vector in radians (exact for small ones).
Vector6 error(const Matrix& wanted, const Matrix& is) noexcept {
  Vector6 result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = wanted[i][3] - is[i][3];
  for (std::size_t column = 0; column < 3; ++column) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto j = (i + 1) % 3;
      const auto k = (i + 2) % 3;
      result[3 + i] +=
          0.5 * (is[j][column] * wanted[k][column] - is[k][column] * wanted[j][column]);
    }
  }
  return result;
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

bool is_in_range(const JointAngles& angles) noexcept {
  const auto within = [](double angle, const JointRange& range) {
    const double turned = angle - 360 * std::floor(angle / 360);
    return turned >= range.least && turned <= range.most;
  };
  return within(angles[1], kJoint2Range) && within(angles[2], kJoint3Range);
}

}  // namespace

Pose forward(const JointAngles& angles) noexcept {
  const auto matrix = hand(angles);
  Frame frame;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) frame.rotation[i][j] = static_cast<float>(matrix[i][j]);
    frame.translation[i] = static_cast<float>(matrix[i][3]);
  }
  return pose_of(frame);
}

std::optional<JointAngles> solve(const Pose& pose, const JointAngles& seed) noexcept {
  const auto frame = frame_of(pose);
  Matrix wanted{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) wanted[i][j] = frame.rotation[i][j];
    wanted[i][3] = frame.translation[i];
  }
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
