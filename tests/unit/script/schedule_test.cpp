// SPDX-License-Identifier: Apache-2.0
#include "harness/script/schedule.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "harness/capture/trace.hpp"
#include "harness/wire/parol6/joints.hpp"
#include "tests/unit/script/programs.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig::script {
namespace {

using parol6::kJoints;
using test::program_of;
using test::schedule_of;
using test::steps;
using ::testing::HasSubstr;

/// A move to places in steps.
std::string move_to(const std::array<int, 6>& places, std::string_view arguments) {
  std::string text = "MoveJoint(";
  for (std::size_t j = 0; j < places.size(); ++j) {
    text += fmt::format("{:.9f}, ", kJoints[j].angle(Steps{places[j]}).value);
  }
  return text + std::string{arguments} + ")\n";
}

/// All that a host sent in a recording, from the first frame that carries `from_command` on.
std::vector<std::vector<std::byte>> sent_in(const std::string& name, parol6::Command from_command) {
  constexpr std::size_t kCommandByte = 40;
  const auto trace = read_trace(source_dir() + "/captures/parol6/" + name);
  if (!trace) {
    ADD_FAILURE() << describe(trace.error());
    return {};
  }
  std::vector<std::vector<std::byte>> frames;
  for (const auto& event : trace->events) {
    if (event.dir != "to_device") continue;
    const auto command = static_cast<parol6::Command>(event.bytes.at(kCommandByte));
    if (!frames.empty() || command == from_command) frames.push_back(event.bytes);
  }
  return frames;
}

void expect_recorded(const Schedule& schedule, const std::string& name,
                     parol6::Command from_command) {
  const auto recorded = sent_in(name, from_command);
  ASSERT_EQ(schedule.frames.size(), recorded.size());
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    ASSERT_TRUE(armjig::test::same_bytes(parol6::encode(schedule.frames[i]), recorded[i]))
        << name << ", frame " << i;
  }
}

/// The boards of these recordings were not homed, so that angles say nothing.
constexpr InterpreterSettings kUnhomed{
    .planner = {.limits = parol6::planning::LimitCheck::kIgnored}};
constexpr std::array kFar{2500, -6000, 7000, -3000, 3500, 12000};

TEST(Schedule, OfATrapezoidWithPositionsIsTheWholeRecording) {
  const auto program = program_of(move_to(kFar, "t=3, trap") + "Delay(0.2)\n" +
                                      move_to({0, 0, 0, 0, 0, 0}, "t=2, trap") + "Delay(0.2)",
                                  Dialect::kDocumented);
  expect_recorded(schedule_of(program, kUnhomed, {}), "planner_trap_speed_pos_a.jsonl",
                  parol6::Command::kGoTo);
}

TEST(Schedule, OfAPolynomialOfSpeedsIsTheWholeRecording) {
  const auto program =
      program_of(move_to(kFar, "t=4, poly, speed") + "Delay(0.2)", Dialect::kDocumented);
  expect_recorded(schedule_of(program, kUnhomed, {}), "planner_quintic_speed_only_a.jsonl",
                  parol6::Command::kJog);
}

TEST(Schedule, OfMovesBehindAHomingIsTheRestOfTheRecording) {
  const auto program = program_of(
      move_to({13000, -41000, 46100, -3700, 2050, 23000}, "t=4, trap, speed") + "Delay(0.2)\n" +
          move_to({10240, -32000, 57905, 0, 0, 32000}, "t=4, poly") + "Delay(0.2)",
      Dialect::kDocumented);
  expect_recorded(schedule_of(program), "planner_home_then_moves_a.jsonl", parol6::Command::kJog);
}

/// What a frame tells one joint.
struct Told {
  int position{};
  int speed{};

  friend bool operator==(const Told&, const Told&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Told& told) {
    return out << '(' << told.position << ", " << told.speed << ')';
  }
};

