// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/parol6_judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

#include "emulators/parol6/firmware_receiver.hpp"
#include "harness/wire/parol6/splitter.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::parol6::rig {
namespace {

using namespace std::chrono_literals;
using emulation::FirmwareReceiver;
using ::testing::HasSubstr;

Permissions allowing(std::initializer_list<Hazard> hazards) {
  Permissions permissions;
  for (const auto hazard : hazards) permissions.add(hazard);
  return permissions;
}

/// A judge, and the bytes of a host and a board.
class Court {
 public:
  explicit Court(Permissions permissions = {}) : permissions_{permissions} {}

  std::optional<Refusal> judge(Bytes bytes) { return judge_->judge(bytes, permissions_); }
  std::optional<Refusal> judge(const CommandFrame& frame) { return judge(encode(frame)); }
  std::optional<Refusal> judge(Command command) { return judge(CommandFrame{.command = command}); }
  void answer(const TelemetryFrame& telemetry) { judge_->observe(encode(telemetry)); }
  Judge& operator*() { return *judge_; }
  Judge* operator->() { return judge_.get(); }

 private:
  std::unique_ptr<Judge> judge_ = make_judge();
  Permissions permissions_;
};

/// Any place within all bounds.
constexpr std::array kMiddle{Steps{0}, Steps{-30000}, Steps{60000},
                             Steps{0}, Steps{0},      Steps{32000}};

TelemetryFrame homed_at(const std::array<Steps, kJointCount>& position, Command echo) {
  return {.position = position, .homed = 0xFF, .io = io_flag::kEstopReleased, .echo = echo};
}
TelemetryFrame homed(Command echo) { return homed_at(kMiddle, echo); }
TelemetryFrame unhomed(Command echo) {
  return {.homed = 0x03, .io = io_flag::kEstopReleased, .echo = echo};
}

CommandFrame jog(std::size_t j, std::int32_t speed) {
  CommandFrame frame{.command = Command::kJog};
  frame.speed[j] = StepsPerSecond{speed};
  return frame;
}
CommandFrame go_to(const std::array<Steps, kJointCount>& goal) {
  return {.position = goal, .command = Command::kGoTo};
}

// Which permission for what.

TEST(Parol6Judge, EachCommandAsksForItsOwnPermissionAndForNoOther) {
  const std::array<std::pair<Command, Hazard>, 4> needs{{{Command::kHome, Hazard::kHome},
                                                         {Command::kEnable, Hazard::kState},
                                                         {Command::kClearError, Hazard::kState},
                                                         {Command::kJog, Hazard::kMove}}};
  constexpr std::array kAll{Hazard::kObserve, Hazard::kState, Hazard::kMove, Hazard::kHome,
                            Hazard::kGrip};
  for (const auto& [command, needed] : needs) {
    for (const auto given : kAll) {
      const auto refusal = Court{allowing({given})}.judge(command);
      ASSERT_EQ(refusal.has_value(), given != needed) << static_cast<int>(command);
      if (refusal) {
        EXPECT_EQ(refusal->hazard, needed);
      }
    }
  }
}

TEST(Parol6Judge, GoToAsksForPermissionToMove) {
  for (const auto given : {Hazard::kMove, Hazard::kHome}) {
    Court court{allowing({given})};
    court.answer(homed(Command::kIdle));
    EXPECT_EQ(court.judge(go_to(kMiddle)).has_value(), given != Hazard::kMove);
  }
}

TEST(Parol6Judge, TheDemonstrationNeedsAHomedArmAndPermissionToMove) {
  const auto refusal = Court{Permissions::all()}.judge(Command::kDemo);
  ASSERT_TRUE(refusal);
  EXPECT_THAT(refusal->reason, HasSubstr("cannot be disabled"));
  for (const auto given : {Hazard::kMove, Hazard::kHome}) {
    Court court{allowing({given})};
    court.answer(homed(Command::kIdle));
    EXPECT_EQ(court.judge(Command::kDemo).has_value(), given != Hazard::kMove);
  }
}

TEST(Parol6Judge, StopsADemonstrationWhoseEmergencyStopIsPressedOrWhichLeavesTheBounds) {
  auto pressed = homed(Command::kDemo);
  pressed.io = {};
  auto beyond = homed(Command::kDemo);
  beyond.position.back() = Steps{90'000};
  auto further = beyond;
  further.position.back() = Steps{90'100};
  for (const auto& said : {std::vector{pressed}, std::vector{beyond, further}}) {
    Court court{Permissions::all()};
    court.answer(homed(Command::kIdle));
    ASSERT_FALSE(court.judge(Command::kDemo));
    for (const auto& telemetry : said) court.answer(telemetry);
    EXPECT_TRUE(court->must_stop());
  }
}

TEST(Parol6Judge, EveryOtherCodeIsHarmless) {
  for (int code = 0; code < 256; ++code) {
    const auto command = static_cast<Command>(code);
    const bool is_known =
        code == 69 || code == 100 || code == 101 || code == 103 || code == 123 || code == 156;
    EXPECT_EQ(Court{}.judge(command).has_value(), is_known) << code;
  }
}

TEST(Parol6Judge, SwitchingAnOutputNeedsPermissionLeavingItDoesNot) {
  const CommandFrame off{.command = Command::kIdle};
  const CommandFrame on{.command = Command::kIdle, .in_out = io_flag::kOut2};
  EXPECT_EQ(Court{}.judge(on)->hazard, Hazard::kState);
  Court court{allowing({Hazard::kState})};
  ASSERT_FALSE(court.judge(on));
  EXPECT_FALSE(court->judge(encode(on), {})) << "on as before";
  EXPECT_TRUE(court->judge(encode(off), {})) << "off again is switching too";
}

TEST(Parol6Judge, AGripperSetPointNeedsPermissionAPollDoesNot) {
  CommandFrame frame{.command = Command::kIdle};
  EXPECT_FALSE(Court{}.judge(frame)) << "all zeros, as the board begins";
  frame.gripper = {.position = 9, .mode = 0};
  EXPECT_EQ(Court{}.judge(frame)->hazard, Hazard::kGrip);
  Court court{allowing({Hazard::kGrip})};
  ASSERT_FALSE(court.judge(frame));
  EXPECT_FALSE(court->judge(encode(frame), {})) << "the same again only polls";
}

TEST(Parol6Judge, TheGripperCalibratesWithEveryFrameThatSaysSo) {
  CommandFrame frame{.command = Command::kIdle};
  frame.gripper.mode = 1;
  Court court{allowing({Hazard::kGrip})};
  ASSERT_FALSE(court.judge(frame));
  EXPECT_TRUE(court->judge(encode(frame), {}));
  frame.gripper.mode = 0;
  EXPECT_FALSE(court->judge(encode(frame), {})) << "nothing else differs: a poll";
}

// Where a forbidden command may hide.

const auto kForbidden = encode(CommandFrame{.command = Command::kJog});

TEST(Parol6Judge, ACommandBehindGarbageIsFound) {
  Court court;
  EXPECT_TRUE(court.judge(test::joined(test::hex("00 01 02 FF FF 17"), kForbidden)));
}

TEST(Parol6Judge, ACommandSplitOverWritesIsFoundAtItsLastByte) {
  for (std::size_t cut = 1; cut < kForbidden.size(); ++cut) {
    Court court;
    ASSERT_FALSE(court.judge(Bytes{kForbidden}.first(cut)));
    EXPECT_TRUE(court.judge(Bytes{kForbidden}.subspan(cut))) << cut;
  }
}

TEST(Parol6Judge, ACommandByteByByteIsFound) {
  Court court;
  const auto bytes = Bytes{kForbidden};
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i) ASSERT_FALSE(court.judge(bytes.subspan(i, 1)));
  EXPECT_TRUE(court.judge(bytes.last(1)));
}

TEST(Parol6Judge, ACommandBehindAnyRunOfStartBytesIsFound) {
  // 0 to 3 start bytes too many: the board takes the fourth for a length of 255 and swallows the
  // frame, a board that looks at every place does not.
  for (std::size_t extra = 0; extra < 8; ++extra) {
    Court court;
    EXPECT_TRUE(court.judge(test::joined(test::ByteVector(extra, kStartByte), kForbidden)))
        << extra;
  }
}

TEST(Parol6Judge, ACommandInTheStoreIsFoundWhenAShortFrameUncoversIt) {
  // A frame that ends badly is not accepted, but fills the board's store; the next one, two bytes
  // long, makes the board act on it.
  auto unended = test::as_vector(kForbidden);
  unended.back() = std::byte{0x03};
  Court court;
  ASSERT_FALSE(court.judge(unended));
  EXPECT_TRUE(court.judge(test::hex("FF FF FF 02 01 02")));
}

TEST(Parol6Judge, ACommandInAFrameLongerThanItsNominalLengthIsFound) {
  auto bytes = test::as_vector(kForbidden);
  bytes[3] = std::byte{60};
  bytes.resize(4 + 58);
  bytes.insert(bytes.end(), kEndBytes.begin(), kEndBytes.end());
  EXPECT_TRUE(Court{}.judge(bytes));
}

TEST(Parol6Judge, ACommandInsideALongerFrameIsFoundForBoardsThatLookThere) {
  const auto bytes = test::joined(test::hex("FF FF FF F0"), kForbidden, test::zeros(184));
  FirmwareReceiver shipped;
  ASSERT_FALSE(shipped.step(bytes).accepted) << "the shipped board would not";
  Splitter documented{kCommandPayloadSize};
  ASSERT_TRUE(std::holds_alternative<Splitter::Fault>(documented.step(bytes).found));
  EXPECT_TRUE(Court{}.judge(bytes));
}

TEST(Parol6Judge, OfAWriteThatIsRefusedNothingCounts) {
  const auto idle = encode(CommandFrame{.command = Command::kIdle});
  Court court;
  ASSERT_FALSE(court.judge(Bytes{idle}.first(20)));
  // These would end the idle frame, if they were written.
  ASSERT_TRUE(court.judge(test::joined(test::zeros(36), kForbidden)));
  ASSERT_FALSE(court.judge(Bytes{idle}.subspan(20)));
  EXPECT_TRUE(court.judge(Command::kJog)) << "and both still know where frames begin";
}

// Opening and stopping.

/// Some of everything that a receiver may be in the middle of.
std::vector<test::ByteVector> half_sent() {
  std::vector<test::ByteVector> all;
  for (std::size_t cut = 0; cut < kForbidden.size(); ++cut) {
    all.push_back(test::as_vector(Bytes{kForbidden}.first(cut)));
  }
  for (const int length : {0, 1, 2, 52, 85, 255}) {
    auto bytes = test::hex("FF FF FF");
    bytes.push_back(static_cast<std::byte>(length));
    for (const std::size_t more : {0U, 1U, 83U, 84U, 253U, 254U, 255U, 256U}) {
      all.push_back(test::joined(bytes, test::ByteVector(more, std::byte{0x02})));
    }
  }
  return all;
}

std::vector<Command> accepted_by_shipped_board(FirmwareReceiver& receiver, Bytes bytes) {
  std::vector<Command> commands;
  while (!bytes.empty()) {
    const auto step = receiver.step(bytes);
    bytes = bytes.subspan(step.used);
    if (step.accepted) commands.push_back(decode_command(receiver.body()).command);
  }
  return commands;
}

TEST(Parol6Judge, OpeningBytesAreNoCommandAndLeaveTheSameStoreWhateverWasHalfSent) {
  const auto judge = make_judge();
  for (const auto& before : half_sent()) {
    FirmwareReceiver receiver;
    (void)accepted_by_shipped_board(receiver, before);
    EXPECT_TRUE(accepted_by_shipped_board(receiver, judge->opening_bytes()).empty());
    EXPECT_TRUE(std::ranges::all_of(receiver.body(), [](std::byte b) { return b == std::byte{}; }));
    EXPECT_THAT(accepted_by_shipped_board(receiver, kForbidden), testing::SizeIs(1)) << "in step";
  }
}

TEST(Parol6Judge, StopBytesDisableWhateverWasHalfSent) {
  Court court;
  for (const auto& before : half_sent()) {
    FirmwareReceiver receiver;
    (void)accepted_by_shipped_board(receiver, before);
    EXPECT_EQ(accepted_by_shipped_board(receiver, court->stop()[0]),
              std::vector{Command::kDisable});
  }
}

TEST(Parol6Judge, StoppingLeavesOutputsAndGripperAsTheyAre) {
  Court court{Permissions::all()};
  CommandFrame frame{.command = Command::kIdle, .in_out = io_flag::kOut1};
  frame.gripper = {.position = 200, .speed = 10, .command = gripper_command::kActivate, .mode = 1};
  ASSERT_FALSE(court.judge(frame));
  const auto stop = decode_command(body_of(court->stop()[0].last<kCommandFrameSize>()));
  frame.gripper.mode = 0;  // else it would calibrate with each of them
  EXPECT_EQ(stop.in_out, frame.in_out);
  EXPECT_EQ(stop.gripper, frame.gripper);
}

// Bounds.

TEST(Parol6Judge, EachJointHasItsFastestJogBothWays) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto fastest = kJoints[j].max_jog.value;
    for (const int sign : {1, -1}) {
      EXPECT_FALSE(Court{Permissions::all()}.judge(jog(j, sign * fastest))) << j;
      EXPECT_TRUE(Court{Permissions::all()}.judge(jog(j, sign * (fastest + 1)))) << j;
    }
  }
}

