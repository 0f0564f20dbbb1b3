// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "emulators/parol6/homing.hpp"
#include "harness/core/quantity.hpp"
#include "harness/wire/parol6/joints.hpp"

namespace armjig::parol6::emulation {

/// The built-in two-leg demonstration of one joint (docs/spec/parol6.md, "Demonstration").
struct DemoParameters {
  float max_speed_and_acceleration{};  ///< steps/s and steps/s^2
  Steps out{};
  Steps back{};

  friend bool operator==(const DemoParameters&, const DemoParameters&) = default;
};

/// The numbers that a board is built with; the defaults are those of the shipped one.
struct BoardFigures {
  HomingTable homing = kHomingTable;
  StepRate max_speed = to_rate(kMaxStepRate);  ///< of every joint at power-up (parol6.jog.clamp)
  std::array<DemoParameters, kJointCount> demo{{{6000, Steps{6179}, kStandby[0]},
                                                {4000, Steps{-22222}, kStandby[1]},
                                                {3500, Steps{49812}, kStandby[2]},
                                                {3500, Steps{0}, kStandby[3]},
                                                {3500, Steps{4059}, kStandby[4]},
                                                {7500, Steps{46075}, kStandby[5]}}};

  friend bool operator==(const BoardFigures&, const BoardFigures&) = default;
};

}  // namespace armjig::parol6::emulation