/// The commander's frames of one line from standby; frame k is set-point k, for frame 0 is the tick
/// in which it plans.
class CommanderMove {
 public:
  explicit CommanderMove(std::string_view line, const parol6::JointSteps& from = test::kStandby)
      : schedule_{schedule_of(program_of(line, Dialect::kCommander), {}, from)} {}

  [[nodiscard]] Told at(std::size_t k, std::size_t joint) const {
    const auto& frame = schedule_.frames.at(k);
    return {frame.position[joint - 1].value, frame.speed[joint - 1].value};
  }
  [[nodiscard]] const Schedule& schedule() const { return schedule_; }

 private:
  Schedule schedule_;
};

// P1 to P9: the reference's vectors of the commander's planner.

TEST(CommanderSchedule, P1PolynomialInATime) {
  const CommanderMove move{"MoveJoint(0,-90,180,0,0,180,t=4)"};
  EXPECT_EQ(move.at(1, 1), (Told{10239, 0}));
  EXPECT_EQ(move.at(2, 1), (Told{10239, -1}));
  EXPECT_EQ(move.at(10, 1), (Told{10238, -45}));
  EXPECT_EQ(move.at(100, 1), (Told{9173, -2715}));
  EXPECT_EQ(move.at(199, 1), (Told{5144, -4811}));
  EXPECT_EQ(move.at(200, 1), (Told{5095, -4811}));
  EXPECT_EQ(move.at(300, 1), (Told{1039, -2679}));
  EXPECT_EQ(move.at(398, 1), (Told{0, 0}));
  EXPECT_EQ(move.at(399, 1), (Told{0, 0}));
  for (std::size_t k = 1; k <= 399; ++k) {
    EXPECT_EQ(move.at(k, 2).position, -31999) << k;
    EXPECT_EQ(move.at(k, 3).position, 57904) << k;
  }
}

// F6 of the reference: set-point 100 of P1 as a whole frame.
TEST(CommanderSchedule, F6AFrameToTheByte) {
  const CommanderMove move{"MoveJoint(0,-90,180,0,0,180,t=4)"};
  const auto expected = armjig::test::hex(
      "FFFFFF34 0023D5 FF8301 00E230 000000 000000 007D00 FFF565 000000 000000 000000 000000 000000"
      "9C FF 00 00 0001 0001 0001 D0 00 00 E4 0102");
  EXPECT_TRUE(armjig::test::same_bytes(parol6::encode(move.schedule().frames.at(100)), expected));
}

TEST(CommanderSchedule, AMoveTakesAFramePerSampleAndTwoMore) {
  const CommanderMove move{"MoveJoint(0,-90,180,0,0,180,t=4)"};
  const auto& frames = move.schedule().frames;
  ASSERT_EQ(frames.size(), 402U);  // N = 400: 401 of the move, one of End()
  EXPECT_EQ(frames[0].command, parol6::Command::kIdle);
  for (std::size_t k = 1; k <= 399; ++k) EXPECT_EQ(frames[k].command, parol6::Command::kGoTo);
  EXPECT_EQ(frames[400].command, parol6::Command::kIdle);
  EXPECT_EQ(frames[401].command, parol6::Command::kIdle);
}

TEST(CommanderSchedule, P2TrapezoidInATimeHasSpeedsInMultiples) {
  const CommanderMove move{"MoveJoint(0,-90,180,0,0,180,t=4,trap)"};
  EXPECT_EQ(move.at(10, 1), (Told{10225, 0}));
  EXPECT_EQ(move.at(100, 1), (Told{8792, -2793}));
  EXPECT_EQ(move.at(133, 1), (Told{7680, -3591}));
  EXPECT_EQ(move.at(200, 1), (Told{5100, -3591}));
  EXPECT_EQ(move.at(266, 1), (Told{2560, -3591}));
  EXPECT_EQ(move.at(300, 1), (Told{1418, -2793}));
  EXPECT_EQ(move.at(399, 1), (Told{0, 0}));
  for (std::size_t k = 1; k <= 399; ++k) EXPECT_EQ(move.at(k, 1).speed % 399, 0) << k;
}

