// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/emulators/parol6/desk.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig::parol6::emulation {
namespace {

using test::as_vector;
using test::ByteVector;
using test::hex;
using test::joined;
using test::same_bytes;
using test::zeros;
using testing::Each;
using testing::ElementsAre;
using testing::Pair;
using namespace std::chrono_literals;

constexpr Command kUnknown{42};

ByteVector repeated(const ByteVector& bytes, int times) {
  ByteVector all;
  for (int i = 0; i < times; ++i) all = joined(std::move(all), bytes);
  return all;
}

/// What a B or R sequence of the reference starts from.
Desk fresh_desk(std::uint32_t pass_us = 10) {
  Desk desk{board_with_pass(pass_us)};
  desk.wait(1s);
  return desk;
}

/// The answer to one frame as bytes.
ByteVector answer_to(Desk& desk, const ByteVector& bytes) {
  const auto answers = desk.send(bytes);
  EXPECT_EQ(answers.size(), 1U);
  return answers.empty() ? ByteVector{} : answers[0];
}

ByteVector command_bytes(std::uint8_t code, std::uint8_t check = 0xE4) {
  auto bytes = joined(hex("FF FF FF 34"), zeros(49), hex("00 01 02"));
  bytes[40] = std::byte{code};
  bytes[53] = std::byte{check};
  return bytes;
}

TEST(Board, AnswersItsFirstFrameAsTheFirmwareDoes) {  // B1
  auto desk = fresh_desk();
  EXPECT_TRUE(
      same_bytes(answer_to(desk, command_bytes(101, 0xD4)),
                 joined(hex("FF FF FF 38"), zeros(36),
                        hex("03 0F 03 03 BA 95 64 65 00 00 00 00 01 00 02 01 01 D4 01 02"))));
  ASSERT_EQ(desk.can.size(), 1U);
  EXPECT_EQ(desk.can[0], (CanFrame{.id = 0x07A, .size = 0, .data = {}}));
}

TEST(Board, ReportsTenMillisecondsInTicks) {  // B2
  auto desk = fresh_desk();
  answer_to(desk, command_bytes(101, 0xD4));
  desk.wait(10ms);
  EXPECT_TRUE(
      same_bytes(answer_to(desk, command_bytes(255)),
                 joined(hex("FF FF FF 38"), zeros(36),
                        hex("03 0F 03 03 1B 77 64 FF 00 00 00 00 01 00 02 01 01 D4 01 02"))));
  EXPECT_EQ(desk.can[1], (CanFrame{.id = 0x07A, .size = 0, .data = {}}));
}

TEST(Board, SendsNewGripperSetPointsToTheCan) {  // B3
  auto desk = fresh_desk();
  answer_to(desk, command_bytes(101, 0xD4));
  desk.wait(10ms);
  answer_to(desk, command_bytes(255));
  desk.wait(10ms);
  EXPECT_TRUE(
      same_bytes(answer_to(desk, vectors::kFirstCommand),
                 joined(hex("FF FF FF 38"), zeros(36),
                        hex("03 0F 03 03 1B 77 64 00 00 00 00 00 01 00 02 01 01 D4 01 02"))));
  EXPECT_EQ(desk.can[2].id, 0x07A);
  EXPECT_TRUE(same_bytes(as_vector(desk.can[2].payload()), hex("01 01 00 01 01")));
}

TEST(Board, ReportsAGapInTicksModulo65536) {  // B2
  const auto ticks_after = [](Duration gap) {
    auto desk = fresh_desk();
    desk.send(command(Command::kIdle));
    desk.wait(gap);
    return int{desk.send(command(Command::kIdle)).timing};
  };
  EXPECT_THAT(ticks_after(100ms), testing::AnyOf(4776, 4777));
  EXPECT_THAT(ticks_after(1ms), testing::AnyOf(703, 704));
}

/// At standby and homed, IN1 high, 10 ms after the last frame; times where 10 ms are 7031 ticks.
Desk homed_desk() {
  Desk desk{board_with_pass(10)};
  desk.board.touch(at(0s), [](Plant& plant) { plant.inputs.in1 = Level::kHigh; });
  desk.send(command(Command::kHome));
  desk.wait(10ms);
  desk.hold(command(Command::kIdle), 32s - desk.now);  // a multiple of 64 us
  EXPECT_THAT(counters(desk.board), ElementsAre(10240, -32000, 57905, 0, 0, 32000));
  desk.send(command(Command::kIdle));
  desk.wait(10ms);
  return desk;
}

TEST(Board, AnswersWithWhatWasBeforeTheCommandButFreshInputs) {  // B4
  auto desk = homed_desk();
  EXPECT_TRUE(same_bytes(
      answer_to(desk, vectors::kJogCommand),
      joined(hex("FF FF FF 38 00 28 00 FF 83 00 00 E2 31 00 00 00 00 00 00 00 7D 00"), zeros(18),
             hex("FF AF 03 03 1B 77 64 7B 00 00 00 00 01 00 02 01 01 D4 01 02"))));
  EXPECT_EQ(desk.can.back().id, 0x07A);
  EXPECT_TRUE(same_bytes(as_vector(desk.can.back().payload()), hex("78 1E 01 F4 D0")));
}

TEST(Board, KeepsReportingTheLastSpeedsWhileDisabled) {  // B5
  auto desk = homed_desk();
  desk.send(vectors::kJogCommand);
  desk.wait(10us);
  desk.board.touch(at(desk.now), [](Plant& plant) { plant.inputs.estop = Level::kLow; });
  auto disable = command_bytes(102);
  disable[42] = std::byte{0x10};
  const auto speeds = hex("00 05 DC FF F4 48 00 0E 10 00 00 00 00 00 00 FF B9 B0");
  const auto answer = answer_to(desk, disable);
  EXPECT_TRUE(same_bytes(as_vector(Bytes{answer}.subspan(22, 18)), speeds));
  EXPECT_EQ(answer[41], std::byte{0x97});
  EXPECT_EQ(answer[47], std::byte{0x66});
  const auto stopped = counters(desk.board);
  for (int i = 0; i < 10; ++i) {
    desk.wait(10ms);
    EXPECT_TRUE(same_bytes(as_vector(Bytes{answer_to(desk, disable)}.subspan(22, 18)), speeds));
    EXPECT_EQ(counters(desk.board), stopped);
  }
}

constexpr std::array<std::int32_t, kJointCount> kOddSpeeds{-1, 255, 256, 65535, -65536, 8388607};

TEST(Board, ReportsIdleSpeedsClampedWithoutMoving) {  // B6
  auto desk = fresh_desk();
  desk.send(command(Command::kIdle, kOddSpeeds));
  desk.wait(10ms);
  const auto answer = answer_to(desk, command_bytes(255));
  EXPECT_TRUE(same_bytes(as_vector(Bytes{answer}.subspan(22, 18)),
                         hex("FF FF FF 00 00 FF 00 01 00 00 C3 50 FF 3C B0 00 C3 50")));
  EXPECT_TRUE(same_bytes(as_vector(Bytes{answer}.subspan(4, 18)), zeros(18)));
}

TEST(Board, ReportsIdleSpeedsWhileDisabledToo) {  // B6
  auto desk = fresh_desk();
  desk.send(command(Command::kDisable));
  desk.wait(10ms);
  desk.send(command(Command::kIdle, kOddSpeeds));
  desk.wait(10ms);
  EXPECT_TRUE(same_bytes(as_vector(Bytes{answer_to(desk, command_bytes(255))}.subspan(22, 18)),
                         hex("FF FF FF 00 00 FF 00 01 00 00 C3 50 FF 3C B0 00 C3 50")));
}

TEST(Board, DoesNotMoveWhileDisabledUntilEnabled) {  // B7
  auto desk = fresh_desk();
  desk.hold(command(Command::kDisable), 10ms);
  EXPECT_FALSE(desk.board.is_enabled());
  desk.hold(command(Command::kClearError), 10ms);
  desk.hold(command(Command::kJog, {1000, 1000, 1000, 1000, 1000, 1000}), 50ms);
  EXPECT_THAT(counters(desk.board), Each(0));
  desk.hold(command(Command::kEnable), 10ms);
  EXPECT_TRUE(desk.board.is_enabled());
  desk.hold(command(Command::kJog, {1000, 1000, 1000, 1000, 1000, 1000}), 50ms);
  EXPECT_THAT(counters(desk.board), Each(testing::AllOf(testing::Ge(49), testing::Le(51))));
}

TEST(Board, StopsAtAnUnknownCodeAndKeepsReportingTheSpeed) {  // B8
  auto desk = fresh_desk();
  desk.hold(command(Command::kJog, {1000}), 50ms);
  desk.send(command(kUnknown));
  const auto stopped = counters(desk.board);
  EXPECT_EQ(desk.hold(command(kUnknown), 100ms).speed[0], StepsPerSecond{1000});
  EXPECT_EQ(counters(desk.board), stopped);
}

TEST(Board, PausesHomingAtAnUnknownCodeUntilIdle) {  // B9
  auto desk = fresh_desk();
  desk.send(command(Command::kHome));
  desk.wait(100ms);
  const auto before = counters(desk.board);
  desk.hold(command(kUnknown), 500ms);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_NEAR(counters(desk.board)[j], before[j], 1) << "J" << j + 1;
  }
  desk.hold(command(Command::kIdle), 100ms);
  EXPECT_LT(counters(desk.board)[0], before[0] - 190);  // -2050 steps/s
}

