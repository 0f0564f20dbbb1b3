// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "harness/core/quantity.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6 {

/// How far and how fast a joint may be driven.
struct JointBounds {
  Steps lower{};
  Steps upper{};
  StepsPerSecond max_speed{};  ///< of go-to set-points
  StepsPerSecond max_jog{};

  [[nodiscard]] constexpr bool contain(Steps position) const noexcept {
    return lower <= position && position <= upper;
  }
  /// Whether `speed` drives a joint that stands at or beyond a bound further out.
  [[nodiscard]] constexpr bool forbid(Steps position, StepsPerSecond speed) const noexcept {
    return (position >= upper && speed.value > 0) || (position <= lower && speed.value < 0);
  }
};

/// The vendor GUI's figures, in robot coordinates, which the counters have after homing.
inline constexpr std::array<JointBounds, kJointCount> kJointBounds{{
    {Steps{-14000}, Steps{14000}, StepsPerSecond{6500}, StepsPerSecond{1500}},
    {Steps{-51558}, Steps{-1200}, StepsPerSecond{18000}, StepsPerSecond{3000}},
    {Steps{34699}, Steps{92604}, StepsPerSecond{20000}, StepsPerSecond{3600}},
    {Steps{-7500}, Steps{7500}, StepsPerSecond{22000}, StepsPerSecond{7000}},
    {Steps{-6400}, Steps{6400}, StepsPerSecond{22000}, StepsPerSecond{7000}},
    {Steps{0}, Steps{64000}, StepsPerSecond{22000}, StepsPerSecond{18000}},
}};

}  // namespace armjig::parol6
