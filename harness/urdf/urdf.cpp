// SPDX-License-Identifier: Apache-2.0
#include "harness/urdf/urdf.hpp"

#include <console_bridge/console.h>
#include <fmt/core.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/nesting.hpp"
#include "harness/files/user_file.hpp"

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
  constexpr std::size_t kMostNames = 10;
  std::string names;
  for (std::size_t i = 0; i < std::min(links.size(), kMostNames); ++i) {
    names += (names.empty() ? "" : ", ") + links[i]->name;
  }
  if (links.size() > kMostNames) names += fmt::format(" and {} more", links.size() - kMostNames);
  return names;
}

constexpr std::string_view kNoRobot = "it is not a robot description (URDF)";

/// The text after the next `mark`; empty if there is none.
std::string_view after(std::string_view text, std::string_view mark) {
  const auto found = text.find(mark);
  return found == std::string_view::npos ? "" : text.substr(found + mark.size());
}

/// What stands before the next `>` that is not in quotes.
std::string_view tag_of(std::string_view text) {
  std::size_t end = 0;
  for (char quote = 0; end < text.size() && (quote != 0 || text[end] != '>'); ++end) {
    const bool is_quote = text[end] == '"' || text[end] == '\'';
    if (text[end] == quote) {
      quote = 0;
    } else if (quote == 0 && is_quote) {
      quote = text[end];
    }
  }
  return text.substr(0, end);
}

/// Why a text is not given to the XML parser, which recurses; empty if it is. Of what is no XML
/// nothing is promised.
std::string objection_to(std::string_view xml) {
  constexpr std::size_t kMostElements = 100'000;
  std::size_t depth = 0;
  std::size_t elements = 0;
  for (auto rest = after(xml, "<"); !rest.empty(); rest = after(rest, "<")) {
    if (rest.starts_with("!--")) {
      rest = after(rest, "-->");
    } else if (rest.starts_with("![CDATA[")) {
      rest = after(rest, "]]>");
    } else if (rest.starts_with('/')) {
      depth -= depth > 0 ? 1 : 0;
    } else if (!rest.starts_with('?') && !rest.starts_with('!')) {
      const bool is_whole = tag_of(rest).ends_with('/');
      if (++elements > kMostElements) return fmt::format("it has over {} elements", kMostElements);
      depth += is_whole ? 0 : 1;
      if (depth > kDeepestNesting) return std::string{kTooDeep};
    }
  }
  return {};
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
  if (auto objection = objection_to(xml); !objection.empty()) {
    if (xml.find("<robot") == std::string::npos) objection = kNoRobot;
    return problem(ErrorCode::kMalformed, path, std::move(objection));
  }
  console_bridge::noOutputHandler();  // what is wrong is said once, by us
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(xml);
  } catch (const std::exception&) {  // urdfdom throws what its parsers of numbers throw
  }
  if (!model || !model->getRoot()) {
    return problem(ErrorCode::kMalformed, path, std::string{kNoRobot});
  }
  const auto end = find_tip(path, *model, tip);
  if (!end) return tl::unexpected{end.error()};
  return arm_to(path, *model, *end);
}

Outcome<Arm> read_urdf(const std::string& path, std::string_view tip) {
  return read_user_file(path).and_then(
      [&](const std::string& xml) { return arm_from_urdf(path, xml, tip); });
}

}  // namespace armjig::arm
