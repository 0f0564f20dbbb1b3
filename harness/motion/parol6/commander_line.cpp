// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "harness/arm/models.hpp"
#include "harness/motion/parol6/checks.hpp"
#include "harness/motion/parol6/commander_ik.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/line.hpp"
#include "harness/motion/pose_line.hpp"
#include "harness/motion/profile.hpp"

// The order of operations is the shipped program's: fractions of a step are cut off.
namespace armjig::parol6::planning {
namespace {

/// What the commander takes away from telemetry before a line, radians.
constexpr arm::SixJoints kStartNudge{1e-4, 1.5e-4, 1.5e-4, 1.5e-4, 1.5e-4, 1e-3};

/// A joint that changes its sign from one tick to the next is taken for one that jumps.
bool has_flipped(double before, double now) noexcept {
  constexpr double kJump = 0.7;
  constexpr double kZero = 1e-4;
  const bool is_across = (before > 0 && now < 0) || (before < 0 && now > 0);
  const bool is_at_zero = std::abs(before) <= kZero && std::abs(now) <= kZero;
  return is_across && std::abs(std::abs(now) - std::abs(before)) <= kJump && !is_at_zero;
}

SetPoint set_point_of(const arm::SixJoints& before, const arm::SixJoints& now) noexcept {
  SetPoint set_point;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    set_point.position[j] = Steps{cut_off(steps_of_radians(j, now[j]))};
    set_point.speed[j] = StepsPerSecond{cut_off(step_rate_of(j, (now[j] - before[j]) / kTick))};
  }
  return set_point;
}

/// What ends the program at a tick, looked at in this order. Only speeds above zero can be too
/// fast.
std::optional<Refusal> stop_at(const arm::SixJoints& before, const CommanderIkAnswer& now,
                               const SetPoint& set_point, double time) noexcept {
  if (!now.has_converged) return Refusal{.reason = Refusal::Reason::kNotConverged, .time = time};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (has_flipped(before[j], now.joints[j])) {
      return Refusal{.reason = Refusal::Reason::kSignFlip, .joint = j, .time = time};
    }
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double speed = set_point.speed[j].value;
    const double limit = kJoints[j].max_speed.value;
    if (speed > limit) return Refusal{Refusal::Reason::kTooFast, j, speed, limit, time};
  }
  return std::nullopt;
}

}  // namespace

double commander_path_share(Law law, double t, double last) noexcept {
  const double profiled = law == Law::kPolynomial
                              ? motion::Quintic{0, 1, last}.at(t).position
                              : motion::Trapezoid::thirds(0, 1, last).at(t).position;
  return motion::Trapezoid::thirds(0, 1, 1).at(profiled).position;
}

tl::expected<Plan, Refusal> plan_commander_line(const LineTarget& target, const JointSteps& start,
                                                const Timing& timing, Tracking tracking) {
  double duration = timing.duration.value_or(0);
  if (duration <= 0 && timing.speed && timing.acceleration) {
    for (const double percent : {*timing.speed, *timing.acceleration}) {
      if (const auto refusal = check_percent(percent)) return tl::unexpected{*refusal};
    }
  }
  const bool crashes = duration < 0 && timing.speed && timing.acceleration;
  if (crashes || duration > kLongestMove) return impossible(duration);
  if (duration <= 0) duration = kDefaultLineDuration;
  const auto count = static_cast<std::size_t>(duration / kTick);
  const double last = (std::ceil(duration / kTick) - 1) * kTick;

  const auto arm = arm::parol6_commander();
  auto joints = radians_of(start);
  for (std::size_t j = 0; j < kJointCount; ++j) joints[j] -= kStartNudge[j];
  const auto from = forward(arm, joints);
  const motion::PoseLine line{from, target.from(from), motion::Turn::kUncorrected};

  // Of a turn so close to a whole one, the quaternions between keep fewer than ten digits.
  constexpr double kNearlyWhole = 2e-3;
  if (line.turn() > 2 * std::numbers::pi - kNearlyWhole) {
    return tl::unexpected{Refusal{.reason = Refusal::Reason::kNoTurn}};
  }

  Plan plan{
      .tracking = tracking, .law = timing.law.value_or(Law::kTrapezoid), .duration = duration};
  plan.turns_long_way = line.turn() > std::numbers::pi;
  for (std::size_t k = 1; k + 1 <= count && !plan.stop; ++k) {
    const double t = kTick * static_cast<double>(k);
    const auto now = commander_ik(arm, line.at(commander_path_share(plan.law, t, last)), joints);
    const auto set_point = set_point_of(joints, now.joints);
    plan.stop = stop_at(joints, now, set_point, t);
    const bool is_sent = !plan.stop || plan.stop->reason == Refusal::Reason::kNotConverged;
    if (is_sent) plan.set_points.push_back(set_point);
    joints = now.joints;
  }
  return plan;
}

}  // namespace armjig::parol6::planning
