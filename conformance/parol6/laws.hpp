// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdlib>

#include "harness/core/time.hpp"
#include "harness/wire/parol6/frame.hpp"

/// What the board computes, as docs/spec/parol6.md has it: the judge's own copy, which the emulated
/// board never sees. tests/unit/conformance/parol6/laws_test.cpp compares the two.
namespace armjig::parol6::conformance {

/// Following a go-to: the mean of the commanded speed and of 100 times the distance, toward zero.
[[nodiscard]] constexpr int go_to_speed(int commanded, int distance) noexcept {
  return (commanded + 100 * distance) / 2;
}

/// Seconds from step to step at a set speed: whole microseconds.
[[nodiscard]] inline double step_interval(int speed) noexcept {
  return std::floor(1e6 / std::abs(speed)) * 1e-6;
}

/// Steps/s after so many steps of a ramp from rest: the square of the speed is twice the
/// acceleration times the way.
[[nodiscard]] inline double ramp_speed(double acceleration, int way) noexcept {
  return std::sqrt(2 * acceleration * way);
}

/// What the timing field counts in a time, before it wraps.
[[nodiscard]] constexpr double ticks_in(Duration time) noexcept {
  return std::chrono::duration<double>(time).count() * kTicksPerSecond;
}

/// How a joint homes. Positions count from its switch.
struct HomingFigures {
  int seek{};  ///< steps/s, as are `back_off` and `slow_seek`
  int back_off{};
  int back_off_to{};
  int slow_seek{};
  int acceleration{};  ///< of the final move, steps/s^2
  int end{};           ///< of the final move

  friend bool operator==(const HomingFigures&, const HomingFigures&) = default;
};
inline constexpr std::array<HomingFigures, kJointCount> kHoming{{
    {-2050, -2050, 850, -750, 4500, 13'500},
    {-2550, 2050, 1050, -750, 3000, 19'588},
    {-2550, 2050, 1050, -750, 5000, 23'020},
    {5550, -4050, -1550, 4050, 5500, -10'200},
    {-5050, 4050, 1550, -4050, 5500, 8900},
    {-9550, 4050, 1550, -8050, 5500, 0},
}};

/// J6 makes room for J5 before its final move.
inline constexpr int kParkingJ6 = 15'900;
inline constexpr int kParkingAccelerationJ6 = 10'500;

/// The first leg of the demonstration, and its highest speeds, which are its accelerations too.
inline constexpr std::array<int, kJointCount> kDemoOut{6179, -22'222, 49'812, 0, 4059, 46'075};
inline constexpr std::array<int, kJointCount> kDemoSpeeds{6000, 4000, 3500, 3500, 3500, 7500};

}  // namespace armjig::parol6::conformance