TEST(Board, AnswersEveryFrameOfABurstButActsOnTheLast) {  // B10
  auto desk = fresh_desk();
  const auto answers = desk.send(joined(command_bytes(100), command_bytes(255)));
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0][47], std::byte{0x64});
  EXPECT_EQ(answers[1][47], std::byte{0xFF});
  EXPECT_TRUE(same_bytes(as_vector(Bytes{answers[1]}.subspan(44, 2)), hex("00 00")));
  desk.hold(command(Command::kIdle), 100ms);
  EXPECT_THAT(speeds(desk.board), Each(0.0F));
  EXPECT_THAT(counters(desk.board), Each(0));
}

TEST(Board, HomesOverAndOverWhileHomeIsHeld) {  // B11
  auto board = board_with_pass(50);
  board.receive(at(0s), command_bytes(100));
  std::vector<std::int64_t> all_homed;
  // Close to the times of the reference every pass, else by larger strides.
  for (std::int64_t time = 0; time < 80'000'000;) {
    const bool is_near = std::abs(time - 32'322'700) < 5000 || std::abs(time - 64'495'500) < 5000;
    time += is_near ? 50 : 1000;
    board.advance_to(at(std::chrono::microseconds{time}));
    if (board.homing().homed() == 0xFC) all_homed.push_back(time);
  }
  EXPECT_THAT(all_homed,
              ElementsAre(testing::AllOf(testing::Ge(32'322'650), testing::Le(32'322'750)),
                          testing::AllOf(testing::Ge(64'495'450), testing::Le(64'495'550))));
}

