// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/spherical_wrist.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "harness/arm/angle.hpp"

namespace armjig::arm {
namespace {

using std::numbers::pi;

/// Right angles, parallels and meeting lines of a model may be that much off, metres or radians.
constexpr double kModelTolerance = 1e-9;
/// A target that much beyond reach is at its edge: rounding, not distance. Of cosines and m^2.
constexpr double kEdge = 1e-10;
/// Below that the wrist, or the arm seen from above, is straight, and a joint free to choose.
constexpr double kStraight = 1e-12;

struct Line {
  Vector3 point{};
  Vector3 direction{};

  [[nodiscard]] Vector3 foot(const Vector3& p) const noexcept {
    return point + dot(p - point, direction) * direction;
  }
  [[nodiscard]] bool has(const Vector3& p) const noexcept {
    return norm(p - foot(p)) < kModelTolerance;
  }
};

bool is_square(const Line& a, const Line& b) noexcept {
  return std::abs(dot(a.direction, b.direction)) < kModelTolerance;
}
bool is_parallel(const Line& a, const Line& b) noexcept {
  return norm(cross(a.direction, b.direction)) < kModelTolerance;
}

/// The joints' axes, all joints at 0.
std::array<Line, 6> axes_of(const Arm& arm) noexcept {
  std::array<Pose, 7> frames;
  forward_all(arm, SixJoints{}, frames);
  std::array<Line, 6> axes;
  for (std::size_t j = 0; j < axes.size(); ++j) {
    axes[j] = {frames[j].position, frames[j].rotation * arm.joints[j].axis};
  }
  return axes;
}

/// The orientation whose z and y axes are these.
Rotation from_z_and_y(const Vector3& z, const Vector3& y) noexcept {
  return inverse(Rotation{{cross(y, z), y, z}});
}

double square(double x) noexcept { return x * x; }

/// Rz(-angle) r.
Rotation turned_back_z(double angle, const Rotation& r) noexcept {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{c * r.rows[0] + s * r.rows[1], c * r.rows[1] - s * r.rows[0], r.rows[2]}};
}
/// Ry(-angle) r.
Rotation turned_back_y(double angle, const Rotation& r) noexcept {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{c * r.rows[0] - s * r.rows[2], r.rows[1], s * r.rows[0] + c * r.rows[2]}};
}

}  // namespace

std::optional<SphericalWrist> SphericalWrist::of(const Arm& arm) noexcept {
  const auto is_revolute = [](const Joint& joint) { return joint.kind == Joint::Kind::kRevolute; };
  if (arm.joint_count() != 6 || !std::ranges::all_of(arm.joints, is_revolute)) return {};
  const auto axes = axes_of(arm);
  const auto centre = axes[3].foot(axes[4].point);
  const bool is_ortho_parallel = is_square(axes[0], axes[1]) && is_parallel(axes[1], axes[2]);
  const bool has_wrist = is_square(axes[3], axes[4]) && is_square(axes[4], axes[5]) &&
                         axes[4].has(centre) && axes[5].has(centre);
  if (!is_ortho_parallel || !has_wrist) return {};

  const Pose base{from_z_and_y(axes[0].direction, axes[1].direction), axes[0].point};
  const auto in_base = inverse(base);
  const auto shoulder = in_base.rotation * axes[1].point + in_base.position;
  const auto elbow = in_base.rotation * axes[2].point + in_base.position;
  const auto wrist = in_base.rotation * centre + in_base.position;
  const auto link = [](const Vector3& from, const Vector3& to) {
    return Link{std::hypot(to.x - from.x, to.z - from.z), std::atan2(to.x - from.x, to.z - from.z)};
  };

  SphericalWrist solver;
  solver.to_base_ = in_base;
  solver.upper_ = link(shoulder, elbow);
  solver.fore_ = link(elbow, wrist);
  if (solver.upper_.length < kModelTolerance || solver.fore_.length < kModelTolerance) return {};
  solver.shoulder_x_ = shoulder.x;
  solver.shoulder_z_ = shoulder.z;
  solver.lateral_ = wrist.y;
  solver.elbow_sign_ = dot(axes[1].direction, axes[2].direction) > 0 ? 1 : -1;

  const auto tool = forward(arm, SixJoints{});
  const auto wrist_frame = from_z_and_y(axes[3].direction, axes[4].direction);
  const auto last_axis = inverse(wrist_frame) * axes[5].direction;
  solver.wrist_bend_ = std::atan2(last_axis.x, last_axis.z);
  solver.centre_in_tool_ = inverse(tool.rotation) * (centre - tool.position);
  solver.base_to_wrist_ = inverse(wrist_frame) * base.rotation;
  solver.tool_to_wrist_ = inverse(tool.rotation) * wrist_frame * rotation_y(solver.wrist_bend_);
  return solver;
}

