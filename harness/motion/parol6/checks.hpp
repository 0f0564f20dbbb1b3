// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <tl/expected.hpp>

#include "harness/arm/arm.hpp"
#include "harness/arm/spherical_wrist.hpp"
#include "harness/motion/parol6/planner.hpp"

/// What is looked at before the first frame of a move leaves.
namespace armjig::parol6::planning {

/// A percentage outside 0 to 100.
[[nodiscard]] std::optional<Refusal> check_percent(double percent) noexcept;

/// A target that is not within its joints' ranges, the limits themselves included.
[[nodiscard]] std::optional<Refusal> check_limits(const JointSteps& goal) noexcept;

/// The limit that the posture nearest to `seed` would be beyond, whatever other postures there are.
[[nodiscard]] std::optional<Refusal> limit_in_the_way(const arm::Arm& arm,
                                                      const arm::Branches& branches,
                                                      const arm::SixJoints& seed, double time);

/// The posture nearest to `seed` that has a pose, or why the arm has none.
[[nodiscard]] tl::expected<arm::SixJoints, Refusal> reach(const arm::Arm& arm,
                                                          const arm::SphericalWrist& solver,
                                                          const arm::Pose& pose,
                                                          const arm::SixJoints& seed, double time);

/// A joint beyond its range; in degrees.
[[nodiscard]] Refusal out_of_limits(std::size_t joint, double value, double limit) noexcept;

/// A move that cannot take that many seconds.
[[nodiscard]] tl::unexpected<Refusal> impossible(double duration) noexcept;

/// The fastest and the hardest moment of a joint: steps/s, steps/s^2, seconds since the begin.
struct Peak {
  double speed{};
  double acceleration{};
  double time{};
};
[[nodiscard]] std::optional<Refusal> check_peak(std::size_t joint, const Peak& peak) noexcept;

}  // namespace armjig::parol6::planning
