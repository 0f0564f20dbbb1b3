// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>
#include <vector>

#include "emulators/morap/node.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::morap::emulation {

/// A node that gets its controller, is calibrated where it stands, and told to go somewhere.
struct StepTest {
  NodeSetup node;                                       ///< with a plant
  std::variant<TuneRequest, ControllerSet> controller;  ///< tuned by the node, or programmed
  float reference{};                                    ///< rad, or rad/s for a speed controller
  Duration length = std::chrono::seconds{2};
  Duration sampling = std::chrono::milliseconds{1};
};

struct StepSample {
  Duration time{};  ///< since the reference was written
  double value{};   ///< rad or rad/s at the output shaft, as it is and not as the node sees it
  double volts{};   ///< applied
  double amperes{};
};

/// The answer of the shaft. Figures refer to the step: 1 is all of it.
struct StepResponse {
  bool is_accepted = false;  ///< false: the node refused the controller, there is nothing else
  ControllerSet controller;  ///< that was active
  std::vector<StepSample> samples;
  double final_value{};  ///< mean of the last tenth
  double overshoot{};    ///< share of the step beyond the reference; 0 if there is none
  Duration settling{};   ///< after which it stays within 2 % of the reference; `length` if never
  double peak_volts{};
};

/// What part of the step an answer may be off and count as settled.
inline constexpr double kSettlingBand = 0.02;

/// Requires a plant, a positive sampling, a reference other than 0 and, in a set, the kind of a
/// position or speed controller.
[[nodiscard]] StepResponse run(const StepTest& test);

}  // namespace armjig::morap::emulation