TEST(CommanderSchedule, P3TheDocumentsExample) {
  const auto from = steps({10240, -32000, 57905, 0, 0, 46222});
  const CommanderMove polynomial{"MoveJoint(90,-90,180,0,0,180,t=2)", from};
  EXPECT_EQ(polynomial.at(1, 6), (Told{46221, -5}));
  EXPECT_EQ(polynomial.at(50, 6), (Told{44730, -7588}));
  EXPECT_EQ(polynomial.at(100, 6), (Told{39044, -13399}));
  EXPECT_EQ(polynomial.at(150, 6), (Told{33416, -7385}));
  EXPECT_EQ(polynomial.at(199, 6), (Told{32000, 0}));
  const CommanderMove trapezoid{"MoveJoint(90,-90,180,0,0,180,t=2,trap)", from};
  EXPECT_EQ(trapezoid.at(50, 6), (Told{44201, -7960}));
  for (std::size_t k = 66; k <= 133; ++k) EXPECT_EQ(trapezoid.at(k, 6).speed, -10547) << k;
  EXPECT_EQ(trapezoid.at(100, 6).position, 39057);
  EXPECT_EQ(trapezoid.at(150, 6), (Told{33940, -7761}));
  EXPECT_EQ(trapezoid.at(199, 6), (Told{32000, 0}));
}

TEST(CommanderSchedule, P4SpeedAndAcceleration) {
  const CommanderMove move{"MoveJoint(0,-90,180,0,0,180,v=50,a=50)"};
  EXPECT_EQ(move.schedule().moves.at(0).plan.set_points.size(), 329U);
  EXPECT_EQ(move.at(1, 1), (Told{10239, -167}));
  EXPECT_EQ(move.at(165, 1).speed, -3300);
  EXPECT_EQ(move.at(329, 1), (Told{0, -167}));
}

TEST(CommanderSchedule, P5AllJointsFollowTheLongest) {
  const CommanderMove move{"MoveJoint(0,-60,200,30,0,90,v=50,a=50)"};
  constexpr std::array kPlaces{0, -21333, 64337, 2132, 0, 16001};
  constexpr std::array kCruises{3300, 3437, 2073, 687, 0, 5156};
  for (std::size_t j = 1; j <= 6; ++j) {
    EXPECT_EQ(move.at(329, j).position, kPlaces[j - 1]) << j;
    EXPECT_EQ(std::abs(move.at(165, j).speed), kCruises[j - 1]) << j;
  }
}

TEST(CommanderSchedule, P6AShortWayFallsBackToThirds) {
  const CommanderMove move{"MoveJoint(89,-90,180,0,0,180,v=50,a=50)"};
  EXPECT_EQ(move.schedule().moves.at(0).plan.set_points.size(), 23U);
  EXPECT_EQ(move.at(12, 1).speed, -712);
}

TEST(CommanderSchedule, P7DefaultsOfSpeedAndAcceleration) {
  for (const auto* line :
       {"MoveJoint(0,-90,180,0,0,180)", "MoveJoint(0,-90,180,0,0,180,a=50,v=50)"}) {
    const CommanderMove move{line};
    EXPECT_EQ(move.schedule().moves.at(0).plan.set_points.size(), 376U) << line;
    EXPECT_EQ(move.at(1, 1), (Told{10239, -89})) << line;
    EXPECT_EQ(move.at(188, 1).speed, -2980) << line;
    EXPECT_EQ(move.at(376, 1), (Told{0, -89})) << line;
  }
}