TEST(Parol6Judge, AtABoundAHomedJointMayOnlyJogInwards) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    for (const auto& [bound, outwards] :
         {std::pair{kJointBounds[j].lower, -1}, std::pair{kJointBounds[j].upper, 1}}) {
      auto position = kMiddle;
      position[j] = bound;
      Court court{Permissions::all()};
      court.answer(homed_at(position, Command::kIdle));
      EXPECT_TRUE(court.judge(jog(j, outwards * 100)));
      EXPECT_FALSE(court.judge(jog(j, -outwards * 100)));
    }
  }
}

TEST(Parol6Judge, GoToNeedsAHomedArm) {
  Court court{Permissions::all()};
  EXPECT_TRUE(court.judge(go_to(kMiddle))) << "nobody knows yet";
  court.answer(unhomed(Command::kIdle));
  EXPECT_TRUE(court.judge(go_to(kMiddle)));
  court.answer(homed(Command::kIdle));
  EXPECT_FALSE(court.judge(go_to(kMiddle)));
}

TEST(Parol6Judge, AGoToToWhereAnArmStandsMayEndHoming) {
  const auto here = unhomed(Command::kIdle).position;
  auto beside = here;
  beside[2] = beside[2] + Steps{1};
  auto with_speed = go_to(here);
  with_speed.speed[4] = StepsPerSecond{1};

  Court unhomed_arm{Permissions::all()};
  unhomed_arm.answer(unhomed(Command::kIdle));
  unhomed_arm.answer(unhomed(Command::kIdle));
  EXPECT_TRUE(unhomed_arm.judge(go_to(here))) << "nothing is to be ended";

  Court court{Permissions::all()};
  ASSERT_FALSE(court.judge(Command::kHome));
  auto moving = unhomed(Command::kHome);
  moving.position = beside;
  court.answer(moving);
  court.answer(unhomed(Command::kHome));
  EXPECT_TRUE(court.judge(go_to(here))) << "it moves";
  court.answer(unhomed(Command::kHome));
  EXPECT_TRUE(court.judge(go_to(beside)));
  EXPECT_TRUE(court.judge(with_speed));
  ASSERT_FALSE(court.judge(Command::kIdle));
  EXPECT_TRUE(court.judge(go_to(here))) << "it may be elsewhere by now";
  court.answer(unhomed(Command::kIdle));
  EXPECT_FALSE(court.judge(go_to(here)));
}

