// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "cli/checks.hpp"
#include "cli/choice.hpp"
#include "cli/command.hpp"
#include "harness/arm/jacobian.hpp"
#include "harness/arm/models.hpp"
#include "harness/arm/numeric_ik.hpp"
#include "harness/arm/orientation.hpp"
#include "harness/arm/spherical_wrist.hpp"
#include "harness/core/nearest.hpp"
#include "harness/urdf/urdf.hpp"

namespace armjig::cli {
namespace {

using nlohmann::json;

constexpr auto kKinHelp =
    "Computes where an arm's tool is, and how to get it there.\n"
    "\n"
    "  armjig kin fk 90 -90 180 0 0 180                  joints in degrees -> pose in mm and "
    "degrees\n"
    "  armjig kin ik 0 262.57 288.75 -90 0 -90 --all     pose -> joints, every way to reach it\n"
    "  armjig kin limits --arm jaco2                     what the joints may do\n"
    "  armjig kin fk 0 0 0 --arm robot.urdf --tip tool   any arm from a robot description\n"
    "\n"
    "Three angles mean nothing without their convention; each arm has that of its own programs\n"
    "unless --convention says another. Joints that slide are in mm.";

struct KinOptions {
  std::string arm = "parol6";
  std::string tip;
  std::string convention;
  std::vector<double> tool;
  std::vector<double> numbers;
  std::vector<double> seed;
  bool all = false;
  bool json = false;
};

/// An arm, and how people write its orientations.
struct Subject {
  arm::Arm arm;
  arm::ConventionName convention;
};

constexpr double to_degrees(double radians) { return radians * (180.0 / std::numbers::pi); }
constexpr double to_radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

/// A joint's value as people write it: degrees or mm.
double shown(const arm::Joint& joint, double value) {
  return joint.kind == arm::Joint::Kind::kPrismatic ? 1000 * value : to_degrees(value);
}
double taken(const arm::Joint& joint, double value) {
  return joint.kind == arm::Joint::Kind::kPrismatic ? value / 1000 : to_radians(value);
}
std::string_view unit_of(const arm::Joint& joint) {
  return joint.kind == arm::Joint::Kind::kPrismatic ? "mm" : "deg";
}

arm::ConventionName convention_named(arm::Convention convention) {
  return *std::ranges::find(arm::conventions(), convention, &arm::ConventionName::convention);
}

Outcome<Subject> subject_without_tool(const KinOptions& options) {
  const auto model = std::ranges::find(arm::models(), options.arm, &arm::ModelEntry::name);
  if (model != arm::models().end()) {
    return Subject{model->make(), convention_named(model->convention)};
  }
  if (options.arm.find_first_of("./") == std::string::npos) {
    std::string names;
    for (const auto& entry : arm::models()) names += fmt::format(" {}", entry.name);
    return problem(ErrorCode::kUnknownDevice, "--arm " + options.arm,
                   did_you_mean(options.arm, arm::models(), &arm::ModelEntry::name) +
                       "write a file, or one of:" + names);
  }
  auto arm = arm::read_urdf(options.arm, options.tip);
  if (!arm) return tl::unexpected{arm.error()};
  return Subject{*std::move(arm), convention_named(arm::Convention::kRollPitchYaw)};
}

arm::Pose pose_of(const std::vector<double>& numbers, arm::Convention convention) {
  return {rotation_of({to_radians(numbers[3]), to_radians(numbers[4]), to_radians(numbers[5])},
                      convention),
          {numbers[0] / 1000, numbers[1] / 1000, numbers[2] / 1000}};
}

Outcome<Subject> subject_of(const KinOptions& options) {
  auto subject = subject_without_tool(options);
  if (!subject) return subject;
  if (!options.convention.empty()) {
    subject->convention =
        *std::ranges::find(arm::conventions(), options.convention, &arm::ConventionName::name);
  }
  if (!options.tool.empty()) {
    const auto tool = pose_of(options.tool, subject->convention.convention);
    subject->arm = with_tool(std::move(subject->arm), tool);
  }
  return subject;
}

Outcome<arm::JointVector> joints_of(const arm::Arm& arm, const std::vector<double>& numbers,
                                    const std::string& where) {
  if (numbers.size() != arm.joint_count()) {
    return problem(
        ErrorCode::kBadValue, where,
        fmt::format("{} has {} joints, not {}", arm.name, arm.joint_count(), numbers.size()));
  }
  arm::JointVector joints(numbers.size());
  for (std::size_t j = 0; j < joints.size(); ++j) joints[j] = taken(arm.joints[j], numbers[j]);
  return joints;
}

/// Without the sign of a zero.
double rounded(double value) {
  constexpr double kDigits = 1e6;
  return std::round(value * kDigits) / kDigits + 0.0;
}

json joints_json(const arm::Arm& arm, std::span<const double> joints) {
  auto array = json::array();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    array.push_back(rounded(shown(arm.joints[j], joints[j])));
  }
  return array;
}

std::string joints_text(const arm::Arm& arm, std::span<const double> joints) {
  std::string text;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    text += fmt::format(" {:>10.4f}", rounded(shown(arm.joints[j], joints[j])));
  }
  return text;
}

