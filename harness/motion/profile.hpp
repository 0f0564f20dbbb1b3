// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

/// How a value goes from one place to another in a time. Units are the caller's, time in seconds.
namespace armjig::motion {

struct ProfilePoint {
  double position{};
  double speed{};
  double acceleration{};  ///< where it jumps, that of the phase which begins there
};

/// The largest speed and acceleration of a profile, by magnitude, and when the speed is reached.
struct ProfilePeak {
  double speed{};
  double acceleration{};
  double time{};
};

/// Accelerates, cruises and brakes, each at a constant rate; the triangle is the one without
/// cruise.
class Trapezoid {
 public:
  /// A third of the time for each phase. Requires `duration > 0`.
  [[nodiscard]] static Trapezoid thirds(double from, double to, double duration) noexcept;

  /// At that cruise speed, so that it ends in time. A speed that would not cover the way in that
  /// time, or only by jumps, is replaced by that of `thirds`. Requires `duration > 0`.
  [[nodiscard]] static Trapezoid cruising(double from, double to, double speed,
                                          double duration) noexcept;

  /// As fast as these limits allow; a triangle if the way is too short to cruise. Requires both
  /// limits above 0.
  [[nodiscard]] static Trapezoid fastest(double from, double to, double speed,
                                         double acceleration) noexcept;

  [[nodiscard]] double duration() const noexcept { return duration_; }
  [[nodiscard]] double blend() const noexcept { return blend_; }  ///< time of each slope
  /// Has the sign of the way.
  [[nodiscard]] double cruise() const noexcept { return way_ * cruise_; }

  [[nodiscard]] ProfilePeak peak() const noexcept {
    return {std::abs(way_) * cruise_, std::abs(way_) * acceleration_, blend_};
  }

  /// Requires `0 <= t <= duration()`.
  [[nodiscard]] ProfilePoint at(double t) const noexcept;

 private:
  Trapezoid(double from, double to, double blend, double duration) noexcept
      : from_{from},
        way_{to - from},
        blend_{blend},
        duration_{duration},
        cruise_{duration > 0 ? 1 / (duration - blend) : 0},
        acceleration_{duration > 0 ? 1 / (blend * (duration - blend)) : 0} {}

  double from_;
  double way_;
  double blend_;
  double duration_;
  double cruise_;        ///< for a way of 1
  double acceleration_;  ///< for a way of 1
};

/// The polynomial of fifth degree that begins and ends without speed and acceleration. Its peak
/// speed is 1.875 times the mean, its peak acceleration 10 / sqrt(3) times the way by the time
/// squared.
class Quintic {
 public:
  /// Requires `duration > 0`.
  Quintic(double from, double to, double duration) noexcept
      : from_{from}, way_{to - from}, duration_{duration} {}

  [[nodiscard]] double duration() const noexcept { return duration_; }
  [[nodiscard]] ProfilePeak peak() const noexcept;

  /// Requires `0 <= t <= duration()`.
  [[nodiscard]] ProfilePoint at(double t) const noexcept;

 private:
  double from_;
  double way_;
  double duration_;
};

}  // namespace armjig::motion