TEST(Parol6Judge, GoToStaysBetweenTheBoundsOfEachJoint) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    for (const auto& [bound, outwards] :
         {std::pair{kJointBounds[j].lower, -1}, std::pair{kJointBounds[j].upper, 1}}) {
      auto goal = kMiddle;
      goal[j] = bound;
      Court court{Permissions::all()};
      court.answer(homed_at(goal, Command::kIdle));
      EXPECT_FALSE(court.judge(go_to(goal)));
      goal[j] = goal[j] + Steps{outwards};
      EXPECT_TRUE(court.judge(go_to(goal)));
    }
  }
}

TEST(Parol6Judge, GoToWithASpeedRestsBeyondItsTargetAndThatCounts) {
  // The law is (speed + 100 distance) / 2: with 3000 steps/s a joint stands 30 steps beyond.
  auto goal = kMiddle;
  goal[0] = kJointBounds[0].upper - Steps{30};
  Court court{Permissions::all()};
  court.answer(homed_at(goal, Command::kIdle));
  auto frame = go_to(goal);
  frame.speed[0] = StepsPerSecond{3000};
  EXPECT_FALSE(court.judge(frame));
  frame.speed[0] = StepsPerSecond{3100};
  EXPECT_TRUE(court.judge(frame));
}

TEST(Parol6Judge, GoToIsNotFasterThanItsJointMayBe) {
  // 100 times the distance, halved: J1 may close 6500 / 50 = 130 steps at once.
  auto goal = kMiddle;
  Court court{Permissions::all()};
  court.answer(homed(Command::kIdle));
  goal[0] = kMiddle[0] + Steps{130};
  EXPECT_FALSE(court.judge(go_to(goal)));
  goal[0] = kMiddle[0] + Steps{131};
  EXPECT_THAT(court.judge(go_to(goal))->reason, HasSubstr("smaller pieces"));
}