json header(std::string_view what, const Subject& subject) {
  return {{"schema", "armjig.kin/1"}, {"what", what}, {"arm", subject.arm.name}};
}

// ---- fk

void print_pose(const Subject& subject, const arm::Pose& pose) {
  const auto [x, y, z] = 1000 * pose.position;
  const auto angles = angles_of(pose.rotation, subject.convention.convention);
  fmt::print("position    {:>12.4f} {:>12.4f} {:>12.4f}  mm\n", rounded(x), rounded(y), rounded(z));
  fmt::print("orientation {:>12.4f} {:>12.4f} {:>12.4f}  deg, {}: {}\n",
             rounded(to_degrees(angles.rx)), rounded(to_degrees(angles.ry)),
             rounded(to_degrees(angles.rz)), subject.convention.name, subject.convention.formula);
}

json pose_json(const Subject& subject, const arm::Pose& pose) {
  const auto [x, y, z] = 1000 * pose.position;
  const auto angles = angles_of(pose.rotation, subject.convention.convention);
  return {{"position_mm", {rounded(x), rounded(y), rounded(z)}},
          {"angles_deg",
           {rounded(to_degrees(angles.rx)), rounded(to_degrees(angles.ry)),
            rounded(to_degrees(angles.rz))}},
          {"convention", subject.convention.name}};
}

Exit forward_kinematics(const KinOptions& options) {
  const auto subject = subject_of(options);
  if (!subject) return report(subject.error());
  const auto joints = joints_of(subject->arm, options.numbers, "kin fk");
  if (!joints) return report(joints.error());
  const auto pose = forward(subject->arm, *joints);
  const auto dexterity = arm::dexterity(arm::jacobian(subject->arm, *joints));
  const auto outside = first_outside(subject->arm, *joints);
  const bool is_within = outside == joints->size();
  if (options.json) {
    auto object = header("fk", *subject);
    object["joints"] = joints_json(subject->arm, *joints);
    object["pose"] = pose_json(*subject, pose);
    object["manipulability"] = dexterity.manipulability;
    object["smallest_singular_value"] = dexterity.smallest_singular_value;
    object["is_within_limits"] = is_within;
    fmt::print("{}\n", object.dump());
  } else {
    print_pose(*subject, pose);
    fmt::print("manipulability {:.6f}, smallest singular value {:.6f} (m, rad)\n",
               dexterity.manipulability, dexterity.smallest_singular_value);
  }
  if (is_within) return Exit::kPassed;
  const auto& joint = subject->arm.joints[outside];
  fmt::print(stderr, "armjig kin fk: {} is beyond its limits, {:g} to {:g} {}\n", joint.name,
             shown(joint, joint.lower), shown(joint, joint.upper), unit_of(joint));
  return Exit::kFindings;
}

