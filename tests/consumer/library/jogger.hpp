// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <armjig/harness/wire/parol6/joints.hpp>

/// The program under test; yours looks different. It turns J1 by an angle.
class Jogger {
 public:
  explicit Jogger(armjig::Degrees distance) : distance_{distance} {}

  /// What to send now, 10 ms after the last frame, given what the board answered to that one.
  armjig::parol6::CommandFrame next(const std::optional<armjig::parol6::TelemetryFrame>& seen) {
    using enum armjig::parol6::Command;
    if (!seen) return {.command = kIdle};
    const auto angle = kJ1.angle(seen->position[0]);
    if (!begin_) {
      begin_ = angle;
      return {.command = kEnable};
    }
    if (angle - *begin_ >= distance_) return {.command = kIdle};
    return {.speed = {kJ1.speed(armjig::DegreesPerSecond{10})}, .command = kJog};
  }

 private:
  static constexpr auto kJ1 = armjig::parol6::kJoints[0];

  armjig::Degrees distance_;
  std::optional<armjig::Degrees> begin_;
};