/// Leads joint `j` away from the middle by `step` in each period and back, while telemetry shows
/// the arm where the frame of `delay` periods ago wanted it. The first refusal or stop.
std::optional<std::string> lead(std::size_t j, int step, int delay) {
  constexpr int kThere = 40;
  Court court{Permissions::all()};
  const auto place = [&](int period) {
    auto goal = kMiddle;
    const int gone = period <= kThere ? period : std::max(0, 2 * kThere - period);
    goal[j] = goal[j] + Steps{step * std::max(0, gone)};
    return goal;
  };
  for (int i = 0; i < 3 * kThere; ++i) {
    court->set_time(at(i * 10ms));
    court.answer(homed_at(place(i - delay), i < delay ? Command::kIdle : Command::kGoTo));
    if (auto reason = court->must_stop()) return reason;
    if (const auto refusal = court.judge(go_to(place(i)))) return refusal->reason;
  }
  return std::nullopt;
}

TEST(Parol6Judge, EachJointMayBeLedAtItsTopSpeedWhateverTheAgeOfTelemetry) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto step = kJoints[j].max_speed.value / 100;
    for (const int delay : {1, 2, 3, 5, 9}) {
      EXPECT_EQ(lead(j, step / 2, delay), std::nullopt) << "j" << j + 1 << ", " << delay;
      EXPECT_EQ(lead(j, j == 3 || j == 4 ? 150 : step, delay), std::nullopt)
          << "j" << j + 1 << ", " << delay;
    }
  }
}

