// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/arm.hpp"

#include <cassert>
#include <utility>

namespace armjig::arm {
namespace {

/// The frame behind a joint, in the frame before it.
Pose moved(const Joint& joint, double by) noexcept {
  if (joint.kind == Joint::Kind::kPrismatic) {
    return joint.origin * translation(by * joint.axis);
  }
  return {joint.origin.rotation * rotation_about(joint.axis, by), joint.origin.position};
}

}  // namespace

Arm with_tool(Arm arm, const Pose& tool) {
  arm.tool = arm.tool * tool;
  return arm;
}

Arm without_limits(Arm arm) {
  for (auto& joint : arm.joints) {
    joint.lower = -std::numeric_limits<double>::infinity();
    joint.upper = std::numeric_limits<double>::infinity();
  }
  return arm;
}

Arm arm_from_dh(std::string name, std::span<const DhRow> rows, const Pose& base) {
  assert(rows.size() <= kMaxJoints);
  Arm arm{.name = std::move(name)};
  Pose before = base;  // all that lies between the last joint's turn and this one's
  for (const auto& row : rows) {
    arm.joints.push_back({.name = "j" + std::to_string(arm.joint_count() + 1),
                          .origin = before * Pose{rotation_z(row.offset), {}},
                          .axis = {0, 0, row.sign}});
    before = {rotation_x(row.alpha), {row.a, 0, row.d}};
  }
  arm.tool = before;
  return arm;
}

std::size_t first_outside(const Arm& arm, std::span<const double> joints) noexcept {
  assert(joints.size() == arm.joint_count());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const bool is_within = joints[j] >= arm.joints[j].lower && joints[j] <= arm.joints[j].upper;
    if (!is_within) return j;
  }
  return joints.size();
}

Pose forward(const Arm& arm, std::span<const double> joints) noexcept {
  assert(joints.size() == arm.joint_count());
  Pose pose;
  for (std::size_t j = 0; j < joints.size(); ++j) pose = pose * moved(arm.joints[j], joints[j]);
  return pose * arm.tool;
}

void forward_all(const Arm& arm, std::span<const double> joints, std::span<Pose> frames) noexcept {
  assert(joints.size() == arm.joint_count() && frames.size() == joints.size() + 1);
  Pose pose;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    pose = pose * moved(arm.joints[j], joints[j]);
    frames[j] = pose;
  }
  frames.back() = pose * arm.tool;
}

}  // namespace armjig::arm
