// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "emulators/parol6/arm.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/drive/parol6/drive_loop.hpp"
#include "harness/link/memory_stream.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::parol6::drive {
namespace {

using namespace emulation;
using namespace std::chrono_literals;
using Kind = DriveEvent::Kind;

/// A drive and an emulated arm on virtual time.
class DriveJig {
 public:
  void run(Duration duration) {
    const auto end = port.now() + duration;
    while (port.now() < end) {
      ASSERT_TRUE(loop.cycle());
      for (auto& event : drive.take_events()) events.push_back(event);
    }
  }
  bool saw(Kind kind) const {
    return std::ranges::any_of(events, [&](const DriveEvent& e) { return e.kind == kind; });
  }
  void press_estop(Level level) {
    port.device().touch(port.now(), [&](Plant& plant) { plant.inputs.estop = level; });
  }
  JointSteps positions() const { return drive.telemetry()->position; }

  MemoryStream<Arm> port{Arm{}};
  Drive drive;
  DriveLoop loop{port, drive};
  std::vector<DriveEvent> events;
};

JointSpeeds all_joints(std::int32_t speed) {
  JointSpeeds speeds;
  speeds.fill(StepsPerSecond{speed});
  return speeds;
}

/// Targets a little way from where the joints are.
JointSteps away_from(JointSteps positions) {
  for (auto& position : positions) position = position + Steps{2000};
  return positions;
}

TEST(Drive, AMinuteAtOneHundredHertzLosesNothing) {
  DriveJig jig;
  jig.run(60s);
  ASSERT_TRUE(jig.loop.receive_until(jig.port.now() + 10ms));
  const auto& statistics = jig.drive.statistics();
  EXPECT_EQ(statistics.sent, 6001U) << "deadlines at 0 s and at 60 s";
  EXPECT_EQ(statistics.answered, 6001U);
  EXPECT_EQ(statistics.lost + statistics.late + statistics.bad + statistics.surplus, 0U);
  EXPECT_EQ(jig.drive.outstanding(), 0U);
  EXPECT_EQ(jig.loop.skipped(), 0U);
}

TEST(Drive, JogTakesEffectAndIdleEndsIt) {
  DriveJig jig;
  ASSERT_TRUE(jig.drive.jog(all_joints(1000)));
  jig.run(1s);
  EXPECT_TRUE(jig.saw(Kind::kTookEffect));
  jig.drive.idle();
  jig.run(20ms);
  const auto stopped = jig.positions();
  jig.run(1s);
  EXPECT_EQ(jig.positions(), stopped);
  EXPECT_FALSE(jig.saw(Kind::kNothingMoved));
  EXPECT_FALSE(jig.saw(Kind::kStillMoves));
}

TEST(Drive, GoToArrives) {
  DriveJig jig;
  jig.run(20ms);
  const auto goal = away_from(jig.positions());
  ASSERT_TRUE(jig.drive.go_to(goal, {}));
  jig.run(2s);
  EXPECT_EQ(jig.positions(), goal);
  EXPECT_TRUE(jig.saw(Kind::kTookEffect));
  EXPECT_FALSE(jig.saw(Kind::kNothingMoved));
}

TEST(Drive, HomesFromOneRequest) {
  DriveJig jig;
  ASSERT_TRUE(jig.drive.home());
  jig.run(40s);
  EXPECT_TRUE(jig.saw(Kind::kHomed));
  EXPECT_FALSE(jig.drive.is_homing());
  EXPECT_EQ(jig.drive.telemetry()->homed, 0xFF);
  EXPECT_FALSE(jig.saw(Kind::kNothingMoved));
}

TEST(Drive, ADisabledBoardThatAcceptsAJogButStandsIsReported) {
  DriveJig jig;
  jig.drive.disable();
  jig.run(100ms);
  ASSERT_TRUE(jig.drive.jog(all_joints(500)));
  jig.run(1s);
  EXPECT_TRUE(jig.saw(Kind::kNothingMoved));
}

TEST(Drive, ADisabledBoardThatAcceptsHomeButStandsIsReported) {
  DriveJig jig;
  jig.drive.disable();
  jig.run(100ms);
  ASSERT_TRUE(jig.drive.home());
  jig.run(5s);
  EXPECT_TRUE(jig.saw(Kind::kNothingMoved));
  EXPECT_FALSE(jig.drive.is_homing());
}

TEST(Drive, AnArmThatMovesAlthoughItWasToldToStandIsReported) {
  // A board that is pushed along by another master: its counters move while we say idle.
  Drive drive;
  TelemetryFrame frame;
  frame.io = io_flag::kEstopReleased;
  frame.echo = Command::kIdle;
  for (int tick = 0; tick < 50; ++tick) {
    const auto now = at(tick * 10ms);
    (void)drive.tick(now);
    frame.position[2] = Steps{tick};
    drive.receive(now + 1ms, encode(frame));
  }
  const auto events = drive.take_events();
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.front().kind, Kind::kStillMoves);
  EXPECT_EQ(events.front().joint, 2U);
}