TEST(CommanderSchedule, P9ALineFromStandby) {
  const CommanderMove move{"MoveCart(0.0,263.23,161.241,-90.0,0.0,-89.499)"};
  struct Row {
    std::size_t k{};
    std::array<int, 6> positions{};
    std::array<int, 6> speeds{};
  };
  for (const auto& [k, positions, speeds] :
       {Row{1, {10239, -32003, 57902, 0, 0, 31989}, {}},
        Row{60, {10239, -32033, 57756, 0, 25, 31989}, {0, -196, -946, 0, 172, 0}},
        Row{180, {10239, -32448, 50917, 0, 1472, 31994}, {0, 1054, -7264, 0, 1839, 7}},
        Row{300, {10239, -30302, 46251, 0, 2950, 31999}, {0, 415, -435, 0, 181, 0}},
        Row{359, {10239, -30242, 46189, 0, 2976, 31999}, {}}}) {
    for (std::size_t j = 1; j <= 6; ++j) {
      EXPECT_NEAR(move.at(k, j).position, positions[j - 1], 2) << k << " j" << j;
      EXPECT_NEAR(move.at(k, j).speed, speeds[j - 1], 2 + 0.03 * std::abs(speeds[j - 1]))
          << k << " j" << j;
    }
  }
}

TEST(CommanderSchedule, P10NumbersOfSamples) {
  struct Count {
    std::string_view time;
    std::size_t samples{};
  };
  for (const auto& [time, samples] :
       {Count{"0.29", 28}, Count{"0.57", 56}, Count{"2.3", 229}, Count{"1.1", 110}}) {
    const CommanderMove move{fmt::format("MoveJoint(89,-90,180,0,0,180,t={})", time)};
    EXPECT_EQ(move.schedule().moves.at(0).plan.set_points.size(), samples - 1) << time;
  }
  const CommanderMove line{"MoveCart(0.0,263.23,161.241,-90.0,0.0,-89.499)"};
  EXPECT_EQ(line.schedule().moves.at(0).plan.set_points.size(), 359U);
}

TEST(CommanderSchedule, SpeedOnlyDiffersInTheCommandAlone) {
  const CommanderMove with{"MoveJoint(0,-90,180,0,0,180,t=1)"};
  const CommanderMove without{"MoveJoint(0,-90,180,0,0,180,t=1,speed)"};
  for (std::size_t k = 1; k < 100; ++k) {
    EXPECT_EQ(with.at(k, 1), without.at(k, 1)) << k;
    EXPECT_EQ(without.schedule().frames[k].command, parol6::Command::kJog) << k;
  }
}

TEST(CommanderSchedule, FramesOfTheOtherCommands) {
  const auto frames_of = [](std::string_view line) {
    return schedule_of(program_of(line, Dialect::kCommander)).frames.size() - 1;  // End()
  };
  EXPECT_EQ(frames_of("Delay(0.5)"), 51U);
  EXPECT_EQ(frames_of("Delay(0.29)"), 29U);  // trunc(28.999...) + 1
  EXPECT_EQ(frames_of("Dummy()"), 1U);
  EXPECT_EQ(frames_of("Output(1,HIGH)"), 1U);
  EXPECT_EQ(frames_of("Gripper(1,2,300)"), 1U);
  EXPECT_EQ(frames_of("Gripper(1,2,50)"), 1U);  // skipped
}

TEST(CommanderSchedule, IdleFramesCarryWhereTheArmIs) {
  const auto schedule = schedule_of(program_of("Dummy()", Dialect::kCommander));
  EXPECT_EQ(schedule.frames.at(0).position, test::kStandby);
}

TEST(Schedule, OutputsStayAsTheyWereSwitched) {
  using parol6::io_flag::kOut1;
  using parol6::io_flag::kOut2;
  const auto schedule = schedule_of(program_of(
      "Output(1, HIGH)\nOutput(2, HIGH)\nOutput(1, LOW)\nDelay(0.02)", Dialect::kDocumented));
  std::vector<int> flags;
  for (const auto& frame : schedule.frames) flags.push_back(frame.in_out);
  EXPECT_THAT(flags, ::testing::ElementsAre(kOut1, kOut1 | kOut2, kOut2, kOut2, kOut2));
}

