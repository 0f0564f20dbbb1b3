// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/gripper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

#include "tests/unit/support/bytes.hpp"

namespace armjig::parol6::emulation {
namespace {

using test::ByteVector;
using test::hex;
using namespace std::chrono_literals;

CanFrame frame(GripperCan command, const ByteVector& data = {}, std::uint8_t node = 0) {
  CanFrame frame{
      .id = can_id(node, command), .size = static_cast<std::uint8_t>(data.size()), .data = {}};
  std::ranges::copy(data, frame.data.begin());
  return frame;
}

/// What an answer says.
struct Answer {
  int position{};
  int current{};
  int status{};
  bool has_error{};

  friend bool operator==(const Answer&, const Answer&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Answer& answer) {
    return out << "position " << answer.position << ", " << answer.current << " mA, status "
               << std::hex << answer.status << std::dec << (answer.has_error ? ", error" : "");
  }
};

/// A gripper and what the board would send it. `now` goes forward only.
class Can {
 public:
  explicit Can(const GripperOptions& options = {}) : gripper{options} {}

  void wait(Duration duration) {
    now += duration;
    gripper.advance_to(at(now));
  }
  void send(const CanFrame& request) {
    gripper.receive(at(now), request);
    wait(1ms);
  }
  /// One request that must have one answer.
  Answer ask(const CanFrame& request) {
    gripper.clear_sent();
    send(request);
    EXPECT_EQ(gripper.sent().size(), 1U);
    if (gripper.sent().size() != 1) return {};
    const auto& reply = gripper.sent().front().frame;
    EXPECT_EQ(can_command(reply.id), GripperCan::kAnswer);
    EXPECT_EQ(reply.size, 4);
    const auto data = std::span{reply.data};
    return {.position = std::to_integer<int>(data[0]),
            .current = load_i16_be(data.subspan<1, 2>()),
            .status = std::to_integer<int>(data[3]),
            .has_error = (reply.id & kCanErrorBit) != 0};
  }
  Answer poll() { return ask(frame(GripperCan::kSetPoint)); }
  Answer move(int position, int speed, int current, int command = 0xD0) {
    ByteVector data;
    for (const auto value : {position, speed, current >> 8, current, command}) {
      data.push_back(static_cast<std::byte>(value));
    }
    return ask(frame(GripperCan::kSetPoint, data));
  }

