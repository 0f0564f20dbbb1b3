// SPDX-License-Identifier: Apache-2.0
#include "harness/arm/pose.hpp"

#include <algorithm>
#include <numbers>

namespace armjig::arm {
namespace {

/// The axis of a turn by pi: the column of (R + 1) / 2 that is longest, for its length is the
/// largest of the axis' three components.
Vector3 half_turn_axis(const Rotation& r) noexcept {
  const std::array columns{r.x_axis() + Vector3{1, 0, 0}, r.y_axis() + Vector3{0, 1, 0},
                           r.z_axis() + Vector3{0, 0, 1}};
  const auto longest =
      *std::ranges::max_element(columns, {}, [](const Vector3& c) { return dot(c, c); });
  return 1.0 / norm(longest) * longest;
}

}  // namespace

Rotation rotation_about(const Vector3& axis, double angle) noexcept {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const auto [x, y, z] = axis;
  const double t = 1 - c;
  return {{Vector3{t * x * x + c, t * x * y - s * z, t * x * z + s * y},
           Vector3{t * x * y + s * z, t * y * y + c, t * y * z - s * x},
           Vector3{t * x * z - s * y, t * y * z + s * x, t * z * z + c}}};
}

Vector3 rotation_vector(const Rotation& r) noexcept {
  // 2 sin(angle) times the axis, and 2 cos(angle): together precise at every angle but pi.
  const Vector3 twice_sine{r.rows[2].y - r.rows[1].z, r.rows[0].z - r.rows[2].x,
                           r.rows[1].x - r.rows[0].y};
  const double sine = norm(twice_sine);
  const double cosine = r.rows[0].x + r.rows[1].y + r.rows[2].z - 1;
  constexpr double kNoAxis = 1e-7;
  if (sine < kNoAxis) {
    return cosine > 0 ? 0.5 * twice_sine : std::numbers::pi * half_turn_axis(r);
  }
  return std::atan2(sine, cosine) / sine * twice_sine;
}

double angle_between(const Rotation& a, const Rotation& b) noexcept {
  return norm(rotation_vector(inverse(a) * b));
}

}  // namespace armjig::arm