Branches SphericalWrist::solve(const Pose& pose, const SixJoints& seed) const noexcept {
  Branches found;
  const auto centre = to_base_ * (pose * translation(centre_in_tool_));
  const auto [x, y, z] = centre.position;
  const double reach2 = square(x) + square(y) - square(lateral_);
  if (reach2 < -kEdge) return found;
  const double reach = std::sqrt(std::max(reach2, 0.0));
  const auto target = to_base_.rotation * (pose.rotation * tool_to_wrist_);
  const bool is_above_base = std::abs(lateral_) < kStraight && reach < kStraight;
  const double towards = is_above_base ? seed[0] : std::atan2(y, x);
  const double offset = is_above_base ? 0 : std::atan2(lateral_, reach);
  solve_plane({wrapped(towards - offset), reach - shoulder_x_, z - shoulder_z_, false}, target,
              seed, found);
  solve_plane(
      {wrapped(wrapped(towards + offset) - pi), -reach - shoulder_x_, z - shoulder_z_, true},
      target, seed, found);
  return found;
}

void SphericalWrist::solve_plane(const Plane& plane, const Rotation& target, const SixJoints& seed,
                                 Branches& found) const noexcept {
  const double cosine =
      (square(plane.x) + square(plane.z) - square(upper_.length) - square(fore_.length)) /
      (2 * upper_.length * fore_.length);
  if (std::abs(cosine) > 1 + kEdge) return;
  const double sine = std::sqrt(std::max((1 - cosine) * (1 + cosine), 0.0));
  const double bend = std::atan2(sine, cosine);
  const double towards = std::atan2(plane.x, plane.z);
  const double aside = std::atan2(fore_.length * sine, upper_.length + fore_.length * cosine);
  const auto turned = turned_back_z(plane.q1, target);
  for (const double side : {1.0, -1.0}) {
    const double upper = towards - side * aside;
    const double turn = upper + side * bend - fore_.angle;  // of the forearm, from its place at 0
    Branch arm{.is_shoulder_back = plane.is_back, .is_elbow_flipped = side < 0};
    arm.joints[0] = plane.q1;
    arm.joints[1] = wrapped(wrapped(upper) - upper_.angle);
    arm.joints[2] =
        wrapped(wrapped(elbow_sign_ * (side * bend + upper_.angle)) - elbow_sign_ * fore_.angle);
    solve_wrist(arm, base_to_wrist_ * turned_back_y(turn, turned), seed[3], found);
  }
}

// The target is Rz(q4) Ry(q5 + bend) Rz(q6). Joint 6 comes from what joint 4 leaves of it, so that
// their sum is precise where neither is.
void SphericalWrist::solve_wrist(const Branch& arm, const Rotation& target, double seed,
                                 Branches& found) const noexcept {
  const auto& [r0, r1, r2] = target.rows;
  const double sine = std::sqrt(square(r0.z) + square(r1.z));
  const bool is_straight = sine < kStraight;
  const double c4 = is_straight ? std::cos(seed) : r0.z / sine;
  const double s4 = is_straight ? std::sin(seed) : r1.z / sine;
  const double q4 = std::atan2(s4, c4);
  const double q5 = std::atan2(c4 * r0.z + s4 * r1.z, r2.z);
  const double q6 = std::atan2(c4 * r1.x - s4 * r0.x, c4 * r1.y - s4 * r0.y);
  const auto add = [&](double j4, double j5, double j6, bool is_flipped) {
    Branch branch = arm;
    branch.joints[3] = j4;
    branch.joints[4] = wrapped(j5 - wrist_bend_);
    branch.joints[5] = j6;
    branch.is_wrist_flipped = is_flipped;
    found.add(branch);
  };
  add(q4, q5, q6, false);
  add(wrapped(q4 - pi), -q5, wrapped(q6 - pi), true);
}

SphericalWrist::Clearance SphericalWrist::clearance(const SixJoints& joints) const noexcept {
  const double upper = upper_.angle + joints[1];
  const double fore = fore_.angle + joints[1] + elbow_sign_ * joints[2];
  const double out = shoulder_x_ + upper_.length * std::sin(upper) + fore_.length * std::sin(fore);
  return {std::abs(out), std::abs(std::sin(fore - upper)),
          std::abs(std::sin(joints[4] + wrist_bend_))};
}

std::optional<SixJoints> within_limits(const Arm& arm, const SixJoints& joints,
                                       const SixJoints& seed) noexcept {
  constexpr double kAtLimit = 1e-9;
  constexpr double kTurn = 2 * pi;
  SixJoints result;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto& [lower, upper] = std::pair{arm.joints[j].lower, arm.joints[j].upper};
    double q = joints[j] + kTurn * std::round((seed[j] - joints[j]) / kTurn);
    if (q > upper + kAtLimit) q -= kTurn * std::ceil((q - upper - kAtLimit) / kTurn);
    if (q < lower - kAtLimit) q += kTurn * std::ceil((lower - kAtLimit - q) / kTurn);
    if (q > upper + kAtLimit) return {};
    result[j] = std::clamp(q, lower, upper);
  }
  return result;
}

std::optional<SixJoints> nearest(const Arm& arm, const Branches& branches,
                                 const SixJoints& seed) noexcept {
  std::optional<SixJoints> best;
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& branch : branches) {
    const auto joints = within_limits(arm, branch.joints, seed);
    if (!joints) continue;
    double way = 0;
    for (std::size_t j = 0; j < seed.size(); ++j) {
      way = std::max(way, std::abs((*joints)[j] - seed[j]));
    }
    if (way < shortest) {
      shortest = way;
      best = joints;
    }
  }
  return best;
}

}  // namespace armjig::arm
