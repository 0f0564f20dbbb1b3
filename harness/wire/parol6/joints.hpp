// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "harness/core/quantity.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::unit {
struct DegreesPerSecond {
  static constexpr auto symbol = "deg/s";
};
}  // namespace armjig::unit

namespace armjig {
using DegreesPerSecond = Quantity<unit::DegreesPerSecond, double>;
}  // namespace armjig

namespace armjig::parol6 {

/// A joint as far as its gearing: the one place where counts become angles and angles counts. The
/// angles are those of the robot once the joint is homed; before, the counters begin where the arm
/// was switched on.
class Joint {
 public:
  /// `reduction`: motor turns for one turn of the joint.
  constexpr explicit Joint(double reduction) noexcept
      : degrees_per_step_{360.0 / (kStepsPerTurn * reduction)} {}

  [[nodiscard]] constexpr Degrees angle(Steps position) const noexcept {
    return Degrees{position.value * degrees_per_step_};
  }
  [[nodiscard]] constexpr DegreesPerSecond speed(StepsPerSecond speed) const noexcept {
    return DegreesPerSecond{speed.value * degrees_per_step_};
  }

  /// The nearest step, as the board's own constants have it; the vendor's GUI cuts off toward zero.
  /// Requires a result that fits in 32 bits.
  [[nodiscard]] constexpr Steps position(Degrees angle) const noexcept {
    return Steps{nearest(angle.value / degrees_per_step_)};
  }
  [[nodiscard]] constexpr StepsPerSecond speed(DegreesPerSecond speed) const noexcept {
    return StepsPerSecond{nearest(speed.value / degrees_per_step_)};
  }

 private:
  static constexpr double kStepsPerTurn = 6400.0;  ///< 200 full steps, 32 microsteps each

  static constexpr std::int32_t nearest(double value) noexcept {
    return static_cast<std::int32_t>(value + (value < 0.0 ? -0.5 : 0.5));
  }

  double degrees_per_step_;
};

inline constexpr std::array<Joint, kJointCount> kJoints{
    Joint{6.4}, Joint{20.0}, Joint{20.0 * 38.0 / 42.0}, Joint{4.0}, Joint{4.0}, Joint{10.0}};

}  // namespace armjig::parol6
