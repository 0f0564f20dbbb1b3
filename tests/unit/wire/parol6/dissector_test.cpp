// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/dissector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "harness/wire/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig::parol6 {
namespace {

using test::ByteVector;
using test::hex;
using test::joined;
using testing::HasSubstr;
using testing::Not;
using namespace std::chrono_literals;

std::vector<Message> dissect(Direction direction, const ByteVector& stream,
                             std::size_t piece_size = SIZE_MAX) {
  const auto dissector = make_dissector();
  std::vector<Message> messages;
  for (std::size_t place = 0; place < stream.size();) {
    const auto size = std::min(piece_size, stream.size() - place);
    dissector->feed(direction, at(1s), Bytes{stream}.subspan(place, size), messages);
    place += size;
  }
  dissector->finish(messages);
  return messages;
}

ByteVector all_bytes(const std::vector<Message>& messages) {
  ByteVector bytes;
  for (const auto& message : messages) bytes = joined(std::move(bytes), message.raw);
  return bytes;
}

/// What must not depend on how the stream was cut.
std::vector<std::string> summary(const std::vector<Message>& messages) {
  std::vector<std::string> lines;
  for (const auto& message : messages) {
    lines.push_back(std::string{message.name} + " " + to_hex(message.raw) + " " + message.fault);
  }
  return lines;
}

/// Frames, damaged frames and noise, now and then more than a piece of noise.
ByteVector traffic(test::Dice& dice, const ByteVector& good) {
  ByteVector stream;
  for (auto parts = dice.between(1, 12); parts > 0; --parts) {
    auto frame = good;
    switch (dice.between(0, 5)) {
      case 0:
        frame[3] = dice.byte();
        break;
      case 1:
        frame[frame.size() - 1] = dice.byte();
        break;
      case 2:
        frame.resize(static_cast<std::size_t>(dice.between(1, 55)));
        break;
      case 3:
        frame.assign(static_cast<std::size_t>(dice.between(1, 6000)), std::byte{0});
        for (auto& byte : frame) byte = dice.one_in(3) ? kStartByte : dice.byte();
        break;
      default:
        break;
    }
    stream = joined(std::move(stream), frame);
  }
  return stream;
}

TEST(Parol6Dissector, NamesCommandsAndTelemetryByTheirDirection) {
  const auto commands = dissect(Direction::kToDevice, vectors::kJogCommand);
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].name, "command");
  EXPECT_EQ(commands[0].direction, Direction::kToDevice);
  EXPECT_EQ(commands[0].raw, vectors::kJogCommand);
  EXPECT_EQ(commands[0].fault, "");
  EXPECT_EQ(commands[0].time, at(1s));

  const auto answers = dissect(Direction::kFromDevice, vectors::kRestTelemetry);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].name, "telemetry");
  EXPECT_EQ(answers[0].raw, vectors::kRestTelemetry);
}

TEST(Parol6Dissector, ShowsTheFieldsOfACommand) {  // section 1.6
  const auto text = to_text(dissect(Direction::kToDevice, vectors::kJogCommand).at(0));
  EXPECT_THAT(text, HasSubstr("to_device command, 56 bytes"));
  EXPECT_THAT(text, HasSubstr("position.j2        -32000 steps\n"));
  EXPECT_THAT(text, HasSubstr("speed.j6           -18000 steps/s\n"));
  EXPECT_THAT(text, HasSubstr("command            123 (jog)\n"));
  EXPECT_THAT(text, HasSubstr("in_out             out1 (0x20)\n"));
  EXPECT_THAT(text, HasSubstr("gripper.current    500 mA\n"));
  EXPECT_THAT(text, Not(HasSubstr("start")));
}

TEST(Parol6Dissector, ShowsTheFieldsOfTelemetry) {  // section 1.6
  const auto text = to_text(dissect(Direction::kFromDevice, vectors::kRestTelemetry).at(0));
  EXPECT_THAT(text, HasSubstr("position.j3        57907 steps\n"));
  EXPECT_THAT(text, HasSubstr("io                 in1 estop_released (0x8F)\n"));
  EXPECT_THAT(text, HasSubstr("timing             7032 ticks\n"));
  EXPECT_THAT(text, HasSubstr("echo               255 (idle)\n"));
  EXPECT_THAT(text, HasSubstr("gripper.current    -200 mA\n"));
  EXPECT_THAT(text,
              HasSubstr("gripper.status     activated go_to object_bit0 calibrated (0xE1)\n"));
}

