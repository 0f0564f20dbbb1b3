// SPDX-License-Identifier: Apache-2.0
// The judge and the emulated board have a law, a table and a state machine each: here they meet.
#include "conformance/parol6/laws.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "conformance/parol6/host/conduct.hpp"
#include "emulators/parol6/stepper.hpp"
#include "harness/motion/parol6/tracking.hpp"
#include "harness/wire/parol6/joint_bounds.hpp"
#include "harness/wire/parol6/readings.hpp"
#include "tests/unit/emulators/parol6/desk.hpp"

namespace armjig::parol6::conformance {
namespace {

using emulation::Board;
using emulation::BoardProfile;
using emulation::Desk;
using emulation::Stepper;
using namespace std::chrono_literals;

constexpr std::int64_t kMost = kMostSteps;

TEST(LawsOfJudgeAndBoard, GoToHasOneSpeed) {
  test::Dice dice{1};
  for (int i = 0; i < 200'000; ++i) {
    // Near ones as well, where it is cut off.
    const auto reach = dice.one_in(2) ? kMost : 50;
    const auto number = [&] { return static_cast<std::int32_t>(dice.between(-reach, reach)); };
    const auto [position, goal, feed] = std::array{number(), number(), number()};
    const StepsPerSecond wanted{go_to_speed(feed, goal - position)};
    ASSERT_EQ(emulation::go_to_speed(Steps{position}, Steps{goal}, StepsPerSecond{feed}),
              to_rate(wanted))
        << position << " " << goal << " " << feed;
    ASSERT_EQ(planning::tracking_speed(planning::Tracking::kSpeedAndPosition, Steps{goal},
                                       StepsPerSecond{feed}, Steps{position}),
              wanted);
  }
}

TEST(LawsOfJudgeAndBoard, StepsHaveOneInterval) {
  for (int speed = 1; speed <= kMaxStepRate.value; ++speed) {
    for (const int signed_speed : {speed, -speed}) {
      Stepper stepper;
      stepper.set_max_speed(to_rate(kMaxStepRate));
      stepper.set_speed(to_rate(StepsPerSecond{signed_speed}));
      ASSERT_NEAR(stepper.interval_us(), step_interval(signed_speed) * 1e6, 1e-3) << signed_speed;
    }
  }
}

TEST(LawsOfJudgeAndBoard, RampsHaveOneSpeedAtEachPlace) {
  test::Dice dice{2};
  for (int round = 0; round < 40; ++round) {
    const auto acceleration = static_cast<float>(dice.between(1000, 15'000));
    const auto sign = dice.one_in(2) ? 1 : -1;
    Stepper stepper;
    stepper.set_max_speed(to_rate(kMaxStepRate));
    stepper.set_acceleration(StepsPerSecond2{acceleration});
    stepper.move_to(Steps{sign * 15'000});
    for (std::uint32_t now = 0; std::abs(stepper.position().value) < 5000; now += 10) {
      if (!stepper.run({now})) continue;
      const auto way = std::abs(stepper.position().value);
      if (way <= 200) continue;
      const auto wanted = ramp_speed(static_cast<double>(acceleration), way);
      ASSERT_NEAR(sign * static_cast<double>(stepper.speed().value), wanted, 0.005 * wanted)
          << acceleration << way;
    }
  }
}

TEST(LawsOfJudgeAndBoard, HomingHasOneTable) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& board = emulation::kHomingTable[j];
    const HomingFigures figures{
        static_cast<int>(board.seek_speed.value),
        static_cast<int>(board.back_off_speed.value),
        board.back_off_target.value,
        static_cast<int>(board.slow_seek_speed.value),
        static_cast<int>(board.acceleration.value),
        board.standby_from_switch.value,
    };
    EXPECT_EQ(figures, kHoming[j]) << "J" << j + 1;
    EXPECT_EQ(board.standby, kStandby[j]) << "J" << j + 1;
  }
  EXPECT_EQ(emulation::kParkingJ6, Steps{kParkingJ6});
  EXPECT_EQ(emulation::kParkingAccelerationJ6, StepsPerSecond2{kParkingAccelerationJ6});
}

TEST(LawsOfJudgeAndBoard, TheDemonstrationHasOneTable) {
  const auto& demo = emulation::BoardFigures{}.demo;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(demo[j].out, Steps{kDemoOut[j]}) << "J" << j + 1;
    EXPECT_EQ(demo[j].back, kStandby[j]) << "J" << j + 1;
    EXPECT_EQ(static_cast<int>(demo[j].max_speed_and_acceleration), kDemoSpeeds[j]) << "J" << j + 1;
  }
}

TEST(LawsOfJudgeAndBoard, TimesHaveOneNumberOfTicks) {
  test::Dice dice{3};
  Desk desk{emulation::board_with_pass(10)};
  desk.send(emulation::command(Command::kIdle));
  for (int i = 0; i < 2000; ++i) {
    const auto before = desk.now;
    desk.wait(std::chrono::microseconds{dice.between(20, 1'000'000)});
    const auto timing = desk.send(emulation::command(Command::kIdle)).timing;
    const auto ticks = ticks_in(desk.now - before);
    const auto beyond = static_cast<std::uint16_t>(timing - static_cast<std::int64_t>(ticks) + 8);
    ASSERT_LE(beyond, 16) << timing << " for " << ticks;  // a pass is 7 ticks
  }
}

/// Homed, with a law for bounds.
Desk homed_within_bounds() {
  constexpr emulation::BoardTiming kCoarse{.pass_period = 250us};  // each of its passes is computed
  Desk desk{Board{emulation::standard_plant(), kCoarse, BoardProfile{.stops_at_bounds = true}}};
  desk.hold(emulation::command(Command::kHome), 100ms);
  desk.hold(emulation::command(Command::kIdle), 60s);
  return desk;
}

TEST(LawsOfJudgeAndBoard, ABoundStopsTheSameSpeeds) {
  test::Dice dice{4};
  const auto begin = homed_within_bounds();
  ASSERT_TRUE(are_all_homed(begin.board.homing().homed()));
  int stopped = 0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    for (const std::int32_t outward : {1, -1}) {
      auto desk = begin;
      const auto jog = [&](std::int32_t speed, Duration time) {
        std::array<std::int32_t, kJointCount> speeds{};
        speeds[j] = speed;
        const auto before = emulation::counters(desk.board)[j];
        desk.hold(emulation::command(Command::kJog, speeds), time);
        return std::pair{before, emulation::counters(desk.board)[j]};
      };
      jog(outward * 7000, 10s);
      for (int i = 0; i < 50; ++i) {
        const auto sign = dice.one_in(4) ? -outward : outward;
        const auto speed = sign * static_cast<std::int32_t>(dice.between(20, 300));
        const auto [before, after] = jog(speed, 100ms);
        const bool is_forbidden = kJointBounds[j].forbid(Steps{before}, StepsPerSecond{speed});
        ASSERT_EQ(before == after, is_forbidden) << "J" << j + 1 << " " << speed;
        stopped += is_forbidden ? 1 : 0;
      }
    }
  }
  EXPECT_GT(stopped, 50);
}

TEST(LawsOfJudgeAndBoard, ABoardIsDisabledForBoth) {
  using enum Command;
  constexpr std::array kCodes{kIdle, kHome, kJog, kGoTo, kEnable, kDisable, kClearError, Command{}};
  test::Dice dice{5};
  Desk desk{emulation::board_with_pass(20)};
  programs::Conduct conduct{0ns};
  int refused = 0;
  for (int i = 0; i < 3000; ++i, desk.wait(10ms)) {
    const bool is_enabled = desk.board.is_enabled();
    const auto code = kCodes[static_cast<std::size_t>(dice.between(0, kCodes.size() - 1))];
    bool is_blamed = false;
    const Complain complain{[&](std::string_view id, const std::string&, const auto&) {
                              is_blamed = is_blamed || id == "parol6.host.move-disabled";
                              return true;
                            },
                            [](std::string_view) {}};
    const auto frame = emulation::command(code, {100, -100, 100});
    conduct.command(at(desk.now), frame, complain);
    const auto answer = desk.send(frame);
    conduct.telemetry(at(desk.now), answer);
    if (i == 0) continue;  // before the first answer it knows nothing
    const bool wants_motion = moves(code);
    ASSERT_EQ(is_blamed, wants_motion && !is_enabled) << i;
    refused += is_blamed ? 1 : 0;
  }
  EXPECT_GT(refused, 200);
}

}  // namespace
}  // namespace armjig::parol6::conformance