  Gripper gripper;
  Duration now{};
};

constexpr GripperOptions kCalibrated{.node = 0, .position = 0, .is_calibrated = true, .plant = {}};

GripperOptions with_object(std::optional<std::uint8_t> closing,
                           std::optional<std::uint8_t> opening = std::nullopt,
                           std::uint8_t position = 0) {
  auto options = kCalibrated;
  options.position = position;
  options.plant.stop_closing = closing;
  options.plant.stop_opening = opening;
  return options;
}

// On the bus, section 8.1.

TEST(Gripper, AnswersEverySetPointFrameWhateverItsLength) {
  for (std::size_t size = 0; size <= 8; ++size) {
    Can can;
    can.send(frame(GripperCan::kSetPoint, test::zeros(size)));
    ASSERT_EQ(can.gripper.sent().size(), 1U) << size;
    EXPECT_EQ(can.gripper.sent()[0].frame.id, 0x078) << size;
  }
}

TEST(Gripper, AnswersNothingElse) {
  Can can;
  can.send(frame(GripperCan::kCalibrate));
  can.send(frame(GripperCan::kClearError));
  can.send(frame(GripperCan::kAnswer, hex("00 00 00 00")));
  can.send(frame(GripperCan{7}));
  EXPECT_TRUE(can.gripper.sent().empty());
}

TEST(Gripper, AnswersToItsNodeOnly) {  // G2: node 2 answers with 178
  auto options = kCalibrated;
  options.node = 2;
  Can can{options};
  can.send(frame(GripperCan::kSetPoint, {}, 3));
  can.send(frame(GripperCan::kCalibrate, {}, 3));
  EXPECT_TRUE(can.gripper.sent().empty());
  EXPECT_TRUE(can.gripper.is_calibrated());
  can.send(frame(GripperCan::kSetPoint, {}, 2));
  ASSERT_EQ(can.gripper.sent().size(), 1U);
  EXPECT_EQ(can.gripper.sent()[0].frame.id, 0x178);
}

TEST(Gripper, AnswersAfterTheTimeOnTheBus) {
  // At 1 Mbit/s: a request of 44 bits and its data, 3 bits of pause, an answer of 44 + 32 bits.
  const auto answered = [](std::size_t size) {
    Gripper gripper;
    gripper.receive(at(1s), frame(GripperCan::kSetPoint, test::zeros(size)));
    const auto next = gripper.next_event();
    gripper.advance_to(*next - 1ns);
    EXPECT_TRUE(gripper.sent().empty());
    EXPECT_EQ(gripper.next_event(), next);
    gripper.advance_to(*next);
    EXPECT_EQ(gripper.sent().size(), 1U);
    EXPECT_EQ(gripper.sent()[0].time, *next);
    EXPECT_EQ(gripper.next_event(), std::nullopt);
    return *next - at(1s);
  };
  EXPECT_EQ(answered(0), 123us);
  EXPECT_EQ(answered(5), 163us);
}

TEST(Gripper, ReadsARequestWhenItIsWhole) {
  Gripper gripper{kCalibrated};
  gripper.receive(at(0s), frame(GripperCan::kSetPoint, hex("FF FF 01 F4 D0")));
  gripper.advance_to(at(83us));
  EXPECT_EQ(gripper.status(), 0x01);
  gripper.advance_to(at(84us));
  EXPECT_EQ(gripper.status(), 0xC1);
}

TEST(Gripper, LetsARequestWaitForAFreeBus) {
  Gripper gripper;
  gripper.receive(at(0us), frame(GripperCan::kSetPoint));   // 0 to 44, answer 47 to 123
  gripper.receive(at(50us), frame(GripperCan::kSetPoint));  // 126 to 170, answer 173 to 249
  gripper.advance_to(at(1ms));
  ASSERT_EQ(gripper.sent().size(), 2U);
  EXPECT_EQ(gripper.sent()[0].time, at(123us));
  EXPECT_EQ(gripper.sent()[1].time, at(249us));
}

TEST(Gripper, MissesWhatTheBoardWritesIntoAFullMailbox) {
  Can can{kCalibrated};
  can.gripper.receive(at(0us), frame(GripperCan::kSetPoint));
  can.gripper.receive(at(43us), frame(GripperCan::kSetPoint, hex("FF FF 01 F4 D0")));
  can.wait(1ms);
  EXPECT_EQ(can.gripper.sent().size(), 1U);
  EXPECT_EQ(can.gripper.status(), 0x01) << "the set-points are lost";
}

// Positions and speeds, section 8.6.

TEST(Gripper, ReportsOneLessThanAskedBecauseBothMapsAreInWholeNumbers) {
  // Counts 10329 - trunc(n * 10558 / 255), back trunc(counts * 255 / 10558): exact only at the
  // ends. The example of section 1.6 has 119 for 120.
  Can can{kCalibrated};
  for (const auto& [asked, reported] : std::initializer_list<std::pair<int, int>>{
           {120, 119}, {0, 0}, {255, 255}, {1, 0}, {254, 253}, {128, 127}, {51, 50}}) {
    can.move(asked, 255, 500);
    can.wait(1s);
    EXPECT_EQ(can.poll().position, reported) << asked;
  }
}

TEST(Gripper, ReachesTheCountsOfTheMap) {
  Can can{kCalibrated};
  EXPECT_EQ(can.gripper.position(), EncoderCounts{10'329});
  can.move(255, 255, 500);
  can.wait(1s);
  EXPECT_EQ(can.gripper.position(), EncoderCounts{-229});
  can.move(120, 255, 500);  // 10329 - trunc(4968.47)
  can.wait(1s);
  EXPECT_EQ(can.gripper.position(), EncoderCounts{5361});
}

TEST(Gripper, MovesAtTheSpeedOfTheMap) {
  // Byte 60: 60 * 79960 / 255 + 40 = 18854 counts/s. The request is there after 84 us, so all of
  // the 500 interrupts of the first 100 ms move: 10329 - 1885.4.
  const auto place_after_100_ms = [](int speed) {
    Can can{kCalibrated};
    can.move(255, speed, 500);
    can.gripper.advance_to(at(100ms));
    return can.gripper.position();
  };
  EXPECT_EQ(place_after_100_ms(60), EncoderCounts{8443});
  EXPECT_EQ(place_after_100_ms(0), EncoderCounts{10'325});  // 40 counts/s
  EXPECT_EQ(place_after_100_ms(255), EncoderCounts{2329});  // 80000 counts/s
  EXPECT_EQ(place_after_100_ms(40), EncoderCounts{9070});   // 12582 counts/s: 9070.8
}

TEST(Gripper, GoesAllTheWayInHalfASecondAtSpeed60) {
  Can can{kCalibrated};
  can.move(255, 60, 500);
  can.wait(558ms);
  EXPECT_EQ(can.poll().status, 0xC1) << "on its way";
  can.wait(1ms);
  EXPECT_EQ(can.poll(),
            (Answer{.position = 255, .current = 0, .status = 0xF1, .has_error = false}));
}

TEST(Gripper, DoesNotMoveUnlessCalibratedActivatedAndToldToGo) {
  const auto moves = [](const GripperOptions& options, int command) {
    Can can{options};
    can.move(255, 255, 500, command);
    can.wait(1s);
    return can.gripper.position() != EncoderCounts{10'329};
  };
  EXPECT_TRUE(moves(kCalibrated, 0xC0));
  EXPECT_FALSE(moves({}, 0xC0));
  EXPECT_FALSE(moves(kCalibrated, 0x80));
  EXPECT_FALSE(moves(kCalibrated, 0x40));
  EXPECT_FALSE(moves(kCalibrated, 0x00));
}

TEST(Gripper, EchoesActivationAndActionInItsStatus) {
  Can can{kCalibrated};
  EXPECT_EQ(can.poll().status, 0x01);
  EXPECT_EQ(can.move(0, 0, 500, 0x80).status, 0x81);
  EXPECT_EQ(can.move(0, 0, 500, 0x40).status, 0x41);
  EXPECT_EQ(can.move(9, 0, 500, 0xC0).status, 0xC1);
  Can fresh;
  EXPECT_EQ(fresh.move(9, 0, 500, 0xD0).status, 0xC0) << "not calibrated";
}

TEST(Gripper, GoesToSleepWhereItIsWhenToldNotToGo) {
  Can can{kCalibrated};
  can.move(255, 60, 500);
  can.wait(100ms);
  EXPECT_EQ(can.poll().current, -Gripper::kFreeCurrent.value);
  can.move(255, 60, 500, 0x80);
  const auto place = can.gripper.position();
  can.wait(1s);
  EXPECT_EQ(can.gripper.position(), place);
  EXPECT_EQ(can.poll().current, 0);
  EXPECT_EQ(can.poll().status, 0x81);
}

TEST(Gripper, StaysAtPositionUntilTheSetPointsChange) {
  Can can{kCalibrated};
  can.move(200, 255, 500);
  can.wait(1s);
  EXPECT_EQ(can.poll().status, 0xF1);
  EXPECT_EQ(can.move(200, 255, 500).status, 0xF1) << "the same again changes nothing";
  EXPECT_EQ(can.move(200, 255, 501).status, 0xC1) << "any change takes it back";
  EXPECT_EQ(can.poll().status, 0xF1) << "and it arrives at once";
}

// Objects, section 8.5 and 8.6; the code has its low bit first.

TEST(Gripper, ReportsAnObjectWhileClosing) {  // F9: E1
  Can can{with_object(100)};
  can.move(255, 60, 300);
  EXPECT_EQ(can.poll().status, 0xC1);
  can.wait(1s);
  EXPECT_EQ(can.poll(),
            (Answer{.position = 99, .current = -300, .status = 0xE1, .has_error = false}));
}

TEST(Gripper, ReportsAnObjectWhileOpening) {
  Can can{with_object(std::nullopt, 100, 200)};
  can.move(0, 60, 300);
  can.wait(1s);
  EXPECT_EQ(can.poll(),
            (Answer{.position = 99, .current = 300, .status = 0xD1, .has_error = false}));
}

TEST(Gripper, ReportsTheObjectWhenItsVelocityHasFaded) {
  // Contact at byte 100, 4140 counts away: 4140 * 5000 / 18854 = 1097.9, in interrupt 1098. The
  // mean over 20 interrupts is at most 500 counts/s when only the cut step of 17108 units / 20 is
  // left, still too much, and then nothing: in interrupt 1118, at 223.6 ms.
  Can can{with_object(100)};
  can.gripper.receive(at(0s), frame(GripperCan::kSetPoint, hex("FF 3C 01 2C D0")));
  can.gripper.advance_to(at(219'599us));
  EXPECT_EQ(can.gripper.current(), Milliamperes{-60});
  can.gripper.advance_to(at(219'600us));
  EXPECT_EQ(can.gripper.current(), Milliamperes{-300});
  EXPECT_EQ(can.gripper.status(), 0xC1);
  can.gripper.advance_to(at(223'599us));
  EXPECT_EQ(can.gripper.status(), 0xC1);
  can.gripper.advance_to(at(223'600us));
  EXPECT_EQ(can.gripper.status(), 0xE1);
}

TEST(Gripper, PressesAsHardAsToldToLater) {
  Can can{with_object(100)};
  can.move(255, 60, 300);
  can.wait(1s);
  can.move(255, 60, 900);
  can.wait(10ms);
  EXPECT_EQ(can.poll(),
            (Answer{.position = 99, .current = -900, .status = 0xE1, .has_error = false}));
}

TEST(Gripper, LetsGoOfAnObject) {
  Can can{with_object(100)};
  can.move(255, 60, 300);
  can.wait(1s);
  can.move(0, 60, 300);
  EXPECT_EQ(can.poll().status, 0xC1);
  can.wait(1s);
  EXPECT_EQ(can.poll(), (Answer{.position = 0, .current = 0, .status = 0xF1, .has_error = false}));
}

TEST(Gripper, ClosesWhenTheObjectIsTakenAway) {
  Can can{with_object(100)};
  can.move(255, 60, 300);
  can.wait(1s);
  can.gripper.touch(at(can.now), {});
  can.wait(1s);
  EXPECT_EQ(can.poll().position, 255);
  EXPECT_EQ(can.poll().status, 0xF1);
}

TEST(Gripper, ArrivesAtAnObjectThatIsWhereItWants) {
  Can can{with_object(100)};
  can.move(100, 60, 300);
  can.wait(1s);
  EXPECT_EQ(can.poll(), (Answer{.position = 99, .current = 0, .status = 0xF1, .has_error = false}));
}

TEST(Gripper, StaysWhereItIsIfAnObjectIsPutBehindItsFingers) {
  Can can{with_object(50, std::nullopt, 150)};
  can.move(255, 60, 300);
  can.wait(1s);
  EXPECT_EQ(can.poll(),
            (Answer{.position = 149, .current = -300, .status = 0xE1, .has_error = false}));
}

TEST(Gripper, DoesNotMoveWithLessCurrentThanItsFrictionTakes) {
  Can can{kCalibrated};
  can.move(255, 60, 59);
  can.wait(1s);
  EXPECT_EQ(can.poll(), (Answer{.position = 0, .current = -59, .status = 0xE1, .has_error = false}))
      << "which looks like an object";
  can.move(255, 60, 60);
  can.wait(1s);
  EXPECT_EQ(can.poll().position, 255);
}

TEST(Gripper, TakesANegativeCurrentForItsMagnitude) {
  Can can{with_object(100)};
  can.move(255, 60, -300);
  can.wait(1s);
  EXPECT_EQ(can.poll().current, -300);
  can.move(255, 60, -32'768);
  can.wait(10ms);
  EXPECT_EQ(can.poll().current, -32'767);
}

// Calibration, section 8.6.

TEST(Gripper, CalibratesInTwoSecondsFromOpen) {
  // The request is whole at 44 us. 3200 interrupts at the open end, 100 of pause, 4196 to close
  // (52,790,000 units at 12582), 19 until the mean velocity has faded below 700, and with that
  // one 3200 more: the 10714th interrupt, at 2.1428 s.
  Can can;
  can.gripper.receive(at(0s), frame(GripperCan::kCalibrate));
  const auto at_time = [&](Duration time) -> Gripper& {
    can.gripper.advance_to(at(time));
    return can.gripper;
  };
  EXPECT_EQ(at_time(200us).current(), Milliamperes{500});
  EXPECT_EQ(at_time(639'800us).current(), Milliamperes{500});
  EXPECT_EQ(at_time(640'200us).current(), Milliamperes{0}) << "the pause";
  EXPECT_EQ(at_time(660'000us).current(), Milliamperes{0});
  EXPECT_EQ(at_time(660'200us).current(), Milliamperes{-60}) << "closing";
  EXPECT_EQ(at_time(1'499'000us).current(), Milliamperes{-60});
  EXPECT_EQ(at_time(1'499'200us).current(), Milliamperes{-500}) << "closed: 7496 interrupts";
  EXPECT_EQ(at_time(2'142'600us).status(), 0x00);
  EXPECT_TRUE(can.gripper.is_calibrating());
  EXPECT_EQ(at_time(2'142'800us).status(), 0x01);
  EXPECT_FALSE(can.gripper.is_calibrating());
  EXPECT_EQ(at_time(2'143'000us).current(), Milliamperes{0}) << "the drive is idle";
  EXPECT_EQ(can.gripper.position(), EncoderCounts{-229});
}

TEST(Gripper, CalibratesInThreeSecondsFromClosed) {
  // 4196 + 19 interrupts more than from open: the 14929th less one, at 2.9856 s.
  GripperOptions options;
  options.position = 255;
  Can can{options};
  can.gripper.receive(at(0s), frame(GripperCan::kCalibrate));
  can.gripper.advance_to(at(2'985'400us));
  EXPECT_FALSE(can.gripper.is_calibrated());
  can.gripper.advance_to(at(2'985'600us));
  EXPECT_TRUE(can.gripper.is_calibrated());
}

TEST(Gripper, StandsStillAfterCalibrationUntilNewSetPointsCome) {
  Can can;
  can.move(128, 255, 500);
  can.send(frame(GripperCan::kCalibrate));
  can.wait(4s);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(can.poll().position, 255) << "an empty poll does not start the drive";
    can.wait(10ms);
  }
  can.move(128, 255, 500);
  can.wait(1s);
  EXPECT_EQ(can.poll().position, 127);
}

TEST(Gripper, LetsSetPointsWaitWhileItCalibrates) {
  Can can{kCalibrated};
  can.send(frame(GripperCan::kCalibrate));
  can.wait(1s);
  EXPECT_EQ(can.move(0, 255, 500).status, 0xC0) << "not calibrated meanwhile";
  can.wait(3s);
  EXPECT_EQ(can.poll(),
            (Answer{.position = 255, .current = 0, .status = 0xC1, .has_error = false}));
}

TEST(Gripper, ReportsNoObjectWhileItCalibrates) {
  Can can;
  can.move(0, 255, 100, 0xC0);
  can.send(frame(GripperCan::kCalibrate));
  can.wait(500ms);
  EXPECT_EQ(can.poll(),
            (Answer{.position = 0, .current = 500, .status = 0xC0, .has_error = false}));
}

TEST(Gripper, StartsItsCalibrationOverWhenToldSo) {
  Can can;
  can.send(frame(GripperCan::kCalibrate));
  can.wait(2s);
  can.send(frame(GripperCan::kCalibrate));
  can.wait(1s);
  EXPECT_FALSE(can.gripper.is_calibrated());
  can.wait(2s);
  EXPECT_TRUE(can.gripper.is_calibrated());
}

TEST(Gripper, TakesAnObjectForTheClosedEndWhenItCalibrates) {
  Can can{with_object(100)};
  can.send(frame(GripperCan::kCalibrate));
  can.wait(4s);
  EXPECT_EQ(can.poll().position, 255);
  can.gripper.touch(at(can.now), {});
  can.move(254, 255, 500);
  can.wait(1s);
  can.move(255, 255, 500);
  can.wait(1s);
  EXPECT_EQ(can.gripper.position(), EncoderCounts{10'329 - 4140}) << "byte 100 of the real stroke";
}

TEST(Gripper, IsNotCalibratedIfItCouldNotMoveAtAll) {
  Can can{with_object(0)};
  can.send(frame(GripperCan::kCalibrate));
  can.wait(4s);
  EXPECT_FALSE(can.gripper.is_calibrated());
  EXPECT_FALSE(can.gripper.is_calibrating());
}

TEST(Gripper, GivesUpCalibratingAfterThirtySeconds) {
  GripperOptions options = kCalibrated;
  options.plant.has_end_stops = false;
  Can can{options};
  can.gripper.receive(at(0s), frame(GripperCan::kCalibrate));
  can.gripper.advance_to(at(29'999'800us));
  EXPECT_TRUE(can.gripper.is_calibrating());
  can.gripper.advance_to(at(30s));
  EXPECT_FALSE(can.gripper.is_calibrating());
  EXPECT_FALSE(can.gripper.is_calibrated());
  can.wait(31s);
  EXPECT_EQ(can.poll(), (Answer{.position = 0, .current = 0, .status = 0x00, .has_error = false}));
}

// Errors.

TEST(Gripper, LatchesTheStopUntilErrorsAreCleared) {
  Can can{kCalibrated};
  can.move(255, 60, 500);
  can.wait(100ms);
  const auto stopped = can.move(255, 60, 500, 0xF0);
  EXPECT_EQ(stopped.status, 0xC3);
  EXPECT_TRUE(stopped.has_error) << "the lowest bit of the identifier: 079";
  const auto place = can.gripper.position();
  can.wait(100ms);
  EXPECT_EQ(can.gripper.position(), place);
  EXPECT_EQ(can.move(255, 60, 500, 0xD0).status, 0xC3) << "releasing the stop is not enough";
  can.wait(100ms);
  EXPECT_EQ(can.gripper.position(), place);
  EXPECT_EQ(can.poll().current, 0);
  can.send(frame(GripperCan::kClearError));
  EXPECT_EQ(can.poll().status, 0xC1);
  EXPECT_FALSE(can.poll().has_error);
}

TEST(Gripper, StaysStoppedWhileTheStopIsAskedFor) {
  Can can{kCalibrated};
  can.move(255, 60, 500, 0xF0);
  can.send(frame(GripperCan::kClearError));
  EXPECT_EQ(can.poll().status, 0xC3);
  EXPECT_TRUE(can.poll().has_error);
}

TEST(Gripper, StandsStillAfterClearErrorUntilNewSetPointsCome) {
  Can can{kCalibrated};
  can.move(255, 60, 500);
  can.wait(100ms);
  can.send(frame(GripperCan::kClearError));
  const auto place = can.gripper.position();
  can.poll();
  can.wait(1s);
  EXPECT_EQ(can.gripper.position(), place);
  can.move(255, 60, 500);
  can.wait(1s);
  EXPECT_EQ(can.poll().position, 255);
}

TEST(Gripper, BreaksOffItsCalibrationAtAStopOrAClearError) {
  for (const bool is_stop : {false, true}) {
    Can can;
    can.send(frame(GripperCan::kCalibrate));
    can.wait(1s);
    if (is_stop) {
      can.move(0, 0, 0, 0x20);
    } else {
      can.send(frame(GripperCan::kClearError));
    }
    can.wait(4s);
    EXPECT_FALSE(can.gripper.is_calibrating());
    EXPECT_EQ(can.poll().status, is_stop ? 0x02 : 0x00);
  }
}

TEST(Gripper, DoesNotCalibrateWhileStopped) {
  Can can;
  can.move(0, 0, 0, 0x20);
  can.send(frame(GripperCan::kCalibrate));
  can.wait(4s);
  EXPECT_FALSE(can.gripper.is_calibrated());
}

TEST(Gripper, LosesAllButItsPlaceWhenRebooted) {
  Can can;
  can.send(frame(GripperCan::kCalibrate));
  can.wait(4s);
  can.move(100, 255, 500);
  can.wait(1s);
  const auto place = can.gripper.position();
  can.gripper.reboot(at(can.now));
  EXPECT_EQ(can.poll(), (Answer{.position = 99, .current = 0, .status = 0x00, .has_error = false}));
  EXPECT_EQ(can.gripper.position(), place);
}

// As a value.

/// A life drawn at random: commands, objects and pauses. The time of its end.
template <class Each>
Instant live(std::uint64_t seed, Each each) {
  test::Dice dice{seed};
  Duration now{};
  for (int i = 0; i < 300; ++i) {
    const auto choice = dice.between(0, 9);
    const auto byte = [&] { return std::byte{dice.byte()}; };
    if (choice < 5) {
      constexpr std::array kCommands{0xC0, 0xC0, 0xC0, 0xC0, 0x80, 0xE0};
      // 80,000 counts/s at byte 255 is a whole number in an interrupt, so contacts fall on ticks.
      const auto speed = dice.one_in(3) ? std::byte{255} : byte();
      ByteVector data{byte(), speed, static_cast<std::byte>(dice.between(0, 3)), byte(),
                      std::byte(kCommands[static_cast<std::size_t>(dice.between(0, 5))])};
      each(now, [&](Gripper& g) { g.receive(at(now), frame(GripperCan::kSetPoint, data)); });
    } else if (choice < 7) {
      each(now, [&](Gripper& g) { g.receive(at(now), frame(GripperCan::kSetPoint)); });
    } else if (choice == 7) {
      const auto code = dice.one_in(2) ? GripperCan::kCalibrate : GripperCan::kClearError;
      each(now, [&](Gripper& g) { g.receive(at(now), frame(code)); });
    } else if (choice == 8) {
      GripperPlant plant;
      if (dice.one_in(2)) plant.stop_closing = static_cast<std::uint8_t>(dice.between(0, 255));
      if (dice.one_in(2)) plant.stop_opening = static_cast<std::uint8_t>(dice.between(0, 255));
      plant.has_end_stops = !dice.one_in(8);
      each(now, [&](Gripper& g) { g.touch(at(now), plant); });
    } else {
      each(now, [&](Gripper& g) { g.advance_to(at(now)); });
    }
    now += dice.one_in(2) ? std::chrono::milliseconds{dice.between(0, 4000)}
                          : std::chrono::microseconds{dice.between(0, 5000)};
  }
  return at(now);
}

std::vector<std::string> life_of(const Gripper& gripper) {
  std::vector<std::string> lines{std::to_string(gripper.position().value) + " " +
                                 std::to_string(gripper.current().value) + " " +
                                 std::to_string(gripper.status())};
  for (const auto& emission : gripper.sent()) {
    lines.push_back(std::to_string(emission.time.time_since_epoch().count()) + " " +
                    std::to_string(emission.frame.id) + " " + to_hex(emission.frame.payload()));
  }
  return lines;
}

TEST(Gripper, IsTheSameInClosedFormAndInAPlainLoop) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Gripper plain{kCalibrated};
    plain.use_plain_loop();
    Gripper closed{kCalibrated};
    const auto end = live(seed, [&](Duration now, auto act) {
      act(plain);
      act(closed);
      ASSERT_EQ(life_of(closed), life_of(plain)) << "seed " << seed << " at " << now / 1us << " us";
    });
    plain.advance_to(end);
    closed.advance_to(end);
    ASSERT_EQ(life_of(closed), life_of(plain)) << "seed " << seed;
  }
}

TEST(Gripper, IsTheSameHoweverTimeIsCut) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Gripper whole{kCalibrated};
    Gripper cut{kCalibrated};
    test::Dice dice{seed};
    Duration last{};
    const auto end = live(seed, [&](Duration now, auto act) {
      while (last < now) {
        last = std::min(now, last + Duration{dice.between(1, 50'000'000)});
        cut.advance_to(at(last - Duration{1}));
      }
      act(whole);
      act(cut);
    });
    whole.advance_to(end);
    cut.advance_to(end);
    ASSERT_EQ(life_of(cut), life_of(whole)) << "seed " << seed;
  }
}

TEST(Gripper, GoesOnFromASnapshotAsFromItself) {
  Can can;
  can.send(frame(GripperCan::kCalibrate));
  can.wait(1s);
  auto snapshot = can;
  can.wait(4s);
  snapshot.wait(4s);
  EXPECT_EQ(can.move(128, 60, 500), snapshot.move(128, 60, 500));
  can.wait(100ms);
  EXPECT_NE(can.gripper.position(), snapshot.gripper.position());
  snapshot.wait(100ms);
  EXPECT_EQ(life_of(can.gripper), life_of(snapshot.gripper));
}

}  // namespace
}  // namespace armjig::parol6::emulation