TEST(Board, FollowsTheGoToLawInItsFirstPasses) {  // B12
  auto desk = fresh_desk();
  desk.send(go_to({100, -100, 1, -1, 3, 0}, {200, -200, 0, 0, -1, 0}));
  EXPECT_THAT(speeds(desk.board), Each(0.0F));
  desk.run(10us);
  EXPECT_THAT(speeds(desk.board), ElementsAre(5100, -5100, 50, -50, 149, 0));
  EXPECT_THAT(counters(desk.board), ElementsAre(1, -1, 1, -1, 1, 0));
  desk.run(10us);
  EXPECT_THAT(speeds(desk.board), ElementsAre(5050, -5050, 0, 0, 99, 0));
  EXPECT_THAT(counters(desk.board), ElementsAre(1, -1, 1, -1, 1, 0));
}

TEST(Board, TakesEachStepOfAGoToOnTime) {  // B13
  auto desk = fresh_desk();
  desk.send(go_to({100}));
  const auto start = desk.now;
  std::vector<std::int64_t> times(101);
  std::vector<float> before_step(101);
  for (std::int32_t last = 0; last < 100;) {
    const auto speed = speeds(desk.board)[0];
    desk.run(10us);
    if (counters(desk.board)[0] == last) continue;
    ++last;
    ASSERT_EQ(counters(desk.board)[0], last);
    times[static_cast<std::size_t>(last)] = (desk.now - start) / 1us;
    before_step[static_cast<std::size_t>(last)] = speed;
  }
  EXPECT_THAT(std::vector(times.begin() + 1, times.begin() + 6),
              ElementsAre(10, 220, 430, 640, 850));
  EXPECT_THAT(std::vector(times.begin() + 97, times.end()),
              ElementsAre(67'230, 73'900, 83'900, 103'900));
  EXPECT_THAT(std::vector(before_step.begin() + 97, before_step.end()),
              ElementsAre(200, 150, 100, 50));
}