TEST(Parol6Judge, NoJointMayBeLedFasterWhateverTheAgeOfTelemetry) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto step = kJoints[j].max_speed.value / 100 * 5 / 4;
    EXPECT_THAT(lead(j, step, 1).value_or(""), HasSubstr("smaller pieces")) << j;
    EXPECT_THAT(lead(j, step, 5).value_or(""), HasSubstr("smaller pieces")) << j;
  }
}

TEST(Parol6Judge, AnArmThatDoesNotFollowIsStopped) {
  EXPECT_THAT(lead(0, 65, 1000).value_or(""), HasSubstr("j1 is at 0 steps and does not follow"));
}

TEST(Parol6Judge, AnArmBeyondItsBoundMayComeBackButGoNoFurther) {
  auto outside = kMiddle;
  outside[0] = kJointBounds[0].upper + Steps{200};
  Court court{Permissions::all()};
  court.answer(homed_at(outside, Command::kIdle));
  auto further = outside;
  further[0] = further[0] + Steps{1};
  EXPECT_TRUE(court.judge(go_to(further)));
  for (int i = 0; i < 10; ++i) {
    court->set_time(at(i * 10ms));
    outside[0] = outside[0] - Steps{50};
    EXPECT_FALSE(court.judge(go_to(outside))) << i;
  }
}

