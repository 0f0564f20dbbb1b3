// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/quantity.hpp"
#include "harness/motion/parol6/planner.hpp"

namespace armjig::parol6::planning {

/// The speed at which the board runs a joint until the next frame, told `position` and `speed` and
/// being at `now` (docs/spec/parol6.md, "Go to"). Speeds only: the speed. Both: the mean of the
/// speed and of that which would close the distance in 10 ms, in the board's integers. In
/// continuous terms dp/dt = speed/2 + 50/s (position - now): it lags behind a moving set-point by
/// one tick if the speed is right, and by two if it is 0.
[[nodiscard]] constexpr StepsPerSecond tracking_speed(Tracking tracking, Steps position,
                                                      StepsPerSecond speed, Steps now) noexcept {
  if (tracking == Tracking::kSpeed) return speed;
  const auto closing = std::int64_t{100} * (std::int64_t{position.value} - now.value);
  return StepsPerSecond{static_cast<std::int32_t>((speed.value + closing) / 2)};
}

}  // namespace armjig::parol6::planning