TEST(Board, ClampsAJogAtFiftyThousand) {  // B14
  auto desk = fresh_desk(20);
  desk.send(command(Command::kJog, {60'000, -60'000}));
  desk.run(50ms);
  EXPECT_EQ(counters(desk.board)[0], 2500);
  EXPECT_EQ(counters(desk.board)[1], -2500);
  const auto answer = desk.send(command(Command::kJog));
  EXPECT_EQ(answer.speed[0], StepsPerSecond{50'000});
  EXPECT_EQ(answer.speed[1], StepsPerSecond{-50'000});
}

TEST(Board, RunsTheDemoAndKeepsItsLowerMaximumSpeeds) {  // B15
  Desk desk{board_with_pass(20)};
  desk.send(command(Command::kDemo));
  const auto is_back = [&] {
    return counters(desk.board) ==
           std::array<std::int32_t, kJointCount>{10240, -32000, 57905, 0, 0, 32000};
  };
  desk.wait(21'390ms);
  EXPECT_FALSE(is_back());
  desk.wait(20ms);
  EXPECT_TRUE(is_back());
  desk.wait(1s);
  EXPECT_TRUE(is_back()) << "stands still until the next idle frame";
  desk.send(command(Command::kJog, {20'000, 20'000, 20'000, 20'000, 20'000, 20'000}));
  desk.wait(10ms);
  EXPECT_THAT(desk.send(command(Command::kIdle)).speed,
              ElementsAre(StepsPerSecond{6000}, StepsPerSecond{4000}, StepsPerSecond{3500},
                          StepsPerSecond{3500}, StepsPerSecond{3500}, StepsPerSecond{7500}));
}

TEST(Board, AnswersDuringTheDemosSleepWhenItWakes) {
  // The first leg ends when J3, the slowest, is at 49812 (S10: 15.165 s at an ideal loop).
  Desk desk{board_with_pass(20)};
  desk.send(command(Command::kDemo));
  while (counters(desk.board)[2] != 49'812) desk.wait(1ms);
  const auto asleep = desk.now;
  desk.wait(500ms);
  const auto answer = desk.send(command(Command::kDemo));
  EXPECT_EQ(answer.position[2], Steps{49'813}) << "the second leg begins in the pass of the sleep";
  EXPECT_GT(desk.now - asleep, 1990ms);
  EXPECT_LE(desk.now - asleep, 2000ms);
}

TEST(Board, EndsThePassOfTheDemosSleepTwoSecondsAfterItBegan) {
  Desk desk{board_with_pass(20)};
  desk.send(command(Command::kDemo));
  while (counters(desk.board)[2] != 49'812) desk.run(20us);
  EXPECT_EQ(desk.board.wakes_at(), at(desk.now + 2s));
  desk.run(1'999'980us);
  EXPECT_EQ(counters(desk.board)[2], 49'812);
  desk.run(20us);
  EXPECT_EQ(counters(desk.board)[2], 49'813);
  EXPECT_EQ(desk.board.wakes_at(), std::nullopt);
}

TEST(Board, RunsTheDemoWhileDisabled) {
  Desk desk{board_with_pass(20)};
  desk.hold(command(Command::kDisable), 10ms);
  desk.send(command(Command::kDemo));
  desk.wait(1s);
  EXPECT_GT(counters(desk.board)[0], 0);
}

TEST(Board, StartsTheDemoAgainOnlyAfterIdle) {
  Desk desk{board_with_pass(20)};
  desk.send(command(Command::kDemo));
  desk.wait(22s);
  desk.send(command(kUnknown));
  desk.wait(1ms);
  desk.send(command(Command::kDemo));
  desk.wait(1s);
  EXPECT_EQ(counters(desk.board)[0], 10'240);
  desk.send(command(Command::kIdle));
  desk.wait(1ms);
  desk.send(command(Command::kDemo));
  desk.wait(1s);
  EXPECT_LT(counters(desk.board)[0], 10'240);
}

// Section 3.2 and 3.3.

TEST(Board, IsEnabledAtPowerUp) { EXPECT_TRUE(fresh_desk().board.is_enabled()); }

TEST(Board, RepeatsItsLastCommandUntilAnotherComes) {
  auto desk = fresh_desk(20);
  desk.send(command(Command::kJog, {1000}));
  desk.run(1h);
  EXPECT_EQ(counters(desk.board)[0], 3'600'000);
}

TEST(Board, IgnoresEveryCodeWithoutMeaning) {
  for (int code = 0; code <= 255; ++code) {
    const bool has_meaning =
        code == 69 || (code >= 100 && code <= 103) || code == 123 || code == 156 || code == 255;
    if (has_meaning) continue;
    auto desk = fresh_desk();
    desk.hold(command(Command{static_cast<std::uint8_t>(code)}, {1000, 1000, 1000}), 30ms);
    EXPECT_THAT(counters(desk.board), Each(0)) << code;
    EXPECT_THAT(speeds(desk.board), Each(0.0F)) << code;
  }
}

TEST(Board, SetsTheOutputsOfTheFrameThatItAnswers) {  // section 1.4
  auto desk = fresh_desk();
  for (int byte = 0; byte <= 255; ++byte) {
    auto frame = command(Command::kIdle);
    frame.in_out = static_cast<std::uint8_t>(byte);
    EXPECT_EQ(desk.send(frame).io, 0x0F | (byte & 0x30)) << byte;
    desk.wait(1ms);
  }
}

TEST(Board, IgnoresTheTimeout) {  // section 4.4
  auto desk = fresh_desk();
  auto jog = command(Command::kJog, {1000});
  jog.timeout = 1;
  desk.send(jog);
  desk.run(10s);
  EXPECT_EQ(counters(desk.board)[0], 10'000);
  EXPECT_EQ(desk.send(jog).timeout_error, 100);
}

TEST(Board, DelaysACommandToThePassBehindItsAnswer) {  // section 4.1
  auto desk = fresh_desk();
  EXPECT_EQ(desk.send(command(Command::kJog, {1000})).speed[0], StepsPerSecond{0});
  EXPECT_EQ(counters(desk.board)[0], 0);
  desk.run(10us);
  EXPECT_EQ(counters(desk.board)[0], 1);
  EXPECT_EQ(desk.send(command(Command::kJog, {1000})).position[0], Steps{1});
}

TEST(Board, RoundsStepIntervalsUpToWholePasses) {  // section 4.2
  struct Row {
    std::int32_t speed;
    std::array<std::int32_t, 5> steps;
  };
  constexpr std::array<std::uint32_t, 5> kPasses{1, 5, 10, 20, 50};
  for (const auto& [speed, steps] :
       {Row{1500, {1502, 1493, 1493, 1471, 1429}}, Row{3000, {3004, 2986, 2942, 2942, 2858}},
        Row{7000, {7043, 6897, 6667, 6251, 6667}}, Row{18000, {18182, 18182, 16667, 16667, 10001}},
        Row{50000, {50001, 50001, 50001, 50001, 20001}}}) {
    for (std::size_t i = 0; i < kPasses.size(); ++i) {
      auto desk = fresh_desk(kPasses[i]);
      desk.send(command(Command::kJog, {speed}));
      const auto first_pass = std::chrono::microseconds{kPasses[i]};
      desk.run(first_pass + 1s);
      EXPECT_EQ(counters(desk.board)[0], steps[i]) << speed << " at " << kPasses[i] << " us";
    }
  }
}

// Section 12.3, at the board.

TEST(Board, DoesNotAnswerWhatItsReceiverDrops) {
  const auto good = command_bytes(255);
  auto wrong_end = good;
  wrong_end[55] = std::byte{0x03};
  auto bad_check = good;
  bad_check[53] = std::byte{0x00};
  const auto answers = [](const ByteVector& bytes) { return fresh_desk().send(bytes).size(); };
  EXPECT_EQ(answers(bad_check), 1U);                                                    // R1
  EXPECT_EQ(answers(wrong_end), 0U);                                                    // R2
  EXPECT_EQ(answers(joined(wrong_end, good)), 1U);                                      // R2
  EXPECT_EQ(answers(joined(hex("FF"), good)), 0U);                                      // R3
  EXPECT_EQ(answers(joined(hex("FF"), good, zeros(203), good)), 1U);                    // R3
  EXPECT_EQ(answers(joined(hex("01 02 03 00 FF 07 FF FF 09"), good)), 1U);              // R8
  EXPECT_EQ(answers(joined(as_vector(Bytes{good}.first(30)), repeated(good, 3))), 2U);  // R9
  EXPECT_EQ(answers(joined(as_vector(Bytes{good}.subspan(1)), good)), 1U);              // R10
  EXPECT_EQ(answers(joined(hex("FF FF FF 00"), repeated(good, 12))), 0U);               // R11
  EXPECT_EQ(answers(joined(hex("FF FF FF 01 02"), good)), 1U);                          // R12
}

TEST(Board, ActsOnThePositionsThatAShortFrameLeaves) {  // R4, R5
  auto desk = fresh_desk();
  EXPECT_EQ(answer_to(desk, hex("FF FF FF 02 01 02"))[47], std::byte{0x00}) << "echo unchanged";
  // The next frame is too short to reach the command byte, so its echo is the one before it.
  desk.send(go_to({1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(answer_to(desk, hex("FF FF FF 03 09 01 02"))[47], std::byte{156});
  desk.wait(60s);
  EXPECT_THAT(counters(desk.board), ElementsAre(590'082, 2, 3, 4, 5, 6));
}

TEST(Board, LeavesTheTimeReferenceAloneWhenItDropsAFrame) {
  auto desk = fresh_desk();
  desk.send(command(Command::kIdle));
  desk.wait(5ms);
  auto wrong_end = command_bytes(255);
  wrong_end[55] = std::byte{0x03};
  EXPECT_TRUE(desk.send(wrong_end).empty());
  desk.wait(5ms);
  EXPECT_NEAR(desk.send(command(Command::kIdle)).timing, 7031, 1);
}

TEST(Board, TakesBytesHoweverTheyAreCut) {
  auto desk = fresh_desk();
  for (std::size_t i = 0; i < vectors::kJogCommand.size(); ++i) {
    desk.wait(130us);
    const auto answers = desk.send(ByteVector{vectors::kJogCommand[i]});
    EXPECT_EQ(answers.size(), i == 55 ? 1U : 0U) << i;
  }
}

TEST(Board, NeverSpeaksFirst) {
  auto board = board_with_pass(10);
  board.advance_to(at(10min));
  EXPECT_TRUE(board.sent().empty());
  EXPECT_EQ(board.next_event(), std::nullopt);
}

TEST(Board, TellsWhenItWillAnswer) {
  auto board = board_with_pass(20);
  board.receive(at(15us), command_bytes(255));
  EXPECT_EQ(board.next_event(), at(20us));
  board.advance_to(at(19us));
  EXPECT_TRUE(board.sent().empty());
  board.advance_to(at(20us));
  EXPECT_EQ(board.sent().size(), 2U);
  EXPECT_EQ(board.sent()[1].time, at(20us));
  EXPECT_EQ(board.next_event(), std::nullopt);
}

// The plant, touched from outside.

TEST(Board, ReportsThePressedStopAndGoesOn) {
  auto desk = fresh_desk();
  desk.send(command(Command::kJog, {1000}));
  desk.wait(100ms);
  desk.board.touch(at(desk.now), [](Plant& plant) { plant.inputs.estop = Level::kLow; });
  EXPECT_EQ(desk.send(command(Command::kJog, {1000})).io, 0x07);  // F10
  const auto before = counters(desk.board)[0];
  desk.wait(100ms);
  EXPECT_GT(counters(desk.board)[0], before + 95);
  desk.board.touch(at(desk.now), [](Plant& plant) { plant.inputs.estop = Level::kHigh; });
  EXPECT_EQ(desk.send(command(Command::kJog, {1000})).io, 0x0F);
}

TEST(Board, SamplesItsInputsWhenItAccepts) {
  auto desk = fresh_desk();
  const auto io_with = [&](Level in1, Level in2) {
    desk.wait(1ms);
    desk.board.touch(at(desk.now), [&](Plant& plant) {
      plant.inputs.in1 = in1;
      plant.inputs.in2 = in2;
    });
    return int{desk.send(command(Command::kIdle)).io};
  };
  EXPECT_EQ(io_with(Level::kLow, Level::kLow), 0x0F);
  EXPECT_EQ(io_with(Level::kHigh, Level::kLow), 0x8F);
  EXPECT_EQ(io_with(Level::kLow, Level::kHigh), 0x4F);
  EXPECT_EQ(io_with(Level::kHigh, Level::kHigh), 0xCF);
}

TEST(Board, DoesNotSeeAJointPushedByHand) {
  auto desk = fresh_desk();
  desk.board.touch(at(desk.now), [](Plant& plant) { plant.axes[0].position = Steps{5000}; });
  EXPECT_EQ(desk.send(command(Command::kIdle)).position[0], Steps{0});
  EXPECT_EQ(desk.board.plant().axes[0].position, Steps{5000});
}

/// Lets the board home for that long, J1 being tampered with after a second.
template <class Change>
Desk homing_with(Change change, Duration duration) {
  Desk desk{board_with_pass(10)};
  desk.send(command(Command::kHome));
  desk.wait(10ms);
  desk.hold(command(Command::kIdle), 1s);
  desk.board.touch(at(desk.now), [&](Plant& plant) { change(plant.axes[0]); });
  desk.hold(command(Command::kIdle), duration);
  return desk;
}

TEST(Homing, HitsTheSwitchLaterIfTheJointIsPushedAwayFromIt) {
  // Undisturbed, J1 hits after 6.615 s (6.6); 2050 steps are pushed, and one step takes 490 us.
  const auto push = [](Axis& axis) { axis.position = axis.position + Steps{2050}; };
  EXPECT_EQ(speeds(homing_with(push, 6'580ms).board)[0], -2050.0F);
  EXPECT_EQ(speeds(homing_with(push, 6'630ms).board)[0], 0.0F);
}

TEST(Homing, EndsAtTheSamePlaceAlthoughAJointWasPushed) {
  const auto push = [](Axis& axis) { axis.position = axis.position + Steps{2050}; };
  const auto desk = homing_with(push, 34s);
  EXPECT_EQ(desk.board.homing().homed(), 0xFC);
  EXPECT_EQ(desk.board.plant().axes[0].position, Steps{10'240});
}

TEST(Homing, TakesASwitchStuckClosedForTheRealOne) {
  const auto stick = [](Axis& axis) { axis.switch_state = Axis::SwitchState::kStuckClosed; };
  const auto desk = homing_with(stick, 34s);
  EXPECT_EQ(desk.board.homing().homed(), 0xFC);
  EXPECT_EQ(counters(desk.board)[0], 10'240);
  // After a second of seeking, backing off (850) and at once the second zero, then 13500 forward.
  const auto place = desk.board.plant().axes[0].position.value;
  EXPECT_NEAR(place, 10'240 - 2061 + 850 + 13'500, 5);
}

TEST(Homing, SeeksForEverWithASwitchStuckOpen) {
  const auto stick = [](Axis& axis) { axis.switch_state = Axis::SwitchState::kStuckOpen; };
  const auto desk = homing_with(stick, 60s);
  EXPECT_EQ(desk.board.homing().homed(), 0);
  EXPECT_EQ(speeds(desk.board)[0], -2050.0F);
  EXPECT_LT(desk.board.plant().axes[0].position, Steps{-100'000});
}

TEST(Homing, SeeksForEverWithAJammedAxisThatLosesItsSteps) {
  const auto jam = [](Axis& axis) { axis.is_jammed = true; };
  const auto desk = homing_with(jam, 60s);
  EXPECT_EQ(desk.board.homing().homed(), 0);
  EXPECT_LT(counters(desk.board)[0], -100'000);
  EXPECT_GT(desk.board.plant().axes[0].position, Steps{8000});
}

TEST(Board, LosesAllButThePlantWhenRebooted) {
  auto desk = homed_desk();
  auto out = command(Command::kJog, {1000});
  out.in_out = io_flag::kOut1;
  desk.send(out);
  desk.wait(100ms);
  const auto plant = desk.board.plant();
  desk.board.reboot(at(desk.now));
  EXPECT_EQ(desk.board.plant(), plant);
  EXPECT_EQ(desk.board.outputs(), 0);
  const auto rebooted = desk.now;
  desk.wait(100ms);
  const auto answer = desk.send(command(Command::kIdle));
  EXPECT_EQ(desk.now - rebooted, 740ms) << "whatever arrives waits for the start-up";
  EXPECT_THAT(answer.position, Each(Steps{0}));
  EXPECT_EQ(answer.homed, 0x03);
  EXPECT_EQ(answer.timing, 0) << "the first interval counts from the start of the timer";
  EXPECT_EQ(answer.io, 0x8F);
  desk.wait(1s);
  EXPECT_EQ(desk.board.plant(), plant) << "nothing moves any more";
}

// Section 6.6.

struct Timeline {
  std::uint32_t pass_us;
  double done;
};

class HomingTimeline : public testing::TestWithParam<Timeline> {};

TEST_P(HomingTimeline, EndsWhenTheFirmwareEnds) {
  Desk desk{board_with_pass(GetParam().pass_us)};
  desk.send(command(Command::kHome));
  desk.wait(10ms);
  desk.hold(command(Command::kIdle), std::chrono::milliseconds{30'500 - 20});
  while (desk.board.homing().homed() != 0xFC && desk.now < 40s) {
    desk.send(command(Command::kIdle));
    desk.wait(100us);
  }
  const auto done = std::chrono::duration<double>(desk.now).count();
  EXPECT_NEAR(done, GetParam().done, 0.0006);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(desk.board.plant().axes[j].position, kHomingTable[j].standby) << "J" << j + 1;
  }
}

std::string pass_of(const testing::TestParamInfo<Timeline>& timeline) {
  return "Pass" + std::to_string(timeline.param.pass_us) + "us";
}
INSTANTIATE_TEST_SUITE_P(Reference, HomingTimeline,
                         testing::Values(Timeline{5, 30.563}, Timeline{10, 30.849},
                                         Timeline{20, 31.262}, Timeline{50, 32.323}),
                         pass_of);

TEST(Homing, HitsEachSwitchWhenTheFirmwareDoes) {
  Desk desk{board_with_pass(10)};
  desk.send(command(Command::kHome));
  // When a joint left its seek speed for the first time, and its slow seek speed.
  std::array<double, kJointCount> hit{};
  std::array<double, kJointCount> second_hit{};
  auto last_speeds = speeds(desk.board);
  while (desk.now < 31s) {
    desk.wait(100us);
    if (desk.now % 10ms == 0ns) desk.send(command(Command::kIdle));
    const auto seconds = std::chrono::duration<double>(desk.now).count();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto before = std::exchange(last_speeds[j], speeds(desk.board)[j]);
      if (last_speeds[j] == before) continue;
      if (before == kHomingTable[j].seek_speed.value && hit[j] == 0.0) hit[j] = seconds;
      if (before == kHomingTable[j].slow_seek_speed.value) second_hit[j] = seconds;
    }
  }
  const auto near = [](double time) { return testing::DoubleNear(time, 0.0006); };
  EXPECT_THAT(hit, ElementsAre(near(6.615), near(7.835), near(9.208), near(18.138), near(26.644),
                               near(21.761)));
  EXPECT_THAT(second_hit, ElementsAre(near(10.860), near(11.129), near(11.129), near(18.913),
                                      near(27.419), near(22.350)));
}

TEST(Homing, ReportsTheHomedJointsGroupByGroup) {  // sections 6.4 and 6.6
  Desk desk{board_with_pass(10)};
  desk.send(command(Command::kHome));
  desk.wait(10ms);
  std::vector<std::pair<int, Duration>> changes{{0x03, 0s}};
  while (desk.now < 32s) {
    const int homed = desk.send(command(Command::kIdle)).homed;
    if (changes.back().first != homed) changes.emplace_back(homed, desk.now);
    desk.wait(10ms);
  }
  EXPECT_THAT(changes, ElementsAre(Pair(0x03, 0s), Pair(0xE3, 16'310ms), Pair(0xF3, 21'660ms),
                                   Pair(0xFF, 30'850ms)));
}

TEST(Homing, SetsTheSeekSpeedsOfAllJointsInItsFirstPass) {  // section 6.1
  Desk desk{board_with_pass(10)};
  desk.send(command(Command::kHome));
  desk.run(10us);
  EXPECT_THAT(speeds(desk.board), ElementsAre(-2050, -2550, -2550, 5550, -5050, -9550));
}

// Section 12.8.

CommandFrame gripper_frame(std::uint8_t id, std::uint8_t mode, std::int16_t position = 0) {
  auto frame = command(Command::kIdle);
  frame.gripper.id = id;
  frame.gripper.mode = mode;
  frame.gripper.position = position;
  return frame;
}

CanFrame can_frame(std::uint16_t id, const ByteVector& data) {
  CanFrame frame{.id = id, .size = static_cast<std::uint8_t>(data.size()), .data = {}};
  std::ranges::copy(data, frame.data.begin());
  return frame;
}

TEST(BoardCan, SendsTheLowBitsOfTheGripperIdButComparesAll) {  // G1
  auto desk = fresh_desk();
  for (const int mode : {1, 2, 0}) {
    desk.send(gripper_frame(0x14, static_cast<std::uint8_t>(mode)));
    desk.wait(10ms);
  }
  EXPECT_THAT(desk.can,
              ElementsAre(can_frame(0x27C, {}), can_frame(0x202, {}), can_frame(0x27A, {})));
  desk.board.receive_can(at(desk.now), can_frame(0x278, hex("77 FF 38 E1")));
  EXPECT_EQ(desk.send(gripper_frame(0x14, 0)).gripper.position, 0) << "4 is not 20";
}

TEST(BoardCan, TakesTheAnswersOfItsOwnGripper) {  // G2
  auto desk = fresh_desk();
  for (const int mode : {1, 0, 2}) {
    desk.send(gripper_frame(2, static_cast<std::uint8_t>(mode)));
    desk.wait(10ms);
  }
  EXPECT_THAT(desk.can,
              ElementsAre(can_frame(0x17C, {}), can_frame(0x17A, {}), can_frame(0x102, {})));
  desk.board.receive_can(at(desk.now), can_frame(0x1F8, hex("11 22 33 44")));  // node 3
  desk.wait(1ms);
  EXPECT_EQ(desk.send(gripper_frame(2, 0)).gripper.position, 0);
  desk.board.receive_can(at(desk.now), can_frame(0x178, hex("77 FF 38 E1")));
  desk.wait(1ms);
  EXPECT_EQ(desk.send(gripper_frame(2, 0)).gripper, (GripperReport{.id = 0,
                                                                   .position = 119,
                                                                   .speed = 1,
                                                                   .current = Milliamperes{-200},
                                                                   .status = 0xE1,
                                                                   .object_detection = 1}));
}

TEST(BoardCan, ForgetsSetPointsThatCameWithACalibration) {  // G3
  auto desk = fresh_desk();
  desk.send(gripper_frame(0, 1, 120));
  desk.wait(10ms);
  desk.send(gripper_frame(0, 0, 120));
  EXPECT_THAT(desk.can, ElementsAre(can_frame(0x07C, {}), can_frame(0x07A, {})));
}

TEST(BoardCan, SendsSetPointsThatDifferAndCutsThemToOneByte) {  // F7, section 8.2
  auto desk = fresh_desk();
  desk.send(vectors::kGripperCommand);
  EXPECT_THAT(desk.can, ElementsAre(can_frame(0x2FA, hex("2C 00 FF FE D0"))));
}

TEST(BoardCan, SendsSetPointsInEveryFrameOfAnUnknownMode) {  // section 8.2
  auto desk = fresh_desk();
  for (int i = 0; i < 3; ++i) {
    desk.send(gripper_frame(0, 3, 7));
    desk.wait(10ms);
  }
  const auto set_point = can_frame(0x07A, hex("07 00 00 00 00"));
  EXPECT_THAT(desk.can, ElementsAre(set_point, set_point, set_point));
}

TEST(BoardCan, TakesOneFrameInAPass) {  // section 8.3
  auto desk = fresh_desk();
  desk.board.receive_can(at(desk.now), can_frame(0x078, hex("01 00 00 00")));
  desk.board.receive_can(at(desk.now), can_frame(0x078, hex("02 00 00 00")));
  desk.board.receive(at(desk.now), command_bytes(255));
  desk.board.receive(at(desk.now + 10us), command_bytes(255));
  desk.board.advance_to(at(desk.now + 10us));
  std::vector<int> positions;
  for (const auto& emission : desk.board.sent()) {
    if (const auto* bytes = std::get_if<TelemetryBytes>(&emission.what)) {
      positions.push_back(decode_telemetry(body_of(*bytes)).gripper.position);
    }
  }
  EXPECT_THAT(positions, ElementsAre(1, 2));
}

TEST(BoardCan, IgnoresAnswersOfOtherLengthsAndTheErrorBit) {  // section 8.3
  auto desk = fresh_desk();
  const auto position_after = [&](const CanFrame& frame) {
    desk.board.receive_can(at(desk.now), frame);
    desk.wait(1ms);
    return int{desk.send(command(Command::kIdle)).gripper.position};
  };
  EXPECT_EQ(position_after(can_frame(0x078, hex("11 00 00"))), 0);
  EXPECT_EQ(position_after(can_frame(0x078, hex("11 00 00 00 00"))), 0);
  EXPECT_EQ(position_after(can_frame(0x07A, hex("11 00 00 00"))), 0);
  EXPECT_EQ(position_after(can_frame(0x079, hex("11 00 00 00"))), 0x11);
}

}  // namespace
}  // namespace armjig::parol6::emulation
