// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/activity.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "emulators/parol6/arm.hpp"
#include "harness/drive/parol6/drive_loop.hpp"
#include "harness/link/memory_stream.hpp"

namespace armjig::parol6::drive {
namespace {

using namespace emulation;
using namespace std::chrono_literals;
using Ending = Activity::Ending;
using ::testing::HasSubstr;

/// A drive and an emulated arm on virtual time, telemetry already there.
class ActivityJig {
 public:
  ActivityJig() { run(20ms); }

  void run(Duration duration) {
    const auto end = port.now() + duration;
    while (port.now() < end) (void)loop.cycle();
    (void)drive.take_events();
  }

  /// How it ends; none if it does not within `longest`.
  std::optional<Ending> ending(Activity& activity, Duration longest = 2min) {
    const auto end = port.now() + longest;
    while (port.now() < end) {
      if (!loop.cycle()) return std::nullopt;
      news += activity.take_news();
      if (auto ending = activity.step(drive, port.now(), drive.take_events())) return ending;
    }
    return std::nullopt;
  }
  std::optional<Ending> ending(Result<std::unique_ptr<Activity>> begun) {
    if (!begun) return std::nullopt;
    return ending(**begun);
  }
  std::optional<Ending> ending(std::unique_ptr<Activity> activity) { return ending(*activity); }

  void touch(auto change) { port.device().touch(port.now(), std::move(change)); }
  void press_estop() {
    touch([](Plant& plant) { plant.inputs.estop = Level::kLow; });
  }
  /// Whether no joint moves in the next half second.
  bool stands() {
    run(20ms);
    const auto before = drive.telemetry()->position;
    run(500ms);
    return drive.telemetry()->position == before;
  }

