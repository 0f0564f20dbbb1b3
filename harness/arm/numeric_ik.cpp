// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/numeric_ik.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "harness/arm/jacobian.hpp"

namespace armjig::arm {
namespace {

using std::numbers::pi;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using JointColumn = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// What separates the tool from the target: metres and radians, in the base's frame.
struct Gap {
  Vector3 position{};
  Vector3 rotation{};

  [[nodiscard]] double squared() const noexcept {
    return dot(position, position) + dot(rotation, rotation);
  }
};

Gap gap_between(const Pose& from, const Pose& to) noexcept {
  return {to.position - from.position, rotation_vector(to.rotation * inverse(from.rotation))};
}

/// A generator whose numbers are the same everywhere (splitmix64).
class Draw {
 public:
  explicit Draw(std::uint64_t state) noexcept : state_{state} {}

  /// From `lower` to `upper`.
  [[nodiscard]] double between(double lower, double upper) noexcept {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    z ^= z >> 31U;
    return lower + (upper - lower) * (static_cast<double>(z >> 11U) * 0x1p-53);
  }

 private:
  std::uint64_t state_;
};

/// One descent from a posture to where the gap is smallest nearby.
class Descent {
 public:
  Descent(const Arm& arm, const Pose& pose, const NumericIkOptions& options,
          const JointVector& from) noexcept
      : arm_{arm}, pose_{pose}, options_{options}, joints_{from} {
    measure();
  }

  /// Until it is there, stuck, or out of iterations.
  void run() noexcept {
    while (!is_there() && damping_ < kStuck && iterations_ < options_.iterations) {
      ++iterations_;
      attempt();
    }
  }

  [[nodiscard]] bool is_there() const noexcept {
    return norm(gap_.position) <= options_.tolerance_m &&
           norm(gap_.rotation) <= options_.tolerance_rad;
  }
  [[nodiscard]] const JointVector& joints() const noexcept { return joints_; }
  [[nodiscard]] const Gap& gap() const noexcept { return gap_; }
  [[nodiscard]] int iterations() const noexcept { return iterations_; }

 private:
  static constexpr double kStuck = 1e6;

  void measure() noexcept { gap_ = gap_between(forward(arm_, joints_), pose_); }

  /// A damped step. One that makes the gap larger is taken back, and the next is damped more.
  void attempt() noexcept {
    const auto before = joints_;
    const auto gap_before = gap_;
    step();
    measure();
    if (gap_.squared() < gap_before.squared()) {
      damping_ = std::max(damping_ / 8, 1e-9);
      return;
    }
    joints_ = before;
    gap_ = gap_before;
    damping_ *= 5;
  }

  void step() noexcept {
    const auto columns = jacobian(arm_, joints_);
    Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints> matrix{
        6, static_cast<Eigen::Index>(columns.size())};
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const auto [v, w] = columns[j];
      matrix.col(static_cast<Eigen::Index>(j)) << v.x, v.y, v.z, w.x, w.y, w.z;
    }
    Vector6 error;
    error << gap_.position.x, gap_.position.y, gap_.position.z, gap_.rotation.x, gap_.rotation.y,
        gap_.rotation.z;
    // Joints at a limit that would go beyond it are left out, which can make others do the same.
    for (std::size_t round = 0; round <= columns.size(); ++round) {
      const double damping = damping_ * (gap_.squared() + 1e-12);
      const Matrix6 normal = matrix * matrix.transpose() + damping * Matrix6::Identity();
      const JointColumn way = matrix.transpose() * normal.ldlt().solve(error);
      if (!leave_out_blocked(matrix, way)) {
        move(way);
        return;
      }
    }
  }

  template <class Matrix>
  bool leave_out_blocked(Matrix& matrix, const JointColumn& way) const noexcept {
    bool has_left_out = false;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      const auto& joint = arm_.joints[j];
      const bool is_blocked = (joints_[j] >= joint.upper && way[column] > 0) ||
                              (joints_[j] <= joint.lower && way[column] < 0);
      if (!is_blocked) continue;
      matrix.col(column).setZero();
      has_left_out = true;
    }
    return has_left_out;
  }

  void move(const JointColumn& way) noexcept {
    constexpr double kFarthest = 1.0;  // beyond that the linear picture is none
    const double shrink = std::min(1.0, kFarthest / std::max(way.cwiseAbs().maxCoeff(), 1e-300));
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const auto& joint = arm_.joints[j];
      joints_[j] = std::clamp(joints_[j] + shrink * way[static_cast<Eigen::Index>(j)], joint.lower,
                              joint.upper);
    }
  }

  const Arm& arm_;
  const Pose& pose_;
  const NumericIkOptions& options_;
  JointVector joints_;
  Gap gap_;
  double damping_ = 1e-2;
  int iterations_ = 0;
};

JointVector drawn_posture(const Arm& arm, Draw& draw) noexcept {
  JointVector joints(arm.joint_count());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto& joint = arm.joints[j];
    const bool is_bounded = std::isfinite(joint.lower) && std::isfinite(joint.upper);
    joints[j] = is_bounded ? draw.between(joint.lower, joint.upper) : draw.between(-pi, pi);
  }
  return joints;
}

void turn_towards(const Arm& arm, std::span<const double> seed, JointVector& joints) noexcept {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto& joint = arm.joints[j];
    if (joint.kind != Joint::Kind::kRevolute || !joint.is_continuous()) continue;
    joints[j] += 2 * pi * std::round((seed[j] - joints[j]) / (2 * pi));
  }
}

JointVector into_limits(const Arm& arm, std::span<const double> seed) noexcept {
  JointVector joints(seed);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    joints[j] = std::clamp(joints[j], arm.joints[j].lower, arm.joints[j].upper);
  }
  return joints;
}

}  // namespace

NumericIkAnswer numeric_ik(const Arm& arm, const Pose& pose, std::span<const double> seed,
                           const NumericIkOptions& options) noexcept {
  assert(seed.size() == arm.joint_count());
  NumericIkAnswer answer;
  Draw draw{options.draw};
  auto from = into_limits(arm, seed);
  double smallest = std::numeric_limits<double>::infinity();
  while (answer.attempts < options.attempts && !answer.is_reached) {
    Descent descent{arm, pose, options, from};
    descent.run();
    ++answer.attempts;
    answer.iterations += descent.iterations();
    answer.is_reached = descent.is_there();
    if (const double gap = descent.gap().squared(); gap < smallest) {
      smallest = gap;
      answer.joints = descent.joints();
      answer.error_m = norm(descent.gap().position);
      answer.error_rad = norm(descent.gap().rotation);
    }
    from = drawn_posture(arm, draw);
  }
  turn_towards(arm, seed, answer.joints);
  return answer;
}

}  // namespace armjig::arm
