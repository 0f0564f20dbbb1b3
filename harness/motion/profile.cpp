// SPDX-License-Identifier: Apache-2.0
#include "harness/motion/profile.hpp"

#include <algorithm>
#include <cassert>

namespace armjig::motion {
namespace {

struct Powers {
  double u{};
  double u2{};
  double u3{};
  double u4{};
  double u5{};
};

/// Each rounded once, as `pow` does it, at a fraction of its cost: what a product loses is carried
/// along.
Powers powers(double u) noexcept {
  const double u2 = u * u;
  const double lost2 = std::fma(u, u, -u2);
  const double u4 = u2 * u2;
  const double lost4 = std::fma(u2, u2, -u4) + 2 * u2 * lost2;
  return {u, u2, std::fma(u2, u, lost2 * u), u4 + lost4, std::fma(u4, u, lost4 * u)};
}

}  // namespace

// The order of operations below decides where a sample falls when fractions of a step are cut off:
// it is that of the recordings (captures/parol6/planner_*).

Trapezoid Trapezoid::thirds(double from, double to, double duration) noexcept {
  assert(duration > 0);
  const double blend = duration * (1.0 / 3.0);
  return {from, to, blend, duration};
}

Trapezoid Trapezoid::cruising(double from, double to, double speed, double duration) noexcept {
  assert(duration > 0);
  const double way = std::abs(to - from);
  const double mean = way / duration;
  const bool is_possible = speed > mean && speed <= 2 * mean;
  if (!is_possible) return thirds(from, to, duration);
  return {from, to, duration - way / speed, duration};
}

Trapezoid Trapezoid::fastest(double from, double to, double speed, double acceleration) noexcept {
  assert(speed > 0 && acceleration > 0);
  const double way = std::abs(to - from);
  const double blend = std::min(speed / acceleration, std::sqrt(way / acceleration));
  const double cruise = blend * acceleration;
  return {from, to, blend, way > 0 ? way / cruise + blend : 0};
}

ProfilePoint Trapezoid::at(double t) const noexcept {
  const double left = duration_ - t;
  if (t < blend_) {
    return {from_ + way_ * (acceleration_ * t * t / 2), way_ * (acceleration_ * t),
            way_ * acceleration_};
  }
  if (t < duration_ - blend_) {
    return {from_ + way_ * (cruise_ * (t - blend_ / 2)), way_ * cruise_, 0};
  }
  return {from_ + way_ * (1 - acceleration_ * left * left / 2), way_ * (acceleration_ * left),
          -way_ * acceleration_};
}

ProfilePeak Quintic::peak() const noexcept {
  const double way = std::abs(way_);
  return {1.875 * way / duration_, 10 / std::sqrt(3.0) * way / (duration_ * duration_),
          duration_ / 2};
}

ProfilePoint Quintic::at(double t) const noexcept {
  const auto [u, u2, u3, u4, u5] = powers(t / duration_);
  return {from_ + way_ * (10 * u3 - 15 * u4 + 6 * u5),
          way_ * (30 * u2 - 60 * u3 + 30 * u4) / duration_,
          way_ * (60 * u - 180 * u2 + 120 * u3) / (duration_ * duration_)};
}

}  // namespace armjig::motion
