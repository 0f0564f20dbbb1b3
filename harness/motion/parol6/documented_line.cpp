// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "harness/arm/models.hpp"
#include "harness/motion/parol6/checks.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/line.hpp"
#include "harness/motion/parol6/singularities.hpp"
#include "harness/motion/pose_line.hpp"
#include "harness/motion/profile.hpp"

namespace armjig::parol6::planning {
namespace {

/// Radians in a tick.
double fastest_step(std::size_t joint) noexcept {
  return kJoints[joint].max_speed.value * kTick / steps_of_radians(joint, 1);
}

/// As far towards `wanted` as every joint can go in a tick.
arm::SixJoints approached(const arm::SixJoints& before, const arm::SixJoints& wanted) noexcept {
  auto joints = wanted;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    joints[j] = std::clamp(wanted[j], before[j] - fastest_step(j), before[j] + fastest_step(j));
  }
  return joints;
}

/// What a joint cannot do between two ticks, the arm standing still before the first.
std::optional<Refusal> check_step(const std::vector<arm::SixJoints>& path,
                                  const arm::SixJoints& now) noexcept {
  const auto& last = path.back();
  const auto& before = path.size() > 1 ? path[path.size() - 2] : last;
  const double time = kTick * static_cast<double>(path.size());
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double speed = step_rate_of(j, (now[j] - last[j]) / kTick);
    const double speed_before = step_rate_of(j, (last[j] - before[j]) / kTick);
    if (const auto refusal = check_peak(j, {speed, (speed - speed_before) / kTick, time})) {
      return refusal;
    }
  }
  return std::nullopt;
}

arm::Arm arm_for(LimitCheck limits) {
  auto arm = arm::parol6_commander();
  return limits == LimitCheck::kIgnored ? without_limits(std::move(arm)) : arm;
}

/// The postures along a line, one each tick, as long as the arm can follow.
class Follower {
 public:
  Follower(const arm::SixJoints& start, const PlannerSettings& settings)
      : settings_{settings}, arm_{arm_for(settings.limits)}, path_{start} {}

  [[nodiscard]] arm::Pose start_pose() const noexcept { return forward(arm_, path_.front()); }

  /// Why no posture has that pose, whatever lies between.
  [[nodiscard]] std::optional<Refusal> check_target(const arm::Pose& pose, double time) const {
    const auto joints = reach(arm_, solver_, pose, path_.front(), time);
    return joints ? std::nullopt : std::optional{joints.error()};
  }

  /// The posture of the next tick. A refusal ends the path in front of it.
  [[nodiscard]] std::optional<Refusal> go_to(const arm::Pose& pose) {
    const double time = kTick * static_cast<double>(path_.size());
    const auto joints = reach(arm_, solver_, pose, path_.back(), time);
    if (!joints) return joints.error();
    const auto refusal = check_step(path_, *joints);
    if (!refusal || settings_.limits == LimitCheck::kIgnored) {
      is_beside_ = false;
      path_.push_back(*joints);
      return std::nullopt;
    }
    const bool is_near =
        singularity_near(solver_, path_.back()) || singularity_near(solver_, *joints);
    if (settings_.on_singularity == OnSingularity::kTry && (is_near || is_beside_)) {
      is_beside_ = true;
      path_.push_back(approached(path_.back(), *joints));
      return std::nullopt;
    }
    if (!is_near) {
      // Who leaps without a singularity does so into another posture, away from a limit.
      const auto branches = solver_.solve(pose, path_.back());
      return limit_in_the_way(arm_, branches, path_.back(), time).value_or(*refusal);
    }
    return Refusal{.reason = Refusal::Reason::kSingular, .joint = refusal->joint, .time = time};
  }

  [[nodiscard]] const std::vector<arm::SixJoints>& path() const noexcept { return path_; }
  [[nodiscard]] std::vector<SingularityNote> singularities() const {
    return singularities_on(arm_, solver_, path_);
  }

 private:
  PlannerSettings settings_;
  arm::Arm arm_;
  arm::SphericalWrist solver_ = *arm::SphericalWrist::of(arm_);
  std::vector<arm::SixJoints> path_;
  bool is_beside_ = false;  ///< the line, since a joint could not follow
};

/// Set-points for a path: positions to the nearest step, lest the tool leave its line, and the
/// central difference of the path as speed. Speeds at both ends are 0.
std::vector<SetPoint> set_points_for(const std::vector<arm::SixJoints>& path, Tracking tracking,
                                     const JointSteps& start) {
  std::vector<SetPoint> set_points(path.size());
  for (std::size_t k = 0; k < path.size(); ++k) {
    auto& set_point = set_points[k];
    const bool is_inside = k > 0 && k + 1 < path.size();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      set_point.position[j] = Steps{nearest_step(steps_of_radians(j, path[k][j]))};
      const double way = is_inside ? path[k + 1][j] - path[k - 1][j] : 0;
      set_point.speed[j] = StepsPerSecond{cut_off(step_rate_of(j, way / (2 * kTick)))};
    }
    if (tracking == Tracking::kSpeed) set_point.position = start;
  }
  return set_points;
}

double share_of(Law law, double t, double duration) noexcept {
  return law == Law::kPolynomial ? motion::Quintic{0, 1, duration}.at(t).position
                                 : motion::Trapezoid::thirds(0, 1, duration).at(t).position;
}

}  // namespace

tl::expected<Plan, Refusal> plan_documented_line(const LineTarget& target, const JointSteps& start,
                                                 const Timing& timing, Tracking tracking,
                                                 const PlannerSettings& settings) {
  const double wanted = timing.duration.value_or(kDefaultLineDuration);
  if (!(wanted >= kTick / 2 && wanted <= kLongestMove)) return impossible(wanted);
  const auto last = static_cast<std::size_t>(std::llround(wanted / kTick));
  const double duration = kTick * static_cast<double>(last);
  const auto law = timing.law.value_or(Law::kPolynomial);

  Follower follower{radians_of(start), settings};
  const auto from = follower.start_pose();
  const auto to = target.from(from);
  if (const auto refusal = follower.check_target(to, duration)) return tl::unexpected{*refusal};
  const motion::PoseLine line{from, to};
  Plan plan{.tracking = tracking, .law = law, .duration = duration};
  for (std::size_t k = 1; k <= last && !plan.stop; ++k) {
    const double t = kTick * static_cast<double>(k);
    const auto refusal = follower.go_to(line.at(share_of(law, t, duration)));
    const bool may_stop = refusal && refusal->reason == Refusal::Reason::kSingular &&
                          settings.on_singularity == OnSingularity::kStop;
    if (refusal && !may_stop) return tl::unexpected{*refusal};
    plan.stop = refusal;
  }
  plan.set_points = set_points_for(follower.path(), tracking, start);
  plan.singularities = follower.singularities();
  return plan;
}

}  // namespace armjig::parol6::planning