  MemoryStream<Arm> port{Arm{}};
  Drive drive;
  DriveLoop loop{port, drive};
  std::string news;
};

void expect(const std::optional<Ending>& ending, bool is_success, const std::string& words) {
  ASSERT_TRUE(ending) << "it did not end";
  EXPECT_EQ(ending->is_success, is_success) << ending->text;
  EXPECT_THAT(ending->text, HasSubstr(words));
}

constexpr JointSpeeds kGentle{StepsPerSecond{1500}, StepsPerSecond{3000}, StepsPerSecond{3600},
                              StepsPerSecond{5500}, StepsPerSecond{5500}, StepsPerSecond{5500}};

TEST(Activity, CommandsEndWithTheirEcho) {
  ActivityJig jig;
  expect(jig.ending(begin_command(jig.drive, Command::kDisable)), true, "disabled");
  expect(jig.ending(begin_command(jig.drive, Command::kEnable)), true, "enabled");
  expect(jig.ending(begin_command(jig.drive, Command::kClearError)), true, "cleared");
}

TEST(Activity, HomingEndsHomedAndNamesTheJointsOnItsWay) {
  ActivityJig jig;
  expect(jig.ending(begin_home(jig.drive)), true, "homed in 3");
  EXPECT_THAT(jig.news, HasSubstr("j1 j2 j3"));
  EXPECT_TRUE(jig.stands());
}

TEST(Activity, HomingThatIsStuckIsGivenUpAndTheBoardDisabled) {
  ActivityJig jig;
  jig.touch([](Plant& plant) {
    plant.axes[3].is_jammed = true;  // its switch never closes, so the joint is sought for ever
    plant.axes[3].switch_state = Axis::SwitchState::kStuckOpen;
  });
  expect(jig.ending(begin_home(jig.drive)), false, "longer than 60 s");
  EXPECT_TRUE(jig.stands());
}

TEST(Activity, HomingOfADisabledBoardFails) {
  ActivityJig jig;
  jig.drive.disable();
  jig.run(100ms);
  expect(jig.ending(begin_home(jig.drive)), false, "homing does not go on");
}

TEST(Activity, AJogGoesOnAfterItsSuccessAndStopEndsIt) {
  ActivityJig jig;
  auto jog = begin_jog(jig.drive, 1, StepsPerSecond{-700});
  ASSERT_TRUE(jog);
  expect(jig.ending(**jog), true, "j2 moves");
  EXPECT_TRUE((*jog)->leaves_it_moving());
  EXPECT_FALSE(jig.stands());
  expect(jig.ending(begin_stop(jig.drive)), true, "stopped");
  EXPECT_TRUE(jig.stands());
}

TEST(Activity, ATimedJogMakesItsSteps) {
  ActivityJig jig;
  expect(jig.ending(begin_jog_for(jig.drive, 0, StepsPerSecond{500}, 1500ms)), true, "+750 steps");
  EXPECT_TRUE(jig.stands());
}

TEST(Activity, AJogOfADisabledBoardFailsAndIsNotTriedOn) {
  ActivityJig jig;
  jig.drive.disable();
  jig.run(100ms);
  expect(jig.ending(begin_jog(jig.drive, 0, StepsPerSecond{100})), false, "j1 does not move");
  expect(jig.ending(begin_jog_for(jig.drive, 0, StepsPerSecond{100}, 1s)), false, "does not move");
  expect(jig.ending(begin_command(jig.drive, Command::kEnable)), true, "enabled");
  EXPECT_TRUE(jig.stands()) << "enabling is not moving";
}

TEST(Activity, GoToArrivesWithAllJoints) {
  ActivityJig jig;
  auto goal = jig.drive.telemetry()->position;
  goal[0] = goal[0] + Steps{-1234};
  goal[5] = goal[5] + Steps{777};
  expect(jig.ending(begin_go_to(jig.drive, goal, kGentle)), true, "arrived");
  EXPECT_EQ(jig.drive.telemetry()->position, goal);
  EXPECT_TRUE(jig.stands());
}

TEST(Activity, GoToOfADisabledBoardFails) {
  ActivityJig jig;
  jig.drive.disable();
  jig.run(100ms);
  JointSteps goal{};
  goal[2] = Steps{500};
  expect(jig.ending(begin_go_to(jig.drive, goal, kGentle)), false, "j3 does not move");
}

TEST(Activity, StopEndsAHomingByDisabling) {
  ActivityJig jig;
  auto home = begin_home(jig.drive);
  ASSERT_TRUE(home);
  EXPECT_FALSE(jig.ending(**home, 3s));
  expect(jig.ending(begin_stop(jig.drive)), true, "disabled");
  EXPECT_TRUE(jig.stands());
}

TEST(Activity, StopEndsAHomingThatSomebodyElseBegan) {
  ActivityJig jig;
  ASSERT_TRUE(jig.drive.home());
  jig.run(1s);
  Drive other;  // knows nothing of it, and idle frames let it go on
  DriveLoop loop{jig.port, other};
  const auto stop = begin_stop(other);
  std::optional<Ending> ending;
  for (int i = 0; i < 300 && !ending; ++i) {
    ASSERT_TRUE(loop.cycle());
    ending = stop->step(other, jig.port.now(), other.take_events());
  }
  expect(ending, true, "had to be disabled");
}

TEST(Activity, TheEmergencyStopEndsWhateverGoesOn) {
  for (const bool homes : {false, true}) {
    ActivityJig jig;
    auto begun =
        homes ? begin_home(jig.drive) : begin_jog_for(jig.drive, 0, StepsPerSecond{500}, 1min);
    ASSERT_TRUE(begun);
    EXPECT_FALSE(jig.ending(**begun, 2s));
    jig.press_estop();
    expect(jig.ending(**begun), false, "emergency stop");
    EXPECT_TRUE(jig.stands());
    EXPECT_FALSE(begin_home(jig.drive)) << "latched";
  }
}

TEST(Activity, SilenceOfTheBoardEndsWhatGoesOn) {
  Drive drive;
  (void)drive.tick(at(0ms));
  drive.receive(at(1ms), encode(TelemetryFrame{.io = io_flag::kEstopReleased}));
  auto jog = begin_jog_for(drive, 0, StepsPerSecond{500}, 1min);
  ASSERT_TRUE(jog);
  std::optional<Ending> ending;
  for (int tick = 1; tick < 100 && !ending; ++tick) {
    (void)drive.tick(at(tick * 10ms));
    ending = (*jog)->step(drive, at(tick * 10ms), drive.take_events());
  }
  expect(ending, false, "");
}

TEST(Activity, OutputsAreSeenInTelemetry) {
  ActivityJig jig;
  expect(jig.ending(begin_outputs(jig.drive, io_flag::kOut2)), true, "out1 is off, out2 is on");
  expect(jig.ending(begin_outputs(jig.drive, 0)), true, "out1 is off, out2 is off");
}

constexpr GripperSetPoint kHalfClosed{
    .position = 100, .speed = 60, .current = Milliamperes{500}, .command = 0xD0};

TEST(Activity, TheGripperMovesOnceItIsCalibrated) {
  ActivityJig jig;
  expect(jig.ending(begin_gripper_move(jig.drive, kHalfClosed)), false, "not calibrated");
  expect(jig.ending(begin_gripper_calibration(jig.drive)), true, "calibrated");
  expect(jig.ending(begin_gripper_move(jig.drive, kHalfClosed)), true, "the gripper is at");
  expect(jig.ending(begin_gripper_clear(jig.drive)), true, "no error");
}

TEST(Activity, TheGripperSaysThatItMetSomething) {
  ActivityJig jig;
  expect(jig.ending(begin_gripper_calibration(jig.drive)), true, "calibrated");
  auto open = kHalfClosed;
  open.position = 0;
  expect(jig.ending(begin_gripper_move(jig.drive, open)), true, "is at 0");
  jig.port.device().touch_gripper(jig.port.now(), GripperPlant{.stop_closing = 50});
  expect(jig.ending(begin_gripper_move(jig.drive, kHalfClosed)), true, "met something");
}

TEST(Activity, WithoutAGripperCalibrationFails) {
  MemoryStream<Arm> port{Arm{ArmOptions{.gripper = std::nullopt}}};
  Drive drive;
  DriveLoop loop{port, drive};
  const auto calibration = begin_gripper_calibration(drive);
  std::optional<Ending> ending;
  for (int i = 0; i < 1000 && !ending; ++i) {
    ASSERT_TRUE(loop.cycle());
    ending = calibration->step(drive, port.now(), drive.take_events());
  }
  expect(ending, false, "is a gripper connected");
}

TEST(Activity, WaitingTakesItsTime) {
  ActivityJig jig;
  const auto start = jig.port.now();
  expect(jig.ending(begin_wait(1500ms)), true, "1.5 s");
  EXPECT_EQ(jig.port.now() - start, 1500ms);
}

}  // namespace
}  // namespace armjig::parol6::drive
