// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace armjig::arm {

/// Into (-pi, pi], from at most one turn outside.
[[nodiscard]] constexpr double wrapped(double angle) noexcept {
  using std::numbers::pi;
  if (angle > pi) return angle - 2 * pi;
  if (angle <= -pi) return angle + 2 * pi;
  return angle;
}

}  // namespace armjig::arm
