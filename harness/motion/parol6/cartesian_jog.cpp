// SPDX-License-Identifier: Apache-2.0
#include "harness/motion/parol6/cartesian_jog.hpp"

#include <cmath>
#include <cstddef>

#include "harness/arm/models.hpp"
#include "harness/motion/parol6/commander_ik.hpp"
#include "harness/motion/parol6/conversion.hpp"

namespace armjig::parol6 {
namespace {

arm::Rotation turned(const arm::Vector3& by) noexcept {
  const double angle = arm::norm(by);
  return angle > 0 ? arm::rotation_about(1 / angle * by, angle) : arm::Rotation{};
}

/// Where the tool is a tick later.
arm::Pose moved(const arm::Pose& pose, const CartesianJog& jog) noexcept {
  const auto way = kTick * jog.velocity.linear;
  const auto turn = turned(kTick * jog.velocity.angular);
  if (jog.frame == JogFrame::kTool) return pose * arm::Pose{turn, way};
  return {turn * pose.rotation, pose.position + way};
}

}  // namespace

tl::expected<JointSpeeds, Refusal> jog_speeds(const CartesianJog& jog, const JointSteps& now) {
  constexpr int kIterations = 6;  // as many as the commander has time for in a tick
  const auto arm = arm::parol6_commander();
  const auto here = radians_of(now);
  const auto answer = commander_ik(arm, moved(forward(arm, here), jog), here, kIterations);
  if (!answer.has_converged) {
    return tl::unexpected{Refusal{.reason = Refusal::Reason::kNotConverged, .time = kTick}};
  }
  JointSpeeds speeds;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double way = std::remainder(answer.joints[j] - here[j], 2 * std::numbers::pi);
    const double speed = step_rate_of(j, way / kTick);
    const double limit = kJointRanges[j].max_jog_speed.value;
    if (std::abs(speed) > limit) {
      return tl::unexpected{Refusal{Refusal::Reason::kTooFast, j, speed, limit, kTick}};
    }
    const auto& range = kJointRanges[j];
    const double end = (speed > 0 ? range.upper : range.lower).value;
    const double angle = degrees_of(j, now[j]);
    speeds[j] = StepsPerSecond{cut_off(speed)};
    const bool goes_beyond = speeds[j].value > 0 ? angle >= end : angle <= end;
    if (speeds[j].value != 0 && goes_beyond) {
      return tl::unexpected{Refusal{Refusal::Reason::kOutOfLimits, j, angle, end, kTick}};
    }
  }
  return speeds;
}

}  // namespace armjig::parol6