// The emergency stop, and being out of sight.

TelemetryFrame pressed(Command echo) { return {.homed = 0xFF, .io = 0, .echo = echo}; }

TEST(Parol6Judge, NothingMayMoveWhileTheEmergencyStopIsPressed) {
  Court court{Permissions::all()};
  court.answer(pressed(Command::kIdle));
  EXPECT_TRUE(court.judge(Command::kHome));
  EXPECT_TRUE(court.judge(Command::kJog));
  EXPECT_TRUE(court.judge(go_to(kMiddle)));
  EXPECT_FALSE(court.judge(Command::kIdle));
  EXPECT_FALSE(court.judge(Command::kDisable));
  court.answer(homed(Command::kIdle));
  EXPECT_FALSE(court.judge(Command::kJog));
}

TEST(Parol6Judge, TheEmergencyStopStopsWhatMoves) {
  for (const auto command : {Command::kJog, Command::kHome}) {
    Court court{Permissions::all()};
    ASSERT_FALSE(court.judge(command));
    court.answer(pressed(command));
    EXPECT_EQ(court->must_stop(), "the emergency stop was pressed");
    EXPECT_EQ(court->must_stop(), std::nullopt) << "once";
  }
}

TEST(Parol6Judge, AnEmergencyStopThatIsReleasedInTheNextFrameStillCounts) {
  Court court{Permissions::all()};
  ASSERT_FALSE(court.judge(Command::kJog));
  const auto first = encode(pressed(Command::kJog));
  const auto second = encode(homed(Command::kJog));
  court->observe(test::joined(test::as_vector(first), second));
  EXPECT_TRUE(court->must_stop());
}

TEST(Parol6Judge, TheEmergencyStopOfAnArmThatStandsNeedsNoStop) {
  Court court{Permissions::all()};
  ASSERT_FALSE(court.judge(Command::kIdle));
  court.answer(pressed(Command::kIdle));
  EXPECT_FALSE(court->must_stop());
}

TEST(Parol6Judge, ABoundThatIsReachedWhileJoggingStops) {
  auto position = kMiddle;
  Court court{Permissions::all()};
  court.answer(homed(Command::kIdle));
  ASSERT_FALSE(court.judge(jog(2, 100)));
  court.answer(homed(Command::kJog));
  EXPECT_FALSE(court->must_stop());
  position[2] = kJointBounds[2].upper;
  court.answer(homed_at(position, Command::kJog));
  EXPECT_EQ(court->must_stop(), "j3 reached its bound");
}

