// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "harness/core/quantity.hpp"
#include "harness/wire/parol6/joints.hpp"

namespace armjig::parol6 {

/// How far a joint may be driven.
struct JointBounds {
  Steps lower{};
  Steps upper{};

  /// Whether `speed` drives a joint that stands at or beyond a bound further out. For those who
  /// judge; the emulated board has a law of its own.
  [[nodiscard]] constexpr bool forbid(Steps position, StepsPerSecond speed) const noexcept {
    return (position >= upper && speed.value > 0) || (position <= lower && speed.value < 0);
  }
};

/// The ranges as the vendor's GUI makes steps of them: it cuts fractions off. In robot coordinates,
/// which the counters have after homing.
inline constexpr auto kJointBounds = [] {
  std::array<JointBounds, kJointCount> bounds{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto cut_off = [&](Degrees angle) {
      return Steps{static_cast<std::int32_t>(angle.value / kJoints[j].degrees_per_step())};
    };
    bounds[j] = {cut_off(kJoints[j].lower), cut_off(kJoints[j].upper)};
  }
  return bounds;
}();

}  // namespace armjig::parol6
