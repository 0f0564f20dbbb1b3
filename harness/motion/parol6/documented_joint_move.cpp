// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "harness/motion/parol6/checks.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/joint_move.hpp"
#include "harness/motion/profile.hpp"

namespace armjig::parol6::planning {
namespace {

// Percent; the commander's for MoveJoint.
constexpr double kDefaultSpeed = 45;
constexpr double kDefaultAcceleration = 27;

/// What a trapezoid may do at most, steps/s and steps/s^2 of the leading joint.
struct Pace {
  double speed{};
  double acceleration{};
};

tl::expected<Pace, Refusal> pace_of(const Timing& timing, std::size_t joint) {
  const double speed = timing.speed.value_or(kDefaultSpeed);
  const double acceleration = timing.acceleration.value_or(kDefaultAcceleration);
  for (const double percent : {speed, acceleration}) {
    if (const auto refusal = check_percent(percent)) return tl::unexpected{*refusal};
  }
  const double range = kJoints[joint].max_speed.value - kMinSpeed.value;
  return Pace{std::trunc(kMinSpeed.value + speed / 100 * range),
              kMinAcceleration + acceleration / 100 * (kMaxAcceleration - kMinAcceleration)};
}

/// The joint with the longest way as an angle.
std::size_t leading_joint(const JointSteps& from, const JointSteps& to) noexcept {
  std::size_t leading = 0;
  double longest = 0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double way = std::abs(degrees_of(j, to[j]) - degrees_of(j, from[j]));
    if (way > longest) {
      longest = way;
      leading = j;
    }
  }
  return leading;
}

/// Where from and where to, and how much time there is, on the grid of frames.
struct Way {
  JointSteps from{};
  JointSteps to{};
  std::size_t ticks{};

  [[nodiscard]] double of(std::size_t joint) const noexcept {
    return static_cast<double>(to[joint].value) - from[joint].value;
  }
  [[nodiscard]] double duration() const noexcept { return kTick * static_cast<double>(ticks); }
};

std::optional<Refusal> check(const Way& way, const motion::ProfilePeak& share, LimitCheck limits) {
  if (limits == LimitCheck::kIgnored) return std::nullopt;
  if (const auto refusal = check_limits(way.to)) return refusal;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Peak peak{way.of(j) * share.speed, way.of(j) * share.acceleration, share.time};
    if (const auto refusal = check_peak(j, peak)) return refusal;
  }
  return std::nullopt;
}

/// All joints are at the same share of their way at the same time. A board that is told speeds only
/// is told where the joints were, not where they shall be.
template <class Share>
std::vector<SetPoint> sampled(const Way& way, const Share& share, Tracking tracking) {
  std::vector<SetPoint> set_points(way.ticks + 1);
  for (std::size_t k = 0; k <= way.ticks; ++k) {
    const auto now = share.at(kTick * static_cast<double>(k));
    auto& set_point = set_points[k];
    for (std::size_t j = 0; j < kJointCount; ++j) {
      set_point.position[j] = Steps{cut_off(way.from[j].value + way.of(j) * now.position)};
      set_point.speed[j] = StepsPerSecond{cut_off(way.of(j) * now.speed)};
    }
    if (tracking == Tracking::kSpeed) set_point.position = way.from;
  }
  return set_points;
}

template <class Share>
tl::expected<Plan, Refusal> planned(const Way& way, const Share& share, Law law, Tracking tracking,
                                    LimitCheck limits) {
  if (const auto refusal = check(way, share.peak(), limits)) return tl::unexpected{*refusal};
  return Plan{.set_points = sampled(way, share, tracking),
              .tracking = tracking,
              .law = law,
              .duration = way.duration(),
              .leading_joint = leading_joint(way.from, way.to)};
}

/// In a time that was given, to the nearest frame.
tl::expected<Plan, Refusal> planned_in_time(Way way, double duration, Law law, Tracking tracking,
                                            LimitCheck limits) {
  if (!(duration >= kTick / 2 && duration <= kLongestMove)) return impossible(duration);
  way.ticks = static_cast<std::size_t>(std::llround(duration / kTick));
  if (law == Law::kPolynomial) {
    return planned(way, motion::Quintic{0, 1, way.duration()}, law, tracking, limits);
  }
  return planned(way, motion::Trapezoid::thirds(0, 1, way.duration()), law, tracking, limits);
}

/// As fast as the leading joint may: its trapezoid, stretched to whole frames, is everybody's.
tl::expected<Plan, Refusal> planned_at_pace(Way way, const Timing& timing, Tracking tracking,
                                            LimitCheck limits) {
  const auto leading = leading_joint(way.from, way.to);
  const auto pace = pace_of(timing, leading);
  if (!pace) return tl::unexpected{pace.error()};
  const auto fastest =
      motion::Trapezoid::fastest(0, way.of(leading), pace->speed, pace->acceleration);
  constexpr double kLeastPart = 1e-9;
  way.ticks = static_cast<std::size_t>(std::ceil(fastest.duration() / kTick - kLeastPart));
  if (way.ticks == 0) {  // nowhere to go
    return planned_in_time(way, kTick, Law::kTrapezoid, tracking, limits);
  }
  const double cruise =
      std::min(fastest.peak().speed / std::abs(way.of(leading)), 2 / way.duration());
  const auto share = motion::Trapezoid::cruising(0, 1, cruise, way.duration());
  return planned(way, share, Law::kTrapezoid, tracking, limits);
}

}  // namespace

tl::expected<Plan, Refusal> plan_documented_joints(const arm::SixJoints& target,
                                                   const JointSteps& start, const Timing& timing,
                                                   Tracking tracking, LimitCheck limits) {
  Way way{.from = start};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    way.to[j] = Steps{nearest_step(steps_of_radians(j, target[j]))};
  }
  if (!timing.duration) return planned_at_pace(way, timing, tracking, limits);
  const auto law = timing.law.value_or(Law::kPolynomial);
  return planned_in_time(way, *timing.duration, law, tracking, limits);
}

}  // namespace armjig::parol6::planning
