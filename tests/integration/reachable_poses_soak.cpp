// SPDX-License-Identifier: Apache-2.0
// A million random reachable poses for each arm with a closed form, and a hundred thousand for the
// Jaco with the curved wrist, which has none: closed form may miss none, numeric search one in a
// thousand. Says how many it missed.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "harness/arm/models.hpp"
#include "harness/arm/numeric_ik.hpp"
#include "harness/arm/spherical_wrist.hpp"

namespace {

using namespace armjig::arm;

constexpr int kClosedFormPoses = 1'000'000;
constexpr int kNumericPoses = 100'000;
constexpr double kSame = 1e-9;  // m and rad

SixJoints drawn_posture(const Arm& arm, std::mt19937_64& engine) {
  SixJoints joints{};
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double lower = std::max(arm.joints[j].lower, -std::numbers::pi);
    const double upper = std::min(arm.joints[j].upper, lower + 2 * std::numbers::pi);
    joints[j] = lower + (upper - lower) * (static_cast<double>(engine() >> 11U) * 0x1p-53);
  }
  return joints;
}

bool is_at(const Arm& arm, std::span<const double> joints, const Pose& pose, double tolerance) {
  const auto there = forward(arm, joints);
  return norm(there.position - pose.position) <= tolerance &&
         angle_between(there.rotation, pose.rotation) <= tolerance &&
         first_outside(arm, joints) == arm.joint_count();
}

int closed_form_misses(const Arm& arm) {
  const auto solver = *SphericalWrist::of(arm);
  std::mt19937_64 engine{2026};
  int misses = 0;
  for (int i = 0; i < kClosedFormPoses; ++i) {
    const auto pose = forward(arm, drawn_posture(arm, engine));
    const auto joints = nearest(arm, solver.solve(pose), {});
    misses += joints && is_at(arm, *joints, pose, kSame) ? 0 : 1;
  }
  fmt::print("{}: {} of {} poses missed in closed form\n", arm.name, misses, kClosedFormPoses);
  return misses;
}

/// What the search says of itself is not believed.
int numeric_misses(const Arm& arm) {
  std::mt19937_64 engine{2027};
  int misses = 0;
  int unreported = 0;
  for (int i = 0; i < kNumericPoses; ++i) {
    const auto pose = forward(arm, drawn_posture(arm, engine));
    const auto answer = numeric_ik(arm, pose, SixJoints{0, 3, 3, 0, 0, 0});
    const bool is_there = is_at(arm, answer.joints, pose, 2 * kSame);
    misses += is_there ? 0 : 1;
    unreported += answer.is_reached && !is_there ? 1 : 0;
  }
  fmt::print("{}: {} of {} poses missed by numeric search, {} of them not reported\n", arm.name,
             misses, kNumericPoses, unreported);
  return unreported > 0 ? kNumericPoses : misses;
}

}  // namespace

int main() {
  const int closed = closed_form_misses(parol6_commander()) +
                     closed_form_misses(jaco(JacoVariant::kJaco2Spherical));
  const int numeric = numeric_misses(jaco(JacoVariant::kJaco2Curved));
  return closed == 0 && numeric * 1000 <= kNumericPoses ? 0 : 1;
}
