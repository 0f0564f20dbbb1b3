// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/property.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig::parol6 {
namespace {

using test::as_vector;
using test::ByteVector;
using testing::Each;
using testing::ElementsAre;

CommandFrame decoded_command(const ByteVector& frame) {
  EXPECT_EQ(frame.size(), kCommandFrameSize);
  return decode_command(body_of(Bytes{frame}.first<kCommandFrameSize>()));
}

TelemetryFrame decoded_telemetry(const ByteVector& frame) {
  EXPECT_EQ(frame.size(), kTelemetryFrameSize);
  return decode_telemetry(body_of(Bytes{frame}.first<kTelemetryFrameSize>()));
}

/// A frame with every member told apart from its neighbours, as in section 1.6.
const CommandFrame kJog{
    .position = {Steps{10240}, Steps{-32000}, Steps{57905}, Steps{0}, Steps{0}, Steps{32000}},
    .speed = {StepsPerSecond{1500}, StepsPerSecond{-3000}, StepsPerSecond{3600}, StepsPerSecond{0},
              StepsPerSecond{0}, StepsPerSecond{-18000}},
    .command = Command::kJog,
    .affected_joints = 0xFF,
    .in_out = io_flag::kOut1,
    .timeout = 0,
    .gripper = {.position = 120,
                .speed = 30,
                .current = Milliamperes{500},
                .command = gripper_command::kActivate | gripper_command::kGoTo |
                           gripper_command::kReleaseDirection,
                .mode = 0,
                .id = 0},
    .check = kCheckHost};

const TelemetryFrame kRest{
    .position = {Steps{10242}, Steps{-32002}, Steps{57907}, Steps{0}, Steps{0}, Steps{31998}},
    .speed = {},
    .homed = 0xFF,
    .io = io_flag::kIn1 | io_flag::kEstopReleased | io_flag::kSpare,
    .temperature_error = 0x03,
    .position_error = 0x03,
    .timing = 7032,
    .timeout_error = 100,
    .echo = Command::kIdle,
    .gripper = {.id = 0,
                .position = 119,
                .speed = 1,
                .current = Milliamperes{-200},
                .status = 0xE1,
                .object_detection = 1},
    .check = kCheckBoard};

TEST(CommandFrame, DecodesTheExampleOfSection1) {
  EXPECT_EQ(decoded_command(vectors::kJogCommand), kJog);
}

TEST(CommandFrame, EncodesTheExampleOfSection1) {
  EXPECT_EQ(as_vector(encode(kJog)), vectors::kJogCommand);
}

TEST(CommandFrame, DecodesTheFirstFrameOfTheVendorsProgram) {  // F3
  const auto frame = decoded_command(vectors::kFirstCommand);
  EXPECT_THAT(frame.position,
              ElementsAre(Steps{1}, Steps{11}, Steps{111}, Steps{1111}, Steps{11111}, Steps{10}));
  EXPECT_THAT(frame.speed, ElementsAre(StepsPerSecond{2}, StepsPerSecond{21}, StepsPerSecond{22},
                                       StepsPerSecond{23}, StepsPerSecond{24}, StepsPerSecond{25}));
  EXPECT_EQ(frame.command, Command{0});
  EXPECT_EQ(frame.gripper, (GripperSetPoint{.position = 1,
                                            .speed = 1,
                                            .current = Milliamperes{1},
                                            .command = 0x01,
                                            .mode = 0,
                                            .id = 0}));
  EXPECT_EQ(frame.check, kCheckHost);
}

TEST(CommandFrame, DecodesTheIdleFrameOfTheApi) {  // F4
  const auto frame = decoded_command(vectors::kIdleCommand);
  EXPECT_THAT(frame.position, Each(Steps{0}));
  EXPECT_THAT(frame.speed, Each(StepsPerSecond{0}));
  EXPECT_EQ(frame.command, Command::kIdle);
  EXPECT_EQ(frame.affected_joints, 0);
}

TEST(CommandFrame, DecodesTheStandbyTargetOfTheApi) {  // F5
  const auto frame = decoded_command(vectors::kStandbyCommand);
  EXPECT_EQ(frame.position, kJog.position);
  EXPECT_EQ(frame.command, Command::kGoTo);
}

TEST(CommandFrame, DecodesASampleOfAPlannedMove) {  // F6
  const auto frame = decoded_command(vectors::kPlannedCommand);
  EXPECT_THAT(frame.position, ElementsAre(Steps{9173}, Steps{-31999}, Steps{57904}, Steps{0},
                                          Steps{0}, Steps{32000}));
  EXPECT_EQ(frame.speed[0], StepsPerSecond{-2715});
  EXPECT_EQ(frame.command, Command::kGoTo);
}

TEST(CommandFrame, KeepsGripperValuesThatOneByteCannotHold) {  // F7
  const auto gripper = decoded_command(vectors::kGripperCommand).gripper;
  EXPECT_EQ(gripper, (GripperSetPoint{.position = 300,
                                      .speed = 256,
                                      .current = Milliamperes{-2},
                                      .command = 0xD0,
                                      .mode = 0,
                                      .id = 5}));
}

TEST(CommandFrame, LosesTheUpperBitsOfWhatDoesNotFit) {  // F1
  CommandFrame frame;
  frame.position[0] = Steps{8388608};
  frame.position[1] = Steps{-8388609};
  frame.position[2] = Steps{16777216};
  const auto bytes = encode(frame);
  EXPECT_EQ(as_vector(Bytes{bytes}.subspan(4, 9)), test::hex("80 00 00 7F FF FF 00 00 00"));
}

TEST(TelemetryFrame, DecodesTheExampleOfSection1) {
  EXPECT_EQ(decoded_telemetry(vectors::kRestTelemetry), kRest);
}

TEST(TelemetryFrame, EncodesTheExampleOfSection1) {
  EXPECT_EQ(as_vector(encode(kRest)), vectors::kRestTelemetry);
}

TEST(TelemetryFrame, DecodesTheExampleOfTheDocument) {  // F8
  const auto frame = decoded_telemetry(vectors::kDocumentTelemetry);
  EXPECT_THAT(frame.position,
              ElementsAre(Steps{255}, Steps{254}, Steps{253}, Steps{252}, Steps{251}, Steps{250}));
  EXPECT_THAT(frame.speed,
              ElementsAre(StepsPerSecond{245}, StepsPerSecond{244}, StepsPerSecond{243},
                          StepsPerSecond{242}, StepsPerSecond{241}, StepsPerSecond{240}));
  EXPECT_EQ(frame.homed, 0xFF);
  EXPECT_EQ(frame.io, 0x00);
  EXPECT_EQ(frame.temperature_error, 0xFF);
  EXPECT_EQ(frame.position_error, 0x00);
  EXPECT_EQ(frame.timing, 255);
  EXPECT_EQ(frame.timeout_error, 244);
  EXPECT_EQ(frame.echo, Command{255});
  EXPECT_EQ(frame.gripper, (GripperReport{.id = 200,
                                          .position = 300,
                                          .speed = 300,
                                          .current = Milliamperes{300},
                                          .status = 200,
                                          .object_detection = 1}));
  EXPECT_EQ(frame.check, 212);
}

TEST(TelemetryFrame, NamesTheBitsOfTheGripperStatus) {  // F9
  using namespace gripper_status;
  EXPECT_EQ(0xE1, kActivated | kGoTo | kObjectLow | kCalibrated);
  EXPECT_EQ(0xF1, kActivated | kGoTo | kObjectLow | kObjectHigh | kCalibrated);
  EXPECT_EQ(0xD5, kActivated | kGoTo | kObjectHigh | kTimeoutError | kCalibrated);
  EXPECT_EQ(0x0C, kTemperatureError | kTimeoutError);
}

TEST(TelemetryFrame, NamesTheBitsOfTheInputs) {  // F10
  using namespace io_flag;
  EXPECT_EQ(0x0F, kEstopReleased | kSpare);
  EXPECT_EQ(0x07, kSpare);
  EXPECT_EQ(0x2F, kOut1 | kEstopReleased | kSpare);
  EXPECT_EQ(0x97, kIn1 | kOut2 | kSpare);
  EXPECT_EQ(0xBF, kIn1 | kOut1 | kOut2 | kEstopReleased | kSpare);
}

TEST(CommandFrame, EncodesWhatItDecodedFromAnyBody) {
  test::for_all([](const std::array<std::uint8_t, kCommandBodySize>& numbers) {
    std::array<std::byte, kCommandBodySize> body{};
    std::ranges::transform(numbers, body.begin(), [](auto n) { return std::byte{n}; });
    const auto frame = encode(decode_command(body));
    RC_ASSERT(std::ranges::equal(body_of(frame), body));
    RC_ASSERT(decode_command(body_of(frame)) == decode_command(body));
    RC_ASSERT(as_vector(Bytes{frame}.first(4)) == test::hex("FF FF FF 34"));
    RC_ASSERT(as_vector(Bytes{frame}.last(2)) == test::hex("01 02"));
  });
}

TEST(TelemetryFrame, EncodesWhatItDecodedFromAnyBody) {
  test::for_all([](const std::array<std::uint8_t, kTelemetryBodySize>& numbers) {
    std::array<std::byte, kTelemetryBodySize> body{};
    std::ranges::transform(numbers, body.begin(), [](auto n) { return std::byte{n}; });
    const auto frame = encode(decode_telemetry(body));
    RC_ASSERT(std::ranges::equal(body_of(frame), body));
    RC_ASSERT(decode_telemetry(body_of(frame)) == decode_telemetry(body));
    RC_ASSERT(as_vector(Bytes{frame}.first(4)) == test::hex("FF FF FF 38"));
    RC_ASSERT(as_vector(Bytes{frame}.last(2)) == test::hex("01 02"));
  });
}

}  // namespace
}  // namespace armjig::parol6
