// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "harness/motion/parol6/checks.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/joint_move.hpp"
#include "harness/motion/profile.hpp"

// The order of operations is the shipped program's: fractions of a step are cut off.
namespace armjig::parol6::planning {
namespace {

/// The limits themselves are refused: J5 cannot be sent to 90 degrees.
std::optional<Refusal> check_open_range(const arm::SixJoints& target) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& range = kJoints[j];
    const bool is_below = target[j] <= to_radians(range.lower.value);
    const bool is_above = target[j] >= to_radians(range.upper.value);
    if (is_below || is_above) {
      return out_of_limits(j, to_degrees(target[j]), (is_below ? range.lower : range.upper).value);
    }
  }
  return std::nullopt;
}

std::size_t leading_joint(const arm::SixJoints& from, const arm::SixJoints& to) noexcept {
  std::size_t leading = 0;
  for (std::size_t j = 1; j < kJointCount; ++j) {
    if (std::abs(to[j] - from[j]) > std::abs(to[leading] - from[leading])) leading = j;
  }
  return leading;
}

struct Sample {
  double position{};
  double speed{};
};

SetPoint polynomial(const arm::SixJoints& from, const arm::SixJoints& to, std::size_t k,
                    std::size_t last, double duration) noexcept {
  const motion::Quintic unit{0, 1, 1};
  const auto share = unit.at(static_cast<double>(k) / static_cast<double>(last));
  // In one loop for each operation, which compilers do for several joints at once.
  arm::SixJoints positions;
  arm::SixJoints speeds;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double way = to[j] - from[j];
    positions[j] = steps_of_radians(j, from[j] + way * share.position);
    speeds[j] = step_rate_of(j, way * share.speed / (duration - kTick));
  }
  SetPoint set_point;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    set_point.position[j] = Steps{cut_off(positions[j])};
    set_point.speed[j] = StepsPerSecond{cut_off(speeds[j])};
  }
  return set_point;
}

/// From `q0` to `qf` in the time `tf`, with the slopes given by the cruise speed `v`.
Sample trapezoid(double q0, double qf, double v, double tf, double t) noexcept {
  const double tb = tf - (qf - q0) / v;
  const double a = v / tb;
  if (t <= tb) return {q0 + a * t * t / 2, a * t};
  if (t <= tf - tb) return {(q0 + qf - v * tf) / 2 + v * t, v};
  return {qf - a * tf * tf / 2 + a * tf * t - a * t * t / 2, a * tf - a * t};
}

/// By thirds over the numbers of the samples, not over time: the speed of a sample is made one of a
/// second only after it was cut off to an integer.
SetPoint trapezoid_by_number(const arm::SixJoints& from, const arm::SixJoints& to, std::size_t k,
                             std::size_t last, double duration) noexcept {
  const auto tf = static_cast<double>(last);
  SetPoint set_point;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double way = to[j] - from[j];
    if (way == 0) {
      set_point.position[j] = Steps{cut_off(steps_of_radians(j, from[j]))};
      continue;
    }
    const auto [q, rate] = trapezoid(from[j], to[j], 1.5 * way / tf, tf, static_cast<double>(k));
    set_point.position[j] = Steps{cut_off(steps_of_radians(j, q))};
    const auto cut = cut_off(step_rate_of(j, rate / (duration - kTick)));
    set_point.speed[j] = StepsPerSecond{cut_off(cut * tf)};
  }
  return set_point;
}

tl::expected<Plan, Refusal> plan_in_time(const arm::SixJoints& from, const arm::SixJoints& to,
                                         double duration, Law law) {
  const auto count = static_cast<std::size_t>(duration / kTick);
  if (count == 0 || duration > kLongestMove) return impossible(duration);
  Plan plan{.law = law, .duration = duration, .leading_joint = leading_joint(from, to)};
  const auto last = count - 1;
  const auto sample = law == Law::kPolynomial ? polynomial : trapezoid_by_number;
  plan.set_points.reserve(last);
  for (std::size_t k = 1; k <= last; ++k) {
    plan.set_points.push_back(sample(from, to, k, last, duration));
  }
  return plan;
}