TEST(Parol6Judge, AJointThatLeavesItsRangeStopsWhateverItWasTold) {
  for (const auto& frame : {go_to(kMiddle), jog(2, 100)}) {
    Court court{Permissions::all()};
    court.answer(homed(Command::kIdle));
    ASSERT_FALSE(court.judge(frame));
    auto position = kMiddle;
    position[0] = kJointBounds[0].upper + Steps{400};
    court.answer(homed_at(position, frame.command));
    EXPECT_THAT(court->must_stop().value_or(""), HasSubstr("j1 is at"));
    EXPECT_EQ(court->matter_of_stop(), Refusal::Matter::kAstray);
    position[0] = position[0] - Steps{10};
    court.answer(homed_at(position, frame.command));
    EXPECT_FALSE(court->must_stop()) << "it comes back";
  }
}

TEST(Parol6Judge, NothingMayMoveWhenFiftyFramesInARowHaveNoAnswer) {
  Court court{Permissions::all()};
  for (int i = 0; i < 50; ++i) ASSERT_FALSE(court.judge(Command::kJog)) << i;
  EXPECT_THAT(court.judge(Command::kJog)->reason, HasSubstr("has not answered"));
  court.answer(homed(Command::kJog));
  EXPECT_FALSE(court.judge(Command::kJog));
}

// Whether it may be moving.

TEST(Parol6Judge, AJogEndsWhenTheBoardSaysThatItHasTheIdle) {
  Court court{Permissions::all()};
  EXPECT_FALSE(court->may_be_moving());
  ASSERT_FALSE(court.judge(Command::kJog));
  EXPECT_TRUE(court->may_be_moving());
  ASSERT_FALSE(court.judge(Command::kIdle));
  EXPECT_TRUE(court->may_be_moving()) << "it may be lost";
  court.answer(homed(Command::kJog));
  EXPECT_TRUE(court->may_be_moving()) << "that was the answer to the frame before";
  court.answer(homed(Command::kIdle));
  EXPECT_FALSE(court->may_be_moving());
}

TEST(Parol6Judge, HomingGoesOnUnderIdleUntilAllJointsAreHomed) {
  Court court{Permissions::all()};
  court.answer(homed(Command::kIdle));
  ASSERT_FALSE(court.judge(Command::kHome));
  ASSERT_FALSE(court.judge(Command::kIdle));
  court.answer(homed(Command::kHome));  // the bits fall in the pass behind this answer
  court.answer(homed(Command::kIdle));
  EXPECT_TRUE(court->may_be_moving()) << "homed bits of the run before";
  court.answer(unhomed(Command::kIdle));
  EXPECT_TRUE(court->may_be_moving());
  court.answer(homed(Command::kIdle));
  EXPECT_FALSE(court->may_be_moving());
}

TEST(Parol6Judge, HomeAndIdleInOneWriteIsHoming) {
  Court court{Permissions::all()};
  const auto home = encode(CommandFrame{.command = Command::kHome});
  const auto idle = encode(CommandFrame{.command = Command::kIdle});
  ASSERT_FALSE(court.judge(test::joined(test::as_vector(home), idle)));
  court.answer(unhomed(Command::kIdle));
  EXPECT_TRUE(court->may_be_moving());
}

TEST(Parol6Judge, DisablingEndsHomingWhenTheBoardSaysThatItHasIt) {
  Court court{Permissions::all()};
  ASSERT_FALSE(court.judge(Command::kHome));
  ASSERT_FALSE(court.judge(Command::kDisable));
  court.answer(unhomed(Command::kHome));
  EXPECT_TRUE(court->may_be_moving());
  court.answer(unhomed(Command::kDisable));
  EXPECT_FALSE(court->may_be_moving());
}

}  // namespace
}  // namespace armjig::parol6::rig
