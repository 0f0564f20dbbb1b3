// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/models.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "harness/wire/parol6/joints.hpp"

namespace armjig::arm {
namespace {

using std::numbers::pi;

constexpr double rad(double degrees) noexcept { return degrees * (pi / 180.0); }

struct Range {
  double lower{};  ///< degrees, as is `upper`
  double upper{};
  double max_speed{};  ///< degrees/s
};

void set_ranges(Arm& arm, std::span<const Range> ranges) {
  for (std::size_t j = 0; j < ranges.size(); ++j) {
    arm.joints[j].lower = rad(ranges[j].lower);
    arm.joints[j].upper = rad(ranges[j].upper);
    arm.joints[j].max_speed = rad(ranges[j].max_speed);
  }
}

/// The hosts' limits; speeds are the commander's.
void set_parol6_ranges(Arm& arm) {
  std::array<Range, parol6::kJointCount> ranges;
  std::ranges::transform(parol6::kJoints, ranges.begin(), [](const parol6::Joint& joint) {
    return Range{joint.lower.value, joint.upper.value, joint.speed(joint.max_speed).value};
  });
  set_ranges(arm, ranges);
}

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr Range kEndless{-kForever, kForever, 48};

/// Lengths of Kinova's public sheet, metres.
struct JacoLengths {
  double base_to_shoulder = 0.2755;
  double upper_arm = 0.41;
  double forearm = 0.2073;
  double wrist{};  ///< first and second part are equally long
  double hand{};
  double elbow_offset = 0.0098;
};

constexpr JacoLengths kJaco2{.wrist = 0.0741, .hand = 0.16};
constexpr JacoLengths kJaco1{.wrist = 0.0743, .hand = 0.1687};
constexpr JacoLengths kJaco2Spherical{.wrist = 0.1038, .hand = 0.16};

Arm curved_jaco(std::string name, const JacoLengths& l) {
  constexpr double kHalfBend = rad(30);
  const double f = std::sin(kHalfBend) / std::sin(2 * kHalfBend);
  const std::array rows{
      DhRow{l.base_to_shoulder, 0, pi / 2, -1, 0},
      DhRow{0, l.upper_arm, pi, 1, -pi / 2},
      DhRow{-l.elbow_offset, 0, pi / 2, 1, pi / 2},
      DhRow{-(l.forearm + f * l.wrist), 0, 2 * kHalfBend, 1, 0},
      DhRow{-2 * f * l.wrist, 0, 2 * kHalfBend, 1, -pi},
      DhRow{-(f * l.wrist + l.hand), 0, pi, 1, pi / 2},
  };
  auto arm = arm_from_dh(std::move(name), rows);
  set_ranges(arm, std::array{Range{-kForever, kForever, 36}, Range{47, 313, 36}, Range{19, 341, 36},
                             kEndless, kEndless, kEndless});
  return arm;
}

Arm spherical_jaco(std::string name, const JacoLengths& l) {
  const std::array rows{
      DhRow{-l.base_to_shoulder, 0, pi / 2, 1, -pi},
      DhRow{0, l.upper_arm, pi, 1, pi / 2},
      DhRow{-l.elbow_offset, 0, pi / 2, 1, pi / 2},
      DhRow{-(l.forearm + l.wrist), 0, pi / 2, 1, 0},
      DhRow{0, 0, pi / 2, 1, 0},
      DhRow{-(l.wrist + l.hand), 0, pi, 1, -pi / 2},
  };
  auto arm = arm_from_dh(std::move(name), rows, {rotation_x(pi), {}});
  set_ranges(arm, std::array{Range{-kForever, kForever, 36}, Range{47, 313, 36}, Range{19, 341, 36},
                             kEndless, Range{30, 330, 48}, kEndless});
  return arm;
}

constexpr std::array kParol6Tools{
    Parol6Tool{"none", {}},
    Parol6Tool{"pneumatic-vertical", {-0.055, 0, -0.027}},
    Parol6Tool{"pneumatic-horizontal", {0, 0, -0.082}},
    Parol6Tool{"ssg-48", {0, 0, -0.105}},
    Parol6Tool{"msg", {-0.029, 0, -0.103}},
    Parol6Tool{"vacuum", {0, 0, -0.037}},
};

constexpr std::array kModels{
    ModelEntry{"parol6", "PAROL6 of the commander, its tool included", Convention::kCommander,
               parol6_commander},
    ModelEntry{"parol6-flange", "PAROL6 of the Python API, up to the flange", Convention::kXyz,
               parol6_flange},
    ModelEntry{"jaco2", "Jaco 2, six joints, curved wrist", Convention::kXyz,
               [] { return jaco(JacoVariant::kJaco2Curved); }},
    ModelEntry{"jaco1", "Jaco 1, six joints, curved wrist", Convention::kXyz,
               [] { return jaco(JacoVariant::kJaco1Curved); }},
    ModelEntry{"jaco2-spherical", "Jaco 2, six joints, spherical wrist", Convention::kXyz,
               [] { return jaco(JacoVariant::kJaco2Spherical); }},
};

}  // namespace

Arm parol6_commander() {
  constexpr std::array kRows{
      DhRow{0.1105, 0.02342, -pi / 2}, DhRow{0, 0.180, pi}, DhRow{0, -0.0435, pi / 2},
      DhRow{-0.17635, 0, -pi / 2},     DhRow{0, 0, pi / 2}, DhRow{-0.0628, -0.04525, pi},
  };
  auto arm = arm_from_dh("parol6", kRows);
  set_parol6_ranges(arm);
  return arm;
}

Arm parol6_flange() {
  struct Origin {
    Vector3 position{};
    double roll{};
  };
  constexpr std::array<Origin, 6> kOrigins{{{{0, 0, 0.1105}, 0},
                                            {{0.0234207210610375, 0, 0}, -pi / 2},
                                            {{0.18, 0, 0}, pi},
                                            {{-0.0435, 0.17635, 0}, pi / 2},
                                            {{0, 0, 0}, -pi / 2},
                                            {{0, 0.037, 0}, pi / 2}}};
  Arm arm{.name = "parol6-flange"};
  for (const auto& origin : kOrigins) {
    arm.joints.push_back({.name = "L" + std::to_string(arm.joint_count() + 1),
                          .origin = {rotation_x(origin.roll), origin.position}});
  }
  set_parol6_ranges(arm);
  return arm;
}

std::span<const Parol6Tool> parol6_tools() noexcept { return kParol6Tools; }

Arm jaco(JacoVariant variant) {
  switch (variant) {
    case JacoVariant::kJaco1Curved:
      return curved_jaco("jaco1", kJaco1);
    case JacoVariant::kJaco2Spherical:
      return spherical_jaco("jaco2-spherical", kJaco2Spherical);
    case JacoVariant::kJaco2Curved:
      break;
  }
  return curved_jaco("jaco2", kJaco2);
}

std::span<const ModelEntry> models() noexcept { return kModels; }

}  // namespace armjig::arm
