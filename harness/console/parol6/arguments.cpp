// SPDX-License-Identifier: Apache-2.0
#include "harness/console/parol6/arguments.hpp"

#include <fmt/core.h>

#include <cmath>

#include "harness/motion/parol6/cartesian_jog.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/wire/parol6/joints.hpp"

namespace armjig::parol6::console {

using namespace planning;

namespace {

constexpr double kMostSpeed = kMaxStepRate.value;

auto unknown_unit(std::string_view text, std::string_view units) {
  return tl::unexpected{fmt::format("'{}' has an unknown unit: write {}", text, units)};
}

}  // namespace

Parsed<std::size_t> parse_joint(std::string_view text) {
  const bool is_joint = text.size() == 2 && (text[0] == 'j' || text[0] == 'J') && text[1] >= '1' &&
                        text[1] < static_cast<char>('1' + kJointCount);
  if (is_joint) return static_cast<std::size_t>(text[1] - '1');
  return tl::unexpected{fmt::format("'{}' is no joint: they are j1 to j6", text)};
}

Parsed<StepsPerSecond> parse_speed(std::size_t joint, std::string_view text) {
  const auto number = parse_number(text);
  if (!number) return tl::unexpected{number.error()};
  const auto& [value, unit] = *number;
  const bool is_degrees = unit == "deg" || unit == "deg/s";
  if (!is_degrees && !unit.empty() && unit != "steps" && unit != "steps/s") {
    return unknown_unit(text, "steps/s or deg/s");
  }
  const auto one_step = kJoints[joint].speed(StepsPerSecond{1}).value;
  const auto steps = is_degrees ? value / one_step : value;
  if (std::abs(steps) > kMostSpeed) {
    return tl::unexpected{
        fmt::format("'{}' is too fast: the board's limit for j{} is {:.0f} "
                    "steps/s or {:.1f} deg/s",
                    text, joint + 1, kMostSpeed, kMostSpeed * one_step)};
  }
  const auto speed = StepsPerSecond{static_cast<std::int32_t>(std::lround(steps))};
  if (speed.value == 0) return tl::unexpected{fmt::format("'{}' is no motion", text)};
  return speed;
}

Parsed<arm::Twist> parse_tool_speed(std::string_view axis, std::string_view text) {
  const bool turns = axis.starts_with('r');
  const auto letter = axis.substr(turns ? 1 : 0);
  if (letter.size() != 1 || letter[0] < 'x' || letter[0] > 'z') {
    return tl::unexpected{fmt::format("'{}' is no axis: they are x y z rx ry rz", axis)};
  }
  const auto number = parse_number(text);
  if (!number) return tl::unexpected{number.error()};
  const auto& [value, unit] = *number;
  const std::string_view name = turns ? "deg" : "mm";
  if (!unit.empty() && unit != name && unit != fmt::format("{}/s", name)) {
    return unknown_unit(text, turns ? "deg/s" : "mm/s");
  }
  const double most = turns ? kFastestToolTurn : 1000 * kFastestToolJog;
  if (value == 0) return tl::unexpected{fmt::format("'{}' is no motion", text)};
  if (std::abs(value) > most) {
    return tl::unexpected{fmt::format("'{}' is too fast: at most {:g} {}/s", text, most, name)};
  }
  const double speed = turns ? to_radians(value) : value / 1000;
  const arm::Vector3 along{letter == "x" ? speed : 0, letter == "y" ? speed : 0,
                           letter == "z" ? speed : 0};
  return turns ? arm::Twist{{}, along} : arm::Twist{along, {}};
}

Parsed<Steps> parse_position(std::size_t joint, std::string_view text) {
  const auto number = parse_number(text);
  if (!number) return tl::unexpected{number.error()};
  const auto& [value, unit] = *number;
  if (!unit.empty() && unit != "steps" && unit != "deg") {
    return unknown_unit(text, "steps or deg");
  }
  const auto one_step = kJoints[joint].angle(Steps{1}).value;
  const auto steps = unit == "deg" ? value / one_step : value;
  if (std::abs(steps) <= kMostSteps) return Steps{static_cast<std::int32_t>(std::lround(steps))};
  return tl::unexpected{fmt::format("'{}' is farther than a frame can say", text)};
}

}  // namespace armjig::parol6::console
