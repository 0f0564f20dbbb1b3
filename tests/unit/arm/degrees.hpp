// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "harness/arm/spherical_wrist.hpp"

/// Postures as people write them.
namespace armjig::test {

[[nodiscard]] constexpr double rad(double degrees) { return degrees * (std::numbers::pi / 180); }

[[nodiscard]] inline arm::SixJoints radians(arm::SixJoints degrees) {
  for (auto& q : degrees) q = rad(q);
  return degrees;
}

}  // namespace armjig::test
