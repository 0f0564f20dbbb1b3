// SPDX-License-Identifier: Apache-2.0
// What the board does when its profile is not the shipped one. Expectations come from
// docs/spec/parol6.md, "Profiles and differences".
#include "emulators/parol6/profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "tests/unit/emulators/parol6/desk.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig::parol6::emulation {
namespace {

using test::as_vector;
using test::ByteVector;
using test::hex;
using test::joined;
using testing::Each;
using testing::ElementsAre;
using namespace std::chrono_literals;

constexpr Command kUndefined{42};

Desk desk_with(const BoardProfile& profile, const Plant& plant = standard_plant()) {
  Desk desk{Board{plant, {}, profile}};
  desk.wait(1s);
  return desk;
}

Desk documented_desk() { return desk_with(kDocumentedBoard); }

ByteVector with_check(std::uint8_t check) {
  auto frame = command(Command::kIdle);
  frame.check = check;
  return as_vector(encode(frame));
}

/// A board that has homed: 100 once, then idle for as long as it takes.
Desk homed_desk(const BoardProfile& profile) {
  auto desk = desk_with(profile);
  desk.send(command(Command::kHome));
  desk.wait(10ms);
  EXPECT_EQ(desk.hold(command(Command::kIdle), 33s).homed, 0xFF);
  return desk;
}

/// Home, and what comes next, until J1 has left its switch again.
Desk interrupted_desk(const BoardProfile& profile, Command code) {
  auto desk = desk_with(profile);
  desk.send(command(Command::kHome));
  desk.wait(10ms);
  desk.hold(command(Command::kIdle), 9500ms);  // all of J1 to J3 are seen at 9.21 s
  desk.hold(command(code), 20ms);
  desk.hold(command(Command::kEnable), 20ms);
  return desk;
}

TEST(DocumentedBoard, TakesOnlyTheCheckByteOfTheDocument) {
  auto desk = documented_desk();
  EXPECT_EQ(desk.send(with_check(0xD4)).size(), 1U);
  EXPECT_EQ(desk.send(with_check(0xE4)).size(), 0U);
  EXPECT_EQ(desk.send(with_check(0x00)).size(), 0U);
}

TEST(BoardProfile, ChoosesWhichCheckBytesAreTakenOfEitherReceiver) {
  for (auto profile : {kFirmwareBoard, kDocumentedBoard}) {
    const auto answers = [&profile](CheckPolicy policy, std::uint8_t check) {
      profile.check = policy;
      return desk_with(profile).send(with_check(check)).size();
    };
    EXPECT_EQ(answers(CheckPolicy::kIgnore, 0x00), 1U);
    EXPECT_EQ(answers(CheckPolicy::kBoardOnly, 0xD4), 1U);
    EXPECT_EQ(answers(CheckPolicy::kBoardOnly, 0xE4), 0U);
    EXPECT_EQ(answers(CheckPolicy::kBoardOrHost, 0xE4), 1U);
    EXPECT_EQ(answers(CheckPolicy::kBoardOrHost, 0x00), 0U);
  }
}

TEST(DocumentedBoard, LosesNoGoodFrameBehindGarbage) {
  const auto good = with_check(0xD4);
  const auto answers = [](const ByteVector& bytes) { return documented_desk().send(bytes).size(); };
  EXPECT_EQ(answers(joined(hex("FF"), good)), 1U);
  EXPECT_EQ(answers(joined(hex("FF FF FF 00"), good)), 1U);
  EXPECT_EQ(answers(joined(as_vector(Bytes{good}.first(30)), good)), 1U);
  EXPECT_EQ(answers(hex("FF FF FF 02 01 02")), 0U);
  EXPECT_EQ(answers(joined(hex("FF FF FF 35 00"), as_vector(Bytes{good}.subspan(4)))), 0U);
}

TEST(DocumentedBoard, GivesEachFrameOfABurstAPass) {
  auto desk = documented_desk();
  const auto answers = desk.send(joined(as_vector(encode(command(Command::kJog, {1000}))),
                                        as_vector(encode(command(kUndefined)))));
  EXPECT_EQ(answers.size(), 2U);
  EXPECT_EQ(counters(desk.board)[0], 1);
}

TEST(DocumentedBoard, StopsAfterTheSilenceThatTheTimeoutNames) {
  auto desk = documented_desk();
  auto jog = command(Command::kJog, {1000});
  jog.timeout = 20;
  EXPECT_EQ(desk.send(jog).timeout_error, 0);
  desk.run(10s);
  const auto stopped_at = counters(desk.board)[0];
  EXPECT_EQ(stopped_at, 20);  // steps at 10 us, 1.01 ms, ... 19.01 ms
  EXPECT_EQ(desk.send(jog).timeout_error, 1);
  desk.wait(10ms);
  EXPECT_EQ(desk.send(jog).timeout_error, 0);
  EXPECT_GT(counters(desk.board)[0], stopped_at);
}

TEST(DocumentedBoard, IsNotSilentWhenFramesComeInTime) {
  auto desk = documented_desk();
  auto jog = command(Command::kJog, {1000});
  jog.timeout = 20;
  EXPECT_EQ(desk.hold(jog, 1s).timeout_error, 0);
  EXPECT_NEAR(counters(desk.board)[0], 1000, 1);
}

TEST(DocumentedBoard, KeepsJoggingWithoutATimeout) {
  auto desk = documented_desk();
  desk.send(command(Command::kJog, {1000}));
  desk.run(10s);
  EXPECT_EQ(counters(desk.board)[0], 10'000);
}

TEST(DocumentedBoard, ReportsNoSpeedWhileIdle) {
  auto desk = documented_desk();
  desk.hold(command(Command::kJog, {1000}), 50ms);
  EXPECT_EQ(desk.hold(command(Command::kIdle, {1000, 2000}), 30ms).speed[0], StepsPerSecond{0});
}

TEST(DocumentedBoard, ClampsSpeedsToTheTable) {
  auto desk = documented_desk();
  const auto fast = command(Command::kJog, {60'000, -60'000, 60'000, 60'000, 60'000, -60'000});
  desk.hold(fast, 20ms);
  EXPECT_THAT(speeds(desk.board), ElementsAre(6500, -18'000, 20'000, 22'000, 22'000, -22'000));
}

TEST(DocumentedBoard, DoesNotKnowTheDemonstration) {
  auto desk = documented_desk();
  desk.hold(command(Command::kDemo), 1s);
  EXPECT_THAT(counters(desk.board), Each(0));
}

TEST(DocumentedBoard, HomesOnceWhileHomeIsHeld) {
  auto desk = documented_desk();
  desk.hold(command(Command::kHome), 33s);
  const auto answer = desk.hold(command(Command::kHome), 3s);
  EXPECT_EQ(answer.homed, 0xFF);
  EXPECT_EQ(answer.position[5], Steps{32'000});
}

TEST(DocumentedBoard, HomesAgainAfterAnotherCode) {
  for (const auto code : {Command::kIdle, kUndefined, Command::kEnable}) {
    auto desk = documented_desk();
    desk.hold(command(Command::kHome), 33s);
    desk.hold(command(code), 20ms);
    EXPECT_EQ(desk.hold(command(Command::kHome), 50ms).homed, 0x03);
  }
}

TEST(DocumentedBoard, BeginsAnInterruptedHomingAfresh) {
  for (const auto code :
       {Command::kJog, Command::kGoTo, Command::kDisable, Command::kClearError, Command::kEnable}) {
    auto desk = interrupted_desk(kDocumentedBoard, code);
    desk.hold(command(Command::kHome), 20ms);
    EXPECT_EQ(desk.board.joints()[3].stepper.speed(), StepRate{5550});  // J4's seek
    desk.hold(command(Command::kIdle), 40s);
    EXPECT_EQ(desk.send(command(Command::kIdle)).homed, 0xFF);
  }
}

TEST(DocumentedBoard, HasNoSpeedLeftOfAHomingThatWasDisabled) {
  EXPECT_THAT(speeds(interrupted_desk(kDocumentedBoard, Command::kDisable).board), Each(0.0F));
}

TEST(ShippedBoard, ForgetsNotAllOfAnInterruptedHoming) {  // the contrast to the test above
  auto desk = interrupted_desk(kFirmwareBoard, Command::kJog);
  desk.hold(command(Command::kHome), 20ms);
  EXPECT_EQ(desk.board.joints()[0].stepper.speed(), StepRate{-2050});  // J1 backs off at once
}

TEST(DocumentedBoard, SaysWhichJointsLeftTheirRangeUntilCleared) {
  auto desk = homed_desk(kDocumentedBoard);
  // J1 stands at 10240 of at most 14000 steps.
  EXPECT_EQ(desk.hold(command(Command::kJog, {5000}), 700ms).position_error, 0x03);
  EXPECT_EQ(desk.hold(command(Command::kJog, {5000}), 200ms).position_error, 0x83);
  EXPECT_EQ(desk.hold(command(Command::kClearError), 20ms).position_error, 0x83);
  EXPECT_EQ(desk.hold(command(Command::kJog, {-5000}), 400ms).position_error, 0x83);
  EXPECT_EQ(desk.hold(command(Command::kClearError), 20ms).position_error, 0x03);
}

TEST(DocumentedBoard, HasNoPositionErrorsBeforeTheCountersAreAngles) {
  auto desk = documented_desk();
  EXPECT_EQ(desk.send(command(Command::kIdle)).position_error, 0x03);
  desk.hold(command(Command::kHome), 20s);  // J1 to J3 are homed, and J2 counts from its switch
  const auto answer = desk.send(command(Command::kIdle));
  EXPECT_EQ(answer.homed, 0xE3);
  EXPECT_EQ(answer.position_error, 0x03);
}

TEST(DocumentedBoard, IsDisabledByTheEmergencyStop) {
  auto desk = documented_desk();
  const auto jog = command(Command::kJog, {1000});
  desk.hold(jog, 20ms);
  const auto press = [&desk](Level level) {
    desk.board.touch(at(desk.now), [level](Plant& plant) { plant.inputs.estop = level; });
  };
  press(Level::kLow);
  const auto before = counters(desk.board)[0];
  desk.hold(command(Command::kEnable), 20ms);
  EXPECT_EQ(desk.hold(jog, 50ms).io, 0x07);
  EXPECT_EQ(counters(desk.board)[0], before);
  press(Level::kHigh);
  desk.hold(jog, 50ms);
  EXPECT_EQ(counters(desk.board)[0], before) << "release does not enable";
  desk.hold(command(Command::kEnable), 20ms);
  desk.hold(jog, 50ms);
  EXPECT_GT(counters(desk.board)[0], before);
}

TEST(BoardProfile, MayStopJointsAtTheirBounds) {
  auto profile = kDocumentedBoard;
  profile.stops_at_bounds = true;
  auto desk = homed_desk(profile);
  auto answer = desk.hold(command(Command::kJog, {5000}), 2s);
  EXPECT_EQ(answer.position[0], Steps{14'000});
  EXPECT_EQ(answer.speed[0], StepsPerSecond{0});
  desk.hold(command(Command::kJog, {-1000}), 100ms);
  answer = desk.hold(go_to({20'000, -32'000, 57'905, 0, 0, 32'000}), 2s);
  EXPECT_EQ(answer.position[0], Steps{14'000});
}

TEST(DocumentedBoard, SaysWhatTheGripperWasTold) {
  auto desk = documented_desk();
  auto frame = command(Command::kIdle);
  frame.gripper = {.position = 10,
                   .speed = 77,
                   .current = Milliamperes{500},
                   .command = 0xD0,
                   .mode = 0,
                   .id = 5};
  auto answer = desk.send(frame);
  EXPECT_EQ(answer.gripper.id, 5);
  EXPECT_EQ(answer.gripper.speed, 77);
  EXPECT_EQ(answer.gripper.object_detection, 0);
  CanFrame report{.id = can_id(5, GripperCan::kAnswer), .size = 4};
  report.data[3] = std::byte{0xD1};  // the high object bit stands second: object 2
  desk.board.receive_can(at(desk.now), report);
  desk.wait(1ms);
  EXPECT_EQ(desk.send(frame).gripper.object_detection, 2);
}

TEST(DocumentedBoard, SendsSetPointsThatCameWithACalibration) {
  auto desk = documented_desk();
  auto frame = command(Command::kIdle);
  frame.gripper = {.position = 10,
                   .speed = 77,
                   .current = Milliamperes{2000},
                   .command = 0xD0,
                   .mode = 1,
                   .id = 0};
  desk.send(frame);
  EXPECT_EQ(desk.can.back().size, 0);
  desk.wait(1ms);
  frame.gripper.mode = 0;
  desk.send(frame);
  const auto sent = desk.can.back();
  EXPECT_EQ(as_vector(sent.payload()), hex("0A 4D 05 14 D0"));  // 2000 mA are bounded to 1300
}

}  // namespace
}  // namespace armjig::parol6::emulation
