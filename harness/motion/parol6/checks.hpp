// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <tl/expected.hpp>

#include "harness/motion/parol6/planner.hpp"

/// What is looked at before the first frame of a move leaves.
namespace armjig::parol6 {

/// A percentage outside 0 to 100.
[[nodiscard]] std::optional<Refusal> check_percent(double percent) noexcept;

/// A target that is not within its joints' ranges, the limits themselves included.
[[nodiscard]] std::optional<Refusal> check_limits(const JointSteps& goal) noexcept;

/// The fastest and the hardest moment of a joint: steps/s, steps/s^2, seconds since the begin.
struct Peak {
  double speed{};
  double acceleration{};
  double time{};
};
[[nodiscard]] std::optional<Refusal> check_peak(std::size_t joint, const Peak& peak) noexcept;

}  // namespace armjig::parol6
