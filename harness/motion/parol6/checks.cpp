// SPDX-License-Identifier: Apache-2.0
#include "harness/motion/parol6/checks.hpp"

#include <cmath>

#include "harness/motion/parol6/conversion.hpp"

namespace armjig::parol6::planning {
namespace {

/// What a sum of roundings may exceed a limit by.
constexpr double kRounding = 1 + 1e-9;

}  // namespace

std::optional<Refusal> check_percent(double percent) noexcept {
  if (percent >= 0 && percent <= 100) return std::nullopt;
  return Refusal{.reason = Refusal::Reason::kPercentOutOfRange, .value = percent, .limit = 100};
}

Refusal out_of_limits(std::size_t joint, double value, double limit) noexcept {
  return {.reason = Refusal::Reason::kOutOfLimits, .joint = joint, .value = value, .limit = limit};
}

tl::unexpected<Refusal> impossible(double duration) noexcept {
  return tl::unexpected{Refusal{.reason = Refusal::Reason::kImpossibleDuration, .value = duration}};
}

std::optional<Refusal> check_limits(const JointSteps& goal) noexcept {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto lower = kJoints[j].lower.value;
    const auto upper = kJoints[j].upper.value;
    const bool is_below = goal[j].value < nearest_step(steps_of_degrees(j, lower));
    const bool is_above = goal[j].value > nearest_step(steps_of_degrees(j, upper));
    if (is_below || is_above) {
      return out_of_limits(j, degrees_of(j, goal[j]), is_below ? lower : upper);
    }
  }
  return std::nullopt;
}

std::optional<Refusal> limit_in_the_way(const arm::Arm& arm, const arm::Branches& branches,
                                        const arm::SixJoints& seed, double time) {
  const auto joints = nearest(without_limits(arm), branches, seed);
  const auto j = joints ? first_outside(arm, *joints) : kJointCount;
  if (j == kJointCount) return std::nullopt;
  const auto& joint = arm.joints[j];
  const double angle = (*joints)[j];
  return Refusal{.reason = Refusal::Reason::kOutOfLimits,
                 .joint = j,
                 .value = to_degrees(angle),
                 .limit = to_degrees(angle < joint.lower ? joint.lower : joint.upper),
                 .time = time};
}

tl::expected<arm::SixJoints, Refusal> reach(const arm::Arm& arm, const arm::SphericalWrist& solver,
                                            const arm::Pose& pose, const arm::SixJoints& seed,
                                            double time) {
  const auto branches = solver.solve(pose, seed);
  if (const auto joints = nearest(arm, branches, seed)) return *joints;
  const Refusal unreachable{.reason = Refusal::Reason::kUnreachable, .time = time};
  return tl::unexpected{limit_in_the_way(arm, branches, seed, time).value_or(unreachable)};
}

std::optional<Refusal> check_peak(std::size_t joint, const Peak& peak) noexcept {
  const double max_speed = kJoints[joint].max_speed.value;
  const double max_acceleration = kPlannedJoints[joint].max_acceleration;
  if (std::abs(peak.speed) > max_speed * kRounding) {
    return Refusal{Refusal::Reason::kTooFast, joint, peak.speed, max_speed, peak.time};
  }
  if (std::abs(peak.acceleration) > max_acceleration * kRounding) {
    return Refusal{Refusal::Reason::kTooMuchAcceleration, joint, peak.acceleration,
                   max_acceleration, peak.time};
  }
  return std::nullopt;
}

}  // namespace armjig::parol6::planning
