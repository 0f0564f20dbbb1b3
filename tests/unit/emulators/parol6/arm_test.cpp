// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/arm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "harness/link/memory_stream.hpp"
#include "tests/unit/emulators/parol6/desk.hpp"
#include "tests/unit/support/allocations.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig::parol6::emulation {
namespace {

using test::ByteVector;
using testing::Each;
using namespace std::chrono_literals;

constexpr GripperReport kBeforeAnyAnswer{.id = 0,
                                         .position = 0,
                                         .speed = 1,
                                         .current = Milliamperes{2},
                                         .status = 0x01,
                                         .object_detection = 1};

TelemetryFrame decoded(const SentBytes& sent) {
  EXPECT_EQ(sent.bytes.size(), kTelemetryFrameSize);
  return decode_telemetry(body_of(Bytes{sent.bytes}.first<kTelemetryFrameSize>()));
}

/// Sends a frame at `time` and waits for its answer.
TelemetryFrame exchange(Arm& arm, Duration time, const CommandFrame& frame) {
  arm.receive(at(time), encode(frame));
  while (const auto event = arm.next_event()) {
    if (*event > at(time + 3s)) break;
    arm.advance_to(*event);
  }
  EXPECT_EQ(arm.sent().size(), 1U);
  const auto answer = arm.sent().empty() ? TelemetryFrame{} : decoded(arm.sent().front());
  arm.clear_sent();
  return answer;
}

/// Repeats a frame every 10 ms. The last answer.
TelemetryFrame hold(Arm& arm, Duration& now, Duration duration, const CommandFrame& frame) {
  TelemetryFrame answer;
  for (const auto end = now + duration; now < end; now += 10ms) answer = exchange(arm, now, frame);
  return answer;
}

CommandFrame gripper(std::uint8_t mode, std::int16_t position = 0, std::uint8_t flags = 0xC0) {
  auto frame = command(Command::kIdle);
  frame.gripper = {.position = position,
                   .speed = 60,
                   .current = Milliamperes{500},
                   .command = flags,
                   .mode = mode,
                   .id = 0};
  return frame;
}

TEST(Arm, ReportsItsGripperFromTheSecondFrameOn) {
  Arm arm;
  EXPECT_EQ(exchange(arm, 10ms, command(Command::kIdle)).gripper, kBeforeAnyAnswer);
  const auto answered = exchange(arm, 20ms, command(Command::kIdle)).gripper;
  EXPECT_EQ(answered.status, 0x00) << "a fresh gripper is not calibrated";
  EXPECT_EQ(answered.current, Milliamperes{0});
}

TEST(Arm, TakesTheAnswerInThePassInWhichItArrives) {
  // The poll leaves in the pass at 10 ms; its answer is there 123 us later, in the pass at 10.13.
  for (const auto& [time, status] : {std::pair{10'120us, 0x01}, std::pair{10'130us, 0x00}}) {
    Arm arm;
    arm.receive(at(10ms), encode(command(Command::kIdle)));
    arm.receive(at(time), encode(command(Command::kIdle)));
    arm.advance_to(at(20ms));
    ASSERT_EQ(arm.sent().size(), 2U);
    EXPECT_EQ(arm.sent()[1].time, at(time));
    EXPECT_EQ(decoded(arm.sent()[1]).gripper.status, status) << time / 1us;
  }
}

TEST(Arm, ReportsNothingWithoutAGripper) {
  Arm arm{ArmOptions{.gripper = std::nullopt}};
  Duration now = 10ms;
  EXPECT_EQ(hold(arm, now, 1s, command(Command::kIdle)).gripper, kBeforeAnyAnswer);
  arm.touch_gripper(at(now), {});
  EXPECT_FALSE(arm.gripper());
}

TEST(Arm, CalibratesAndMovesItsGripperOverTheCable) {
  Arm arm;
  Duration now = 10ms;
  exchange(arm, now, gripper(1));
  now += 10ms;
  EXPECT_EQ(hold(arm, now, 3s, gripper(0)).gripper.status, 0x01)
      << "calibrated; the set-points that came with the calibration never went out";
  hold(arm, now, 1s, gripper(0, 120));
  EXPECT_EQ(hold(arm, now, 1s, gripper(0, 120)).gripper, (GripperReport{.id = 0,
                                                                        .position = 119,
                                                                        .speed = 1,
                                                                        .current = Milliamperes{0},
                                                                        .status = 0xF1,
                                                                        .object_detection = 1}));
}

TEST(Arm, GripsAnObject) {
  GripperOptions options;
  options.is_calibrated = true;
  Arm arm{ArmOptions{.gripper = options}};
  Duration now = 10ms;
  hold(arm, now, 100ms, gripper(0, 0));
  arm.touch_gripper(at(now), GripperPlant{.stop_closing = 100, .stop_opening = std::nullopt});
  const auto report = hold(arm, now, 1s, gripper(0, 255)).gripper;
  EXPECT_EQ(report.position, 99);
  EXPECT_EQ(report.current, Milliamperes{-500});
  EXPECT_EQ(report.status, 0xE1);
}

TEST(Arm, AnswersToItsNodeOnly) {
  GripperOptions options;
  options.node = 2;
  Arm arm{ArmOptions{.gripper = options}};
  Duration now = 10ms;
  EXPECT_EQ(hold(arm, now, 100ms, gripper(0)).gripper, kBeforeAnyAnswer);
  auto second = gripper(0);
  second.gripper.id = 2;
  EXPECT_EQ(hold(arm, now, 100ms, second).gripper.status, 0xC0);
}

TEST(Arm, TakesAFrameOfAnotherOnTheCan) {
  Arm arm;
  EXPECT_TRUE(arm.set_input(at(1ms), "can.data", 0x0102030400000000));
  EXPECT_TRUE(arm.set_input(at(1ms), "can.frame", 16 * 120 + 4));
  EXPECT_TRUE(arm.set_input(at(1ms), "can.frame", 16 * 0x7FF + 8));
  EXPECT_FALSE(arm.set_input(at(1ms), "can.frame", 16 * 0x800)) << "a standard identifier";
  EXPECT_FALSE(arm.set_input(at(1ms), "can.frame", 16 * 120 + 9)) << "eight bytes at most";
  EXPECT_FALSE(arm.set_input(at(1ms), "can.frame", -1));
}

TEST(Arm, OutlivesTheSleepOfTheDemo) {
  // A host that goes on polling while the board sleeps for 2 s gets all its answers at the end.
  Arm arm{ArmOptions{.timing = {.pass_period = std::chrono::microseconds{20}}}};
  Duration now{};
  std::vector<Duration> answers;
  for (; now < 25s; now += 10ms) {
    arm.receive(at(now), encode(command(Command::kDemo)));
    for (const auto& sent : arm.sent()) answers.push_back(sent.time.time_since_epoch());
    arm.clear_sent();
  }
  arm.advance_to(at(now));
  for (const auto& sent : arm.sent()) answers.push_back(sent.time.time_since_epoch());
  EXPECT_EQ(answers.size(), 2500U);
  EXPECT_TRUE(std::ranges::is_sorted(answers));
  Duration longest{};
  for (std::size_t i = 1; i < answers.size(); ++i) {
    longest = std::max(longest, answers[i] - answers[i - 1]);
  }
  EXPECT_GT(longest, 1990ms);
  EXPECT_LE(longest, 2010ms);
  EXPECT_EQ(counters(arm.board())[2], 57'905);
  EXPECT_EQ(decoded(arm.sent().back()).gripper.status, 0x00) << "and hears its gripper again";
}

TEST(Arm, IsTheSameHoweverTimeIsCut) {
  GripperOptions options;
  options.is_calibrated = true;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Dice dice{seed};
    Arm whole{ArmOptions{.gripper = options}};
    auto cut = whole;
    Duration now{};
    Duration last{};
    for (int i = 0; i < 200; ++i) {
      const auto flags = dice.one_in(10) ? 0xE0 : 0xC0;
      auto frame = gripper(static_cast<std::uint8_t>(dice.one_in(15) ? dice.between(1, 3) : 0),
                           static_cast<std::int16_t>(dice.between(0, 3) * 85),
                           static_cast<std::uint8_t>(flags));
      frame.command = dice.one_in(2) ? Command::kJog : Command::kHome;
      now += std::chrono::microseconds{dice.one_in(3) ? dice.between(0, 200)
                                                      : dice.between(200, 300'000)};
      while (last < now) {
        last = std::min(now, last + Duration{dice.between(1, 5'000'000)});
        cut.advance_to(at(last - Duration{1}));
      }
      whole.receive(at(now), encode(frame));
      cut.receive(at(now), encode(frame));
    }
    whole.advance_to(at(now + 1s));
    cut.advance_to(at(now + 1s));
    ASSERT_EQ(cut.sent().size(), whole.sent().size());
    ASSERT_EQ(whole.sent().size(), 200U);
    for (std::size_t i = 0; i < whole.sent().size(); ++i) {
      ASSERT_EQ(cut.sent()[i].time, whole.sent()[i].time);
      ASSERT_TRUE(test::same_bytes(cut.sent()[i].bytes, whole.sent()[i].bytes)) << "seed " << seed;
    }
  }
}

TEST(Arm, GoesOnFromASnapshotAsFromItself) {
  Arm arm;
  Duration now = 10ms;
  exchange(arm, now, gripper(1));
  now += 10ms;
  hold(arm, now, 1s, command(Command::kHome));
  auto snapshot = arm;
  auto later = now;
  for (int i = 0; i < 300; ++i) {
    ASSERT_EQ(hold(arm, now, 10ms, command(Command::kIdle)),
              hold(snapshot, later, 10ms, command(Command::kIdle)));
  }
}

TEST(Arm, CanBeTouched) {
  Arm arm;
  arm.touch(at(5ms), [](Plant& plant) { plant.inputs.estop = Level::kLow; });
  EXPECT_EQ(exchange(arm, 10ms, command(Command::kIdle)).io, 0x07);
  arm.touch(at(15ms), [](Plant& plant) { plant.axes[3].position = Steps{77}; });
  EXPECT_EQ(arm.board().plant().axes[3].position, Steps{77});
}

TEST(Arm, LosesItsStateButNotItsPlaceWhenRebooted) {
  GripperOptions options;
  options.position = 200;
  Arm arm{ArmOptions{.gripper = options}};
  Duration now = 10ms;
  exchange(arm, now, gripper(1));
  now += 10ms;
  hold(arm, now, 4s, command(Command::kJog, {1000}));
  arm.advance_to(at(now));
  const auto axis = arm.board().plant().axes[0];
  EXPECT_EQ(arm.gripper()->position_byte(), 255);
  EXPECT_TRUE(arm.gripper()->is_calibrated());
  arm.reboot(at(now));
  EXPECT_EQ(arm.board().plant().axes[0], axis);
  EXPECT_EQ(arm.gripper()->position_byte(), 255);
  EXPECT_FALSE(arm.gripper()->is_calibrated());
  const auto answer = exchange(arm, now + 1s, command(Command::kIdle));
  EXPECT_THAT(answer.position, Each(Steps{0}));
  EXPECT_EQ(answer.gripper, kBeforeAnyAnswer);
}

TEST(Arm, AnswersOnAStreamInMemory) {
  MemoryStream<Arm> stream{Arm{}};
  ASSERT_TRUE(stream.write(vectors::kIdleCommand));
  std::array<std::byte, 100> bytes{};
  const auto size = stream.read(bytes, at(1s));
  ASSERT_TRUE(size);
  EXPECT_EQ(*size, kTelemetryFrameSize);
  EXPECT_EQ(stream.now(), at(0s)) << "in the pass of that moment";
  EXPECT_EQ(*stream.read(bytes, at(2s)), 0U);
  EXPECT_EQ(stream.now(), at(2s));
}

// The heap, in virtual time.

constexpr std::size_t kMebibyte = 1 << 20;

/// How much more is in use after something is done than before.
template <class Deed>
std::size_t growth(Deed deed) {
  const auto before = test::bytes_in_use();
  deed();
  const auto after = test::bytes_in_use();
  return after > before ? after - before : 0;
}

TEST(Heap, GrowsLittleInAWeekOfIdleAndJog) {
  constexpr auto kWeek = 7 * 24h;
  for (const auto code : {Command::kIdle, Command::kJog}) {
    Arm arm;
    EXPECT_LT(growth([&] {
                for (Duration now = 10s; now < kWeek; now += 10s) {
                  exchange(arm, now, command(code, {3000, 3000, 3000, 3000, 3000, 3000}));
                }
              }),
              kMebibyte);
  }
}

TEST(Heap, GrowsLittleInAWeekOfSilence) {
  Arm arm;
  exchange(arm, 10ms, command(Command::kJog, {50'000, -50'000}));
  EXPECT_LT(growth([&] { arm.advance_to(at(7 * 24h)); }), kMebibyte);
}

TEST(Heap, IsNotTouchedByABoardThatIsPolledAt100Hz) {
  auto board = board_with_pass(10);
  const auto bytes = encode(command(Command::kJog, {3000, 3000}));
  const auto poll = [&](Duration time) {
    board.receive(at(time), bytes);
    board.advance_to(at(time));
    EXPECT_EQ(board.sent().size(), 2U);
    board.clear_sent();
  };
  poll(0ms);
  const auto before = test::allocations();
  for (Duration now = 10ms; now < 10min; now += 10ms) poll(now);
  EXPECT_EQ(test::allocations(), before);
}

TEST(Heap, GrowsLittleUnderAFloodOfPolls) {
  // Three Mbit/s of the shortest frame that is accepted, far more than the CAN can carry.
  ByteVector burst;
  for (int i = 0; i < 50; ++i) burst = test::joined(std::move(burst), test::hex("FFFFFF020102"));
  Arm arm;
  EXPECT_LT(growth([&] {
              for (Duration now = 1ms; now < 10s; now += 1ms) {
                arm.receive(at(now), burst);
                arm.advance_to(at(now));
                EXPECT_EQ(arm.sent().size(), 50U);
                arm.clear_sent();
              }
            }),
            kMebibyte);
}

}  // namespace
}  // namespace armjig::parol6::emulation
