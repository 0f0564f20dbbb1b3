// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

/// Rigid motions. Plain values: what Eigen aligns depends on its user's compiler flags, so its
/// types stay out of headers that are installed.
namespace armjig::arm {

struct Vector3 {
  double x{};
  double y{};
  double z{};

  friend constexpr bool operator==(const Vector3&, const Vector3&) noexcept = default;
  friend constexpr Vector3 operator+(const Vector3& a, const Vector3& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr Vector3 operator-(const Vector3& a, const Vector3& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend constexpr Vector3 operator-(const Vector3& a) noexcept { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vector3 operator*(double factor, const Vector3& a) noexcept {
    return {factor * a.x, factor * a.y, factor * a.z};
  }
};

[[nodiscard]] constexpr double dot(const Vector3& a, const Vector3& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] constexpr Vector3 cross(const Vector3& a, const Vector3& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline double norm(const Vector3& a) noexcept { return std::sqrt(dot(a, a)); }

/// A rotation matrix, row by row; its columns are the turned frame's axes.
struct Rotation {
  std::array<Vector3, 3> rows{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};

  [[nodiscard]] constexpr Vector3 x_axis() const noexcept {
    return {rows[0].x, rows[1].x, rows[2].x};
  }
  [[nodiscard]] constexpr Vector3 y_axis() const noexcept {
    return {rows[0].y, rows[1].y, rows[2].y};
  }
  [[nodiscard]] constexpr Vector3 z_axis() const noexcept {
    return {rows[0].z, rows[1].z, rows[2].z};
  }

  friend constexpr bool operator==(const Rotation&, const Rotation&) noexcept = default;
  friend constexpr Vector3 operator*(const Rotation& r, const Vector3& v) noexcept {
    return {dot(r.rows[0], v), dot(r.rows[1], v), dot(r.rows[2], v)};
  }
  friend constexpr Rotation operator*(const Rotation& a, const Rotation& b) noexcept {
    Rotation product;
    for (std::size_t i = 0; i < 3; ++i) {
      product.rows[i] = a.rows[i].x * b.rows[0] + a.rows[i].y * b.rows[1] + a.rows[i].z * b.rows[2];
    }
    return product;
  }
};

/// The transpose, which is the inverse.
[[nodiscard]] constexpr Rotation inverse(const Rotation& r) noexcept {
  return {{r.x_axis(), r.y_axis(), r.z_axis()}};
}

[[nodiscard]] inline Rotation rotation_x(double angle) noexcept {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{Vector3{1, 0, 0}, Vector3{0, c, -s}, Vector3{0, s, c}}};
}
[[nodiscard]] inline Rotation rotation_y(double angle) noexcept {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{Vector3{c, 0, s}, Vector3{0, 1, 0}, Vector3{-s, 0, c}}};
}
[[nodiscard]] inline Rotation rotation_z(double angle) noexcept {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{Vector3{c, -s, 0}, Vector3{s, c, 0}, Vector3{0, 0, 1}}};
}

/// By `angle` radians about `axis`. Requires `norm(axis) == 1`.
[[nodiscard]] Rotation rotation_about(const Vector3& axis, double angle) noexcept;

/// The axis of a rotation times its angle, 0 to pi.
[[nodiscard]] Vector3 rotation_vector(const Rotation& rotation) noexcept;

/// The angle between two orientations, 0 to pi.
[[nodiscard]] double angle_between(const Rotation& a, const Rotation& b) noexcept;

/// Where a frame is, in metres, and how it is turned, in another one.
struct Pose {
  Rotation rotation{};
  Vector3 position{};

  friend constexpr bool operator==(const Pose&, const Pose&) noexcept = default;
  friend constexpr Pose operator*(const Pose& a, const Pose& b) noexcept {
    return {a.rotation * b.rotation, a.rotation * b.position + a.position};
  }
};

[[nodiscard]] constexpr Pose inverse(const Pose& pose) noexcept {
  const auto back = inverse(pose.rotation);
  return {back, -(back * pose.position)};
}

[[nodiscard]] constexpr Pose translation(const Vector3& by) noexcept { return {{}, by}; }

}  // namespace armjig::arm