// ---- ik

/// A way to reach a pose, or the nearest that was found.
struct Solution {
  arm::JointVector joints;
  std::string branch;
};

/// What became of the search: solutions, the nearest to the seed first, or why there is none.
struct Search {
  std::vector<Solution> solutions;
  std::string failure;
};

std::string branch_name(const arm::Branch& branch) {
  return fmt::format("shoulder {}, elbow {}, wrist {}", branch.is_shoulder_back ? "back" : "front",
                     branch.is_elbow_flipped ? "flipped" : "plain",
                     branch.is_wrist_flipped ? "flipped" : "plain");
}

double way_between(std::span<const double> a, std::span<const double> b) {
  double way = 0;
  for (std::size_t j = 0; j < a.size(); ++j) way = std::max(way, std::abs(a[j] - b[j]));
  return way;
}

Search search_branches(const arm::Arm& arm, const arm::SphericalWrist& solver,
                       const arm::Pose& pose, const arm::JointVector& start) {
  arm::SixJoints seed{};
  std::ranges::copy(start, seed.begin());
  const auto branches = solver.solve(pose, seed);
  Search search;
  for (const auto& branch : branches) {
    const auto joints = within_limits(arm, branch.joints, seed);
    if (joints) search.solutions.push_back({arm::JointVector(*joints), branch_name(branch)});
  }
  std::ranges::sort(search.solutions, {},
                    [&](const Solution& solution) { return way_between(solution.joints, start); });
  search.failure =
      branches.empty()
          ? "it is out of reach"
          : fmt::format("{} postures do, but none within the joints' limits", branches.size());
  return search;
}

Search search_numerically(const arm::Arm& arm, const arm::Pose& pose,
                          const arm::JointVector& seed) {
  const auto answer = numeric_ik(arm, pose, seed);
  if (answer.is_reached) return {{{answer.joints, "found by descent"}}, {}};
  return {{},
          fmt::format("the nearest of {} attempts within the limits is {:.3f} mm and {:.3f} deg "
                      "beside it",
                      answer.attempts, 1000 * answer.error_m, to_degrees(answer.error_rad))};
}

/// In the middle of the limits, or at 0 where there are none.
arm::JointVector middle_of(const arm::Arm& arm) {
  arm::JointVector joints(arm.joint_count());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double middle = (arm.joints[j].lower + arm.joints[j].upper) / 2;
    joints[j] = std::isfinite(middle) ? middle : 0;
  }
  return joints;
}

Exit inverse_kinematics(const KinOptions& options) {
  const auto subject = subject_of(options);
  if (!subject) return report(subject.error());
  const auto& arm = subject->arm;
  auto seed = middle_of(arm);
  if (!options.seed.empty()) {
    const auto given = joints_of(arm, options.seed, "--seed");
    if (!given) return report(given.error());
    seed = *given;
  }
  const auto pose = pose_of(options.numbers, subject->convention.convention);
  const auto solver = arm::SphericalWrist::of(arm);
  auto search =
      solver ? search_branches(arm, *solver, pose, seed) : search_numerically(arm, pose, seed);
  if (!options.all && search.solutions.size() > 1) search.solutions.resize(1);
  if (options.json) {
    auto object = header("ik", *subject);
    object["method"] = solver ? "closed form" : "damped least squares";
    object["pose"] = pose_json(*subject, pose);
    object["solutions"] = json::array();
    for (const auto& [joints, branch] : search.solutions) {
      object["solutions"].push_back({{"joints", joints_json(arm, joints)}, {"branch", branch}});
    }
    fmt::print("{}\n", object.dump());
  } else {
    for (const auto& [joints, branch] : search.solutions) {
      fmt::print("{}  {}\n", joints_text(arm, joints), branch);
    }
  }
  if (!search.solutions.empty()) return Exit::kPassed;
  fmt::print(stderr, "armjig kin ik: no posture of {} has that pose: {}\n", arm.name,
             search.failure);
  return Exit::kFindings;
}