TEST(Parol6Dissector, SaysWhyBytesAreNoFrame) {
  const auto fault_of = [](const ByteVector& bytes) {
    const auto messages = dissect(Direction::kToDevice, bytes);
    EXPECT_EQ(messages.size(), 1U);
    EXPECT_EQ(messages.at(0).name, "noise");
    EXPECT_TRUE(messages.at(0).fields.empty());
    return messages.at(0).fault;
  };
  auto wrong_end = vectors::kIdleCommand;
  wrong_end[55] = std::byte{0x03};
  EXPECT_EQ(fault_of(hex("01 02 03")), "no start of a frame");
  EXPECT_EQ(fault_of(hex("FF FF FF 38 00")), "length byte 56 where 52 is due");
  EXPECT_EQ(fault_of(wrong_end), "0x03 in place of the end bytes 01 02");
  EXPECT_EQ(fault_of(hex("FF FF FF 34 00")), "the frame is cut short");
}

TEST(Parol6Dissector, KeepsTheDirectionsApart) {
  const auto dissector = make_dissector();
  std::vector<Message> messages;
  const auto half = [](const ByteVector& frame, bool first) {
    return first ? Bytes{frame}.first(20) : Bytes{frame}.subspan(20);
  };
  dissector->feed(Direction::kToDevice, at(1ms), half(vectors::kJogCommand, true), messages);
  dissector->feed(Direction::kFromDevice, at(2ms), half(vectors::kRestTelemetry, true), messages);
  EXPECT_TRUE(messages.empty());
  dissector->feed(Direction::kToDevice, at(3ms), half(vectors::kJogCommand, false), messages);
  dissector->feed(Direction::kFromDevice, at(4ms), half(vectors::kRestTelemetry, false), messages);
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].raw, vectors::kJogCommand);
  EXPECT_EQ(messages[0].time, at(3ms));
  EXPECT_EQ(messages[1].raw, vectors::kRestTelemetry);
  EXPECT_EQ(messages[1].time, at(4ms));
}

TEST(Parol6Dissector, LosesNoByteAndKeepsTheirOrder) {
  test::Dice dice{31};
  for (int round = 0; round < 300; ++round) {
    const auto stream = traffic(dice, vectors::kJogCommand);
    EXPECT_EQ(all_bytes(dissect(Direction::kToDevice, stream)), stream);
    const auto answers = traffic(dice, vectors::kRestTelemetry);
    EXPECT_EQ(all_bytes(dissect(Direction::kFromDevice, answers)), answers);
  }
}

TEST(Parol6Dissector, SaysTheSameHoweverTheStreamIsCut) {
  test::Dice dice{32};
  for (int round = 0; round < 200; ++round) {
    const auto stream = traffic(dice, vectors::kJogCommand);
    const auto whole = summary(dissect(Direction::kToDevice, stream));
    EXPECT_EQ(summary(dissect(Direction::kToDevice, stream, 1)), whole);
    const auto size = static_cast<std::size_t>(dice.between(2, 5000));
    EXPECT_EQ(summary(dissect(Direction::kToDevice, stream, size)), whole);
  }
}

TEST(Parol6Dissector, HandsOutNoiseInPiecesSoThatItDoesNotPileUp) {
  constexpr std::size_t kMost = 4096 + 60;
  for (const auto byte : {std::byte{0x00}, std::byte{0xFF}}) {
    const auto dissector = make_dissector();
    std::vector<Message> messages;
    std::size_t fed = 0;
    std::size_t seen = 0;
    const ByteVector chunk(1000, byte);
    for (int i = 0; i < 1000; ++i) {
      dissector->feed(Direction::kToDevice, at(1s), chunk, messages);
      fed += chunk.size();
      for (const auto& message : messages) {
        EXPECT_LE(message.raw.size(), kMost);
        seen += message.raw.size();
      }
      messages.clear();
      ASSERT_LE(fed - seen, kMost);
    }
  }
}

TEST(Parol6Dissector, CanBeUsedAgainAfterTheEndOfTheTraffic) {
  const auto dissector = make_dissector();
  std::vector<Message> messages;
  dissector->feed(Direction::kToDevice, at(1s), Bytes{vectors::kJogCommand}.first(30), messages);
  dissector->finish(messages);
  messages.clear();
  dissector->feed(Direction::kToDevice, at(2s), vectors::kIdleCommand, messages);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].raw, vectors::kIdleCommand);
}

TEST(FieldDifferences, NamesEveryFieldThatDiffers) {
  auto other = vectors::kRestTelemetry;
  other[6] = std::byte{0x03};   // position.j1: 10243
  other[41] = std::byte{0x87};  // io: estop pressed
  const auto message = dissect(Direction::kFromDevice, vectors::kRestTelemetry).at(0);
  EXPECT_EQ(field_differences(message.fields, vectors::kRestTelemetry, other),
            (std::vector<std::string>{"position.j1: expected 10242 steps, got 10243 steps",
                                      "io: expected in1 estop_released (0x8F), got in1 (0x87)"}));
  EXPECT_TRUE(field_differences(message.fields, other, other).empty());
}

}  // namespace
}  // namespace armjig::parol6
