// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "emulators/parol6/plant.hpp"
#include "emulators/parol6/stepper.hpp"

namespace armjig::parol6::emulation {

/// What the firmware did with a joint in a pass. As long as the firmware's own state stays the
/// same, every later pass does the same again, which is what makes coasting over passes exact.
enum class Motion : std::uint8_t {
  kNone,
  kSpeed,       ///< constant speed
  kSeek,        ///< constant speed until the switch reads pressed
  kToPosition,  ///< constant speed until the target
  kRamp,        ///< accelerated until the target
  kGoTo,        ///< the go-to law toward the commanded position
  kSeveral,     ///< more than one of these in one pass: nothing can be foretold
};

/// A step generator and the axis that it turns.
struct Joint {
  Stepper stepper;
  Axis axis;
  Level pressed_level{};  ///< what the firmware takes for "switch hit"
  Motion motion{};
  Steps goal{};           ///< of `kGoTo`
  StepsPerSecond feed{};  ///< of `kGoTo`

  [[nodiscard]] bool is_switch_pressed() const noexcept {
    return axis.switch_level() == pressed_level;
  }
  [[nodiscard]] Steps position() const noexcept { return stepper.position(); }

  void run_speed(Micros now) noexcept;
  void seek(Micros now) noexcept;
  void run_to_position(Micros now) noexcept;
  void run(Micros now) noexcept;
  void go_to(Micros now, Steps goal, StepsPerSecond feed) noexcept;

  /// Repeats `motion` in each pass of the span. Stops in front of the first pass that the firmware
  /// would notice (a switch that reads pressed, an arrival) and answers that pass; `kNoPass` if it
  /// went through the whole span.
  std::int64_t coast(const PassSpan& span) noexcept;

  friend bool operator==(const Joint&, const Joint&) = default;

 private:
  void note(Motion done) noexcept { motion = motion == Motion::kNone ? done : Motion::kSeveral; }
};

}  // namespace armjig::parol6::emulation