TEST(Drive, SilenceIsReportedOnceAndSoIsItsEnd) {
  Drive drive;
  (void)drive.tick(at(0ms));
  drive.receive(at(1ms), encode(TelemetryFrame{.io = io_flag::kEstopReleased}));
  for (int tick = 1; tick < 100; ++tick) (void)drive.tick(at(tick * 10ms));
  drive.receive(at(1s), encode(TelemetryFrame{.io = io_flag::kEstopReleased}));
  std::vector<Kind> kinds;
  for (const auto& event : drive.take_events()) kinds.push_back(event.kind);
  EXPECT_THAT(kinds, testing::ElementsAre(Kind::kLinkSilent, Kind::kLinkBack));
}

TEST(Drive, WhatWasUnderWayBeforeASilenceDoesNotGoOnAfterIt) {
  const TelemetryFrame answer{.io = io_flag::kEstopReleased};
  Drive drive;
  (void)drive.tick(at(0ms));
  drive.receive(at(1ms), encode(answer));
  ASSERT_TRUE(drive.jog(all_joints(1000)));
  for (int tick = 1; tick < 100; ++tick) (void)drive.tick(at(tick * 10ms));
  drive.receive(at(1s), encode(answer));
  const auto frame = decode_command(body_of(drive.tick(at(1s + 10ms))));
  EXPECT_EQ(frame.command, Command::kIdle);
  EXPECT_EQ(frame.speed, JointSpeeds{});
}

TEST(Drive, FramesWithoutAnAnswerAreLostAndOnesWithALateAnswerAreLate) {
  Drive drive;
  const TelemetryFrame answer{.io = io_flag::kEstopReleased};
  for (int tick = 0; tick < 100; ++tick) {
    const auto now = at(tick * 10ms);
    (void)drive.tick(now);
    const bool is_lost = tick % 10 == 3;
    const bool was_late = tick % 10 == 6;  // the answer to frame 5 comes now, with this one's
    const bool is_late = tick % 10 == 5;
    if (!is_lost && !is_late) drive.receive(now + 1ms, encode(answer));
    if (was_late) drive.receive(now + 2ms, encode(answer));
  }
  drive.give_up_outstanding();
  EXPECT_EQ(drive.statistics().sent, 100U);
  EXPECT_EQ(drive.statistics().lost, 10U);
  EXPECT_EQ(drive.statistics().late, 10U);
  EXPECT_EQ(drive.statistics().answered, 90U);
}

TEST(Drive, NoRequestMovesAnythingWhileTheStopIsLatched) {
  DriveJig jig;
  jig.run(50ms);
  jig.press_estop(Level::kLow);
  jig.run(50ms);
  EXPECT_TRUE(jig.drive.is_latched());
  EXPECT_FALSE(jig.drive.jog(all_joints(100)));
  EXPECT_FALSE(jig.drive.go_to({}, {}));
  EXPECT_FALSE(jig.drive.home());
  EXPECT_FALSE(jig.drive.enable()) << "the stop is still pressed";
  jig.press_estop(Level::kHigh);
  jig.run(50ms);
  EXPECT_TRUE(jig.drive.is_latched()) << "releasing it is not enough";
  EXPECT_TRUE(jig.drive.enable());
}

/// What an arm may be doing when the stop is pressed.
enum class Doing { kJog, kGoTo, kHome };

void begin(Doing activity, DriveJig& jig) {
  switch (activity) {
    case Doing::kJog:
      ASSERT_TRUE(jig.drive.jog(all_joints(-1500)));
      break;
    case Doing::kGoTo:
      ASSERT_TRUE(jig.drive.go_to(away_from(jig.positions()), all_joints(300)));
      break;
    case Doing::kHome:
      ASSERT_TRUE(jig.drive.home());
      break;
  }
}

TEST(Drive, EmergencyStopAtTwoHundredRandomMomentsLatchesAndNothingMovesAfterEnable) {
  test::Dice dice{3};
  constexpr Duration kToShow = 40ms;  // a frame to tell us, a frame to tell the board, one to see
  for (int moment = 0; moment < 200; ++moment) {
    SCOPED_TRACE(moment);
    DriveJig jig;
    jig.run(20ms);
    const auto activity = static_cast<Doing>(moment % 3);
    begin(activity, jig);
    const auto longest = activity == Doing::kHome ? 30'000 : 1'500;
    jig.run(std::chrono::microseconds{dice.between(0, longest * 1000)});
    jig.press_estop(Level::kLow);
    jig.run(kToShow);
    EXPECT_TRUE(jig.drive.is_latched());
    const auto stopped = jig.positions();
    jig.run(200ms);
    EXPECT_EQ(jig.positions(), stopped) << "moves while latched";
    jig.press_estop(Level::kHigh);
    jig.run(kToShow);
    ASSERT_TRUE(jig.drive.enable());
    jig.run(500ms);
    EXPECT_EQ(jig.positions(), stopped) << "moves after enable without a command";
    EXPECT_FALSE(jig.saw(Kind::kStillMoves));
    ASSERT_TRUE(jig.drive.jog(all_joints(1000)));
    jig.run(300ms);
    EXPECT_NE(jig.positions(), stopped) << "does not obey after enable";
  }
}

}  // namespace
}  // namespace armjig::parol6::drive
