// SPDX-License-Identifier: Apache-2.0
#include "harness/urdf/urdf.hpp"

#include <console_bridge/console.h>
#include <fmt/core.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <iterator>
#include <vector>

namespace armjig::arm {
namespace {

Pose pose_of(const urdf::Pose& pose) {
  const Vector3 position{pose.position.x, pose.position.y, pose.position.z};
  const auto& q = pose.rotation;
  const Vector3 axis{q.x, q.y, q.z};
  const double sine = norm(axis);
  if (sine == 0) return translation(position);
  return {rotation_about(1 / sine * axis, 2 * std::atan2(sine, q.w)), position};
}

/// The joints that lead to a link, from the root on.
std::vector<urdf::JointSharedPtr> joints_to(const urdf::LinkSharedPtr& tip) {
  std::vector<urdf::JointSharedPtr> joints;
  for (auto link = tip; link->parent_joint; link = link->getParent()) {
    joints.push_back(link->parent_joint);
  }
  std::ranges::reverse(joints);
  return joints;
}

std::vector<urdf::LinkSharedPtr> leaves_of(const urdf::ModelInterface& model) {
  std::vector<urdf::LinkSharedPtr> leaves;
  for (const auto& [name, link] : model.links_) {
    if (link->child_links.empty()) leaves.push_back(link);
  }
  return leaves;
}

std::string names_of(const std::vector<urdf::LinkSharedPtr>& links) {
  std::string names;
  for (const auto& link : links) names += (names.empty() ? "" : ", ") + link->name;
  return names;
}

Outcome<urdf::LinkSharedPtr> find_tip(const std::string& path, const urdf::ModelInterface& model,
                                      std::string_view tip) {
  const auto leaves = leaves_of(model);
  if (tip.empty()) {
    if (leaves.size() == 1) return leaves.front();
    return problem(ErrorCode::kBadValue, path,
                   fmt::format("name the link that the arm ends in, one of: {}", names_of(leaves)));
  }
  const auto found = model.links_.find(std::string{tip});
  if (found != model.links_.end()) return found->second;
  return problem(ErrorCode::kBadValue, fmt::format("{}: link {}", path, tip),
                 fmt::format("the robot ends in: {}", names_of(leaves)));
}

Outcome<Joint> joint_of(const std::string& path, const urdf::Joint& joint, const Pose& origin) {
  const auto where = fmt::format("{}: joint {}", path, joint.name);
  const bool turns = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS;
  if ((!turns && joint.type != urdf::Joint::PRISMATIC) || joint.mimic) {
    return problem(ErrorCode::kUnsupported, where,
                   "joints turn or slide by themselves here: revolute, continuous, prismatic");
  }
  const Vector3 axis{joint.axis.x, joint.axis.y, joint.axis.z};
  const double length = norm(axis);
  if (!std::isfinite(length) || length < 1e-9) {
    return problem(ErrorCode::kMalformed, where, "its axis has no direction");
  }
  Joint result{.name = joint.name,
               .kind = turns ? Joint::Kind::kRevolute : Joint::Kind::kPrismatic,
               .origin = origin,
               .axis = 1 / length * axis};
  if (joint.limits && joint.type != urdf::Joint::CONTINUOUS) {
    result.lower = joint.limits->lower;
    result.upper = joint.limits->upper;
  }
  if (joint.limits && joint.limits->velocity > 0) result.max_speed = joint.limits->velocity;
  if (!(result.lower <= result.upper)) {
    return problem(ErrorCode::kMalformed, where, "its lower limit is above its upper one");
  }
  return result;
}

bool is_finite(const Pose& pose) noexcept {
  double sum = pose.position.x + pose.position.y + pose.position.z;
  for (const auto& row : pose.rotation.rows) sum += row.x + row.y + row.z;
  return std::isfinite(sum);
}

Outcome<Arm> arm_to(const std::string& path, const urdf::ModelInterface& model,
                    const urdf::LinkSharedPtr& tip) {
  Arm arm{.name = model.name_};
  Pose before;  // fixed joints since the last one that moves
  for (const auto& joint : joints_to(tip)) {
    before = before * pose_of(joint->parent_to_joint_origin_transform);
    if (!is_finite(before)) {
      return problem(ErrorCode::kMalformed, fmt::format("{}: joint {}", path, joint->name),
                     "its origin is not made of numbers");
    }
    if (joint->type == urdf::Joint::FIXED) continue;
    auto moving = joint_of(path, *joint, before);
    if (!moving) return tl::unexpected{moving.error()};
    arm.joints.push_back(*std::move(moving));
    before = {};
  }
  arm.tool = before;
  if (arm.joint_count() == 0 || arm.joint_count() > kMaxJoints) {
    return problem(
        ErrorCode::kUnsupported, fmt::format("{}: link {}", path, tip->name),
        fmt::format("{} joints lead to it; an arm has 1 to {}", arm.joint_count(), kMaxJoints));
  }
  return arm;
}

}  // namespace

Outcome<Arm> arm_from_urdf(const std::string& path, const std::string& xml, std::string_view tip) {
  console_bridge::noOutputHandler();  // what is wrong is said once, by us
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(xml);
  } catch (const std::exception&) {  // urdfdom throws what its parsers of numbers throw
  }
  if (!model || !model->getRoot()) {
    return problem(ErrorCode::kMalformed, path, "it is not a robot description (URDF)");
  }
  const auto end = find_tip(path, *model, tip);
  if (!end) return tl::unexpected{end.error()};
  return arm_to(path, *model, *end);
}

Outcome<Arm> read_urdf(const std::string& path, std::string_view tip) {
  std::ifstream in{path, std::ios::binary};
  if (!in) return problem(ErrorCode::kCannotRead, path, "check the path and its permissions");
  const std::string xml{std::istreambuf_iterator<char>{in}, {}};
  if (in.bad()) return problem(ErrorCode::kCannotRead, path, "it is a folder or cannot be read");
  return arm_from_urdf(path, xml, tip);
}

}  // namespace armjig::arm
