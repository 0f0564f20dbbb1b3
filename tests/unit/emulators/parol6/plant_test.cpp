// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/plant.hpp"

#include <gtest/gtest.h>

#include <array>

#include "emulators/parol6/homing.hpp"

namespace armjig::parol6::emulation {
namespace {

using Side = LimitSwitch::Side;
using SwitchState = Axis::SwitchState;

Axis axis(std::int32_t position, std::int32_t threshold, Side side, Level closed_level) {
  return {.position = Steps{position},
          .limit = {.threshold = Steps{threshold}, .side = side, .closed_level = closed_level},
          .switch_state = SwitchState::kWorking,
          .is_jammed = false};
}

TEST(LimitSwitch, IsClosedAtItsThresholdAndBeyond) {
  EXPECT_EQ(axis(11, 10, Side::kAtOrBelow, Level::kLow).switch_level(), Level::kHigh);
  EXPECT_EQ(axis(10, 10, Side::kAtOrBelow, Level::kLow).switch_level(), Level::kLow);
  EXPECT_EQ(axis(9, 10, Side::kAtOrBelow, Level::kLow).switch_level(), Level::kLow);
  EXPECT_EQ(axis(9, 10, Side::kAtOrAbove, Level::kHigh).switch_level(), Level::kLow);
  EXPECT_EQ(axis(10, 10, Side::kAtOrAbove, Level::kHigh).switch_level(), Level::kHigh);
}

TEST(LimitSwitch, CanBeStuckEitherWay) {
  auto stuck = axis(100, 10, Side::kAtOrBelow, Level::kLow);
  stuck.switch_state = SwitchState::kStuckClosed;
  EXPECT_EQ(stuck.switch_level(), Level::kLow);
  stuck.position = Steps{0};
  stuck.switch_state = SwitchState::kStuckOpen;
  EXPECT_EQ(stuck.switch_level(), Level::kHigh);
}

TEST(LimitSwitch, IsForetoldToTheStep) {
  for (const auto side : {Side::kAtOrBelow, Side::kAtOrAbove}) {
    for (const auto level : {Level::kLow, Level::kHigh}) {
      for (std::int32_t start = -5; start <= 5; ++start) {
        for (const std::int32_t direction : {-1, 1}) {
          const auto told = axis(start, 0, side, Level::kLow).steps_until(level, direction);
          auto moving = axis(start, 0, side, Level::kLow);
          std::uint32_t steps = 0;
          for (; steps < 20 && moving.switch_level() != level; ++steps) moving.pulse(direction);
          EXPECT_EQ(told, steps == 20 ? Axis::kNever : steps);
        }
      }
    }
  }
}

TEST(LimitSwitch, NeverChangesOnAJammedAxisOrWhenStuck) {
  auto jammed = axis(1, 0, Side::kAtOrBelow, Level::kLow);
  jammed.is_jammed = true;
  EXPECT_EQ(jammed.steps_until(Level::kLow, -1), Axis::kNever);
  EXPECT_EQ(jammed.steps_until(Level::kHigh, -1), 0U);
  auto stuck = axis(1, 0, Side::kAtOrBelow, Level::kLow);
  stuck.switch_state = SwitchState::kStuckOpen;
  EXPECT_EQ(stuck.steps_until(Level::kLow, -1), Axis::kNever);
}

TEST(Axis, FollowsItsPulsesUnlessJammed) {
  auto moving = axis(100, 0, Side::kAtOrBelow, Level::kLow);
  moving.pulse(-30);
  EXPECT_EQ(moving.position, Steps{70});
  moving.is_jammed = true;
  moving.pulse(-30);
  EXPECT_EQ(moving.position, Steps{70});
}

TEST(Axis, WrapsLikeACounterAfterTwoThousandMillionSteps) {
  auto moving = axis(INT32_MAX, 0, Side::kAtOrBelow, Level::kLow);
  moving.pulse(1);
  EXPECT_EQ(moving.position, Steps{INT32_MIN});
}

TEST(StandardPlant, HasItsSwitchesWhereTheReferenceHasThem) {  // section 6.5
  constexpr std::array<std::int32_t, kJointCount> kThresholds{-3260, -51588, 34885,
                                                              10200, -8900,  32000};
  const auto plant = standard_plant();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(plant.axes[j].limit.threshold, Steps{kThresholds[j]}) << "J" << j + 1;
    EXPECT_EQ(plant.axes[j].limit.side, j == 3 ? Side::kAtOrAbove : Side::kAtOrBelow);
    EXPECT_EQ(plant.axes[j].limit.closed_level, kHomingTable[j].pressed_level);
    EXPECT_NE(plant.axes[j].switch_level(), kHomingTable[j].pressed_level);
  }
  EXPECT_EQ(plant.inputs.estop, Level::kHigh);
}

}  // namespace
}  // namespace armjig::parol6::emulation