// ---- limits

/// JSON has no infinity.
json number_or_null(double value) { return std::isfinite(value) ? json(rounded(value)) : json(); }

Exit limits(const KinOptions& options) {
  const auto subject = subject_of(options);
  if (!subject) return report(subject.error());
  auto object = header("limits", *subject);
  object["joints"] = json::array();
  if (!options.json) fmt::print("joint            lower        upper    per second\n");
  for (const auto& joint : subject->arm.joints) {
    const double lower = shown(joint, joint.lower);
    const double upper = shown(joint, joint.upper);
    const double speed = shown(joint, joint.max_speed);
    object["joints"].push_back({{"name", joint.name},
                                {"unit", unit_of(joint)},
                                {"lower", number_or_null(lower)},
                                {"upper", number_or_null(upper)},
                                {"max_speed", number_or_null(speed)}});
    if (!options.json) {
      fmt::print("{:<10} {:>11.4f}  {:>11.4f}  {:>11.4f}  {}\n", joint.name, lower, upper, speed,
                 unit_of(joint));
    }
  }
  if (options.json) fmt::print("{}\n", object.dump());
  return Exit::kPassed;
}

// ---- arguments

std::vector<std::string> convention_names() {
  std::vector<std::string> names;
  for (const auto& entry : arm::conventions()) names.emplace_back(entry.name);
  return names;
}

CLI::Validator plain_number() { return number(-1e9, 1e9); }

using Compute = Exit (*)(const KinOptions&);

CLI::App* add_computation(CLI::App& kin, const std::string& name, const std::string& what,
                          const std::shared_ptr<KinOptions>& options, Compute compute,
                          Action& action) {
  auto* command = kin.add_subcommand(name, what);
  command->add_option("--arm", options->arm, "a name ('armjig kin --help') or a URDF file")
      ->capture_default_str();
  command->add_option("--tip", options->tip, "the link of the URDF that the arm ends in");
  command->add_option("--tool", options->tool, "a tool on the flange: x,y,z,rx,ry,rz in mm and deg")
      ->delimiter(',')
      ->check(plain_number())
      ->expected(6);
  command->add_option("--convention", options->convention, "what three angles mean")
      ->check(one_of(convention_names()));
  command->add_flag("--json", options->json, "one JSON object (docs/schemas)");
  when_chosen(*command, action, [options, compute] { return compute(*options); });
  return command;
}

}  // namespace

void add_kin(CLI::App& app, Devices /*devices*/, Action& action) {
  std::string help = kKinHelp;
  help += "\n\nArms:\n";
  for (const auto& entry : arm::models()) {
    help += fmt::format("  {:<16} {}\n", entry.name, entry.what);
  }
  auto* kin = app.add_subcommand("kin", help);
  kin->require_subcommand(1);
  const auto options = std::make_shared<KinOptions>();
  auto* fk = add_computation(*kin, "fk", "where the tool is", options, forward_kinematics, action);
  fk->add_option("JOINTS", options->numbers, "degrees (mm where a joint slides)")
      ->delimiter(',')
      ->check(plain_number())
      ->required();
  auto* ik =
      add_computation(*kin, "ik", "how to get the tool there", options, inverse_kinematics, action);
  ik->add_option("POSE", options->numbers, "x y z in mm, rx ry rz in degrees")
      ->delimiter(',')
      ->check(plain_number())
      ->expected(6)
      ->required();
  ik->add_option("--seed", options->seed, "joints to be near to; the middle if not given")
      ->delimiter(',')
      ->check(plain_number());
  ik->add_flag("--all", options->all, "every branch within the limits, the nearest first");
  add_computation(*kin, "limits", "what the joints may do", options, limits, action);
}

}  // namespace armjig::cli