TEST(Schedule, CalibrationLeavesOnce) {
  const auto schedule = schedule_of(
      program_of("Gripper(10, 20, 300)\nGripper_cal()\nDelay(0.02)", Dialect::kDocumented));
  ASSERT_EQ(schedule.frames.size(), 4U);
  EXPECT_EQ(schedule.frames[0].gripper,
            (parol6::GripperSetPoint{
                .position = 10, .speed = 20, .current = Milliamperes{300}, .command = 0xD0}));
  EXPECT_EQ(schedule.frames[1].gripper.mode, 1);
  EXPECT_EQ(schedule.frames[2].gripper.mode, 0);
}

TEST(Schedule, ALoopRunsAsOftenAsItIsTold) {
  auto program = parse("Begin()\nDelay(0.05)\nLoop()\n", Dialect::kDocumented);
  ASSERT_TRUE(program.has_value());
  EXPECT_EQ(schedule_of(*program).frames.size(), 6U);
  EXPECT_EQ(schedule_of(*program, {.passes = 3}).frames.size(), 18U);
}

TEST(Schedule, ALoopWithoutEndIsTooLong) {
  auto program = parse("Begin()\nLoop()\n", Dialect::kDocumented);
  ASSERT_TRUE(program.has_value());
  const auto result = schedule(*program, {.passes = 0}, test::kStandby);
  ASSERT_FALSE(result.has_value());
  EXPECT_THAT(result.error().text, HasSubstr("longer than 10000 s"));
}

TEST(Schedule, WhatCannotBePlannedIsAnErrorAtItsLine) {
  struct Case {
    std::string_view line;
    Dialect dialect{};
    std::string_view text;
  };
  constexpr auto kDocumented = Dialect::kDocumented;
  constexpr auto kCommander = Dialect::kCommander;
  for (const auto& [line, dialect, text] : {
           Case{"MoveJoint(200, -90, 180, 0, 0, 180)", kDocumented, "j1 would be at 200"},
           Case{"MoveJoint(0, -90, 180, 0, 0, 180, t=0.1)", kDocumented, "j1 would need"},
           Case{"MoveJoint(0,-90,180,0,90,180,t=4)", kCommander, "j5 would be at 90.000 deg"},
           Case{"MoveJoint(0,-90,180,0,0,180,v=101,a=5)", kCommander, "not between 0 and 100"},
           Case{"Delay(abc)", kCommander, "'abc' is no number"},
           Case{"Home()", kCommander, "hangs there"},
       }) {
    const auto program = program_of("Delay(1)\n" + std::string{line}, dialect);
    const auto result = schedule(program, {}, test::kStandby);
    ASSERT_FALSE(result.has_value()) << line;
    EXPECT_EQ(result.error().place, (Place{3, 1})) << line;
    EXPECT_THAT(result.error().text, HasSubstr(text)) << line;
  }
}

TEST(Schedule, IsWrittenAsARecordingThatReadsBack) {
  const auto schedule =
      schedule_of(program_of("MoveJoint(70, -90, 180, 0, 0, 180, t=1)", Dialect::kDocumented));
  const auto trace = parse_trace("plan", to_trace(schedule, "a \"plan\" \xFF"));
  ASSERT_TRUE(trace.has_value()) << describe(trace.error());
  EXPECT_EQ(trace->device, "parol6");
  ASSERT_EQ(trace->events.size(), schedule.frames.size());
  for (std::size_t i = 0; i < schedule.frames.size(); ++i) {
    EXPECT_EQ(trace->events[i].time, at(std::chrono::milliseconds{10 * i}));
    EXPECT_TRUE(
        armjig::test::same_bytes(trace->events[i].bytes, parol6::encode(schedule.frames[i])));
  }
}

}  // namespace
}  // namespace armjig::script
