// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace armjig {

/// A number that knows its unit. Same units add and compare; nothing converts by itself. `Unit` is
/// an empty tag with a `symbol`, so that a quantity can also be printed.
template <class Unit, class Rep>
struct Quantity {
  using rep = Rep;
  using unit = Unit;

  Rep value{};

  constexpr Quantity() noexcept = default;
  constexpr explicit Quantity(Rep v) noexcept : value{v} {}

  friend constexpr auto operator<=>(const Quantity&, const Quantity&) noexcept = default;
  friend constexpr Quantity operator+(Quantity a, Quantity b) noexcept {
    return Quantity{static_cast<Rep>(a.value + b.value)};
  }
  friend constexpr Quantity operator-(Quantity a, Quantity b) noexcept {
    return Quantity{static_cast<Rep>(a.value - b.value)};
  }
  friend constexpr Quantity operator-(Quantity a) noexcept {
    return Quantity{static_cast<Rep>(-a.value)};
  }
};

namespace unit {
struct Steps {
  static constexpr auto symbol = "steps";
};
struct StepsPerSecond {
  static constexpr auto symbol = "steps/s";
};
struct StepsPerSecond2 {
  static constexpr auto symbol = "steps/s^2";
};
struct Ticks {
  static constexpr auto symbol = "ticks";
};
struct Degrees {
  static constexpr auto symbol = "deg";
};
struct Radians {
  static constexpr auto symbol = "rad";
};
struct RadiansPerSecond {
  static constexpr auto symbol = "rad/s";
};
struct Volts {
  static constexpr auto symbol = "V";
};
struct Amperes {
  static constexpr auto symbol = "A";
};
struct NewtonMetres {
  static constexpr auto symbol = "N m";
};
struct Millimetres {
  static constexpr auto symbol = "mm";
};
struct MillimetresPerSecond {
  static constexpr auto symbol = "mm/s";
};
struct Milliamperes {
  static constexpr auto symbol = "mA";
};
struct Percent {
  static constexpr auto symbol = "%";
};
}  // namespace unit

using Steps = Quantity<unit::Steps, std::int32_t>;
using StepsPerSecond = Quantity<unit::StepsPerSecond, std::int32_t>;
/// The same unit in the single precision that step generators compute with.
using StepRate = Quantity<unit::StepsPerSecond, float>;
using StepsPerSecond2 = Quantity<unit::StepsPerSecond2, float>;
using Ticks = Quantity<unit::Ticks, std::uint32_t>;
using Degrees = Quantity<unit::Degrees, double>;
using Radians = Quantity<unit::Radians, double>;
using Millimetres = Quantity<unit::Millimetres, double>;
using MillimetresPerSecond = Quantity<unit::MillimetresPerSecond, double>;
using Milliamperes = Quantity<unit::Milliamperes, std::int16_t>;
/// Exact below 2^24.
[[nodiscard]] constexpr StepRate to_rate(StepsPerSecond speed) noexcept {
  return StepRate{static_cast<float>(speed.value)};
}

/// A set-point as a share of what the joint can do, 0 to 100.
using Percent = Quantity<unit::Percent, double>;

}  // namespace armjig