/// The grid on which a move at a pace is sampled.
struct Grid {
  double duration{};   ///< as computed, seconds
  double slope{};      ///< time of acceleration
  double last{};       ///< time of the last point
  std::size_t sent{};  ///< points 1 to `sent` leave
};

Grid grid_of(double way, double speed, double acceleration) noexcept {
  const double slope = speed / acceleration;
  const double duration = way / speed + slope;
  const double points = std::ceil(duration / kTick);
  const auto count = static_cast<std::size_t>(duration / kTick);
  return {duration, slope, (points - 1) * kTick, count == 0 ? 0 : count - 1};
}

/// The cruise speed of a joint, with its sign: an integer if that suits the grid, by thirds if not.
double cruise_of(double way, const Grid& grid) noexcept {
  const double length = std::abs(way);
  const double v = std::trunc(length / (grid.duration - grid.slope));
  const bool is_possible = length / grid.last <= v && v <= 2 * length / grid.last;
  return std::copysign(is_possible ? v : 1.5 * length / grid.last, way);
}

std::optional<Refusal> check_speed(const SetPoint& set_point, double time) noexcept {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto speed = set_point.speed[j].value;
    const auto limit = kJoints[j].max_speed.value;
    if (std::abs(speed) > limit) {
      return Refusal{Refusal::Reason::kTooFast, j, static_cast<double>(speed),
                     static_cast<double>(limit), time};
    }
  }
  return std::nullopt;
}

tl::expected<Plan, Refusal> plan_at_pace(const CommanderTarget& target, const JointSteps& start,
                                         double speed, double acceleration) {
  for (const double percent : {speed, acceleration}) {
    if (const auto refusal = check_percent(percent)) return tl::unexpected{*refusal};
  }
  const auto leading = leading_joint(radians_of(start), target.radians);
  const auto way_of = [&](std::size_t j) {
    return static_cast<double>(target.steps[j].value) - start[j].value;
  };
  // The time of the others is a division by the leading joint's, which may have no step to go.
  if (way_of(leading) == 0 && target.steps != start) return impossible(0);
  const double top = kJoints[leading].max_speed.value;
  const double v = std::trunc(kMinSpeed.value + speed / 100 * (top - kMinSpeed.value));
  const double a = kMinAcceleration + acceleration / 100 * (kMaxAcceleration - kMinAcceleration);
  const auto grid = grid_of(std::abs(way_of(leading)), v, a);
  Plan plan{.law = Law::kTrapezoid, .duration = grid.duration, .leading_joint = leading};
  plan.set_points.reserve(grid.sent);
  for (std::size_t k = 1; k <= grid.sent; ++k) {
    const double t = kTick * static_cast<double>(k);
    SetPoint set_point{.position = start};
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (target.steps[j] == start[j]) continue;
      const auto [q, rate] = trapezoid(start[j].value, target.steps[j].value,
                                       cruise_of(way_of(j), grid), grid.last, t);
      set_point.position[j] = Steps{cut_off(q)};
      set_point.speed[j] = StepsPerSecond{cut_off(rate)};
    }
    if (const auto refusal = check_speed(set_point, t)) return tl::unexpected{*refusal};
    plan.set_points.push_back(set_point);
  }
  return plan;
}

}  // namespace

tl::expected<Plan, Refusal> plan_commander_joints(const CommanderTarget& target,
                                                  const JointSteps& start, const Timing& timing,
                                                  Tracking tracking, LimitCheck limits) {
  if (limits == LimitCheck::kEnforced) {
    if (const auto refusal = check_open_range(target.radians)) return tl::unexpected{*refusal};
  }
  const double duration = timing.duration.value_or(0);
  const bool has_pace = timing.speed && timing.acceleration;
  if (duration < 0 && has_pace) return impossible(duration);
  auto plan = [&] {
    if (duration > 0) {
      const auto law = timing.law.value_or(Law::kPolynomial);
      return plan_in_time(radians_of(start), target.radians, duration, law);
    }
    if (has_pace) return plan_at_pace(target, start, *timing.speed, *timing.acceleration);
    return plan_at_pace(target, start, target.default_speed, target.default_acceleration);
  }();
  if (plan) plan->tracking = tracking;
  return plan;
}

}  // namespace armjig::parol6::planning
