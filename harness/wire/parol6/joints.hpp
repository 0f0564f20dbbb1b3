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

/// What a motor needs for one turn: 200 full steps of 32 microsteps each.
inline constexpr double kMotorStepsPerTurn = 6400.0;

/// What is known of a joint: its gearing, which makes angles of counts, and the figures of the
/// vendor's host programs. The angles are those of the robot once the joint is homed; before, the
/// counters begin where the arm was switched on.
struct Joint {
  double reduction{};  ///< motor turns for one turn of the joint
  Degrees lower{};     ///< of its range, as is `upper`
  Degrees upper{};
  StepsPerSecond max_speed{};  ///< of go-to set-points of the GUI; the API has another table
  StepsPerSecond max_jog{};    ///< of the GUI
  Steps standby{};             ///< what homing ends with

  [[nodiscard]] constexpr Degrees angle(Steps position) const noexcept {
    return Degrees{position.value * degrees_per_step()};
  }
  [[nodiscard]] constexpr DegreesPerSecond speed(StepsPerSecond speed) const noexcept {
    return DegreesPerSecond{speed.value * degrees_per_step()};
  }

  /// The nearest step, as the board's own constants have it; the vendor's GUI cuts off toward zero.
  /// Requires a result that fits in 32 bits.
  [[nodiscard]] constexpr Steps position(Degrees angle) const noexcept {
    return Steps{nearest(angle.value / degrees_per_step())};
  }
  [[nodiscard]] constexpr StepsPerSecond speed(DegreesPerSecond speed) const noexcept {
    return StepsPerSecond{nearest(speed.value / degrees_per_step())};
  }

  [[nodiscard]] constexpr double degrees_per_step() const noexcept {
    return 360.0 / (kMotorStepsPerTurn * reduction);
  }

 private:
  static constexpr std::int32_t nearest(double value) noexcept {
    return static_cast<std::int32_t>(value + (value < 0.0 ? -0.5 : 0.5));
  }
};

inline constexpr std::array<Joint, kJointCount> kJoints{{
    {6.4, Degrees{-123.046875}, Degrees{123.046875}, StepsPerSecond{6500}, StepsPerSecond{1500},
     Steps{10'240}},
    {20.0, Degrees{-145.0088}, Degrees{-3.375}, StepsPerSecond{18'000}, StepsPerSecond{3000},
     Steps{-32'000}},
    {20.0 * 38.0 / 42.0, Degrees{107.866}, Degrees{287.8675}, StepsPerSecond{20'000},
     StepsPerSecond{3600}, Steps{57'905}},
    {4.0, Degrees{-105.46975}, Degrees{105.46975}, StepsPerSecond{22'000}, StepsPerSecond{7000},
     Steps{0}},
    {4.0, Degrees{-90}, Degrees{90}, StepsPerSecond{22'000}, StepsPerSecond{7000}, Steps{0}},
    {10.0, Degrees{0}, Degrees{360}, StepsPerSecond{22'000}, StepsPerSecond{18'000}, Steps{32'000}},
}};

/// One figure of all joints, as in `of_joints(&Joint::max_speed)`.
template <class Figure>
[[nodiscard]] constexpr std::array<Figure, kJointCount> of_joints(Figure Joint::* figure) noexcept {
  std::array<Figure, kJointCount> figures{};
  for (std::size_t j = 0; j < kJointCount; ++j) figures[j] = kJoints[j].*figure;
  return figures;
}

/// Where homing leaves the counters.
inline constexpr JointSteps kStandby = of_joints(&Joint::standby);

/// The most that a joint of the shipped board steps.
inline constexpr StepsPerSecond kMaxStepRate{50'000};

}  // namespace armjig::parol6
