// SPDX-License-Identifier: Apache-2.0
#include "rtu.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string_view>

#include "harness/core/hex.hpp"

namespace gripper {
namespace {

using namespace armjig;
using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::Eq;
using testing::Optional;

Frame hex(std::string_view text) { return from_hex(text).value(); }

// [S] 6.2.2 works one out: 02 07 has the CRC 41 12.
TEST(Rtu, HasTheCrcOfTheDocument) {
  auto frame = hex("02 07");
  append_crc(frame);
  EXPECT_EQ(frame, hex("02 07 41 12"));
  EXPECT_EQ(read_request(1, 0, 10), hex("01 03 00 00 00 0A C5 CD"));
}

// The examples of [A] 6.3, 6.6 and 6.12, for unit 17.
TEST(Rtu, EncodesTheExamplesOfTheDocument) {
  EXPECT_EQ(read_request(17, 0x6B, 3), hex("11 03 00 6B 00 03 76 87"));
  EXPECT_EQ(write_request(17, 1, 3), hex("11 06 00 01 00 03 9A 9B"));
  EXPECT_EQ(write_many_request(17, 1, {0x000A, 0x0102}),
            hex("11 10 00 01 00 02 04 00 0A 01 02 C6 F0"));
}

std::vector<Message> dissect(Direction direction, Bytes bytes, std::size_t piece) {
  const auto dissector = make_dissector();
  std::vector<Message> messages;
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(piece, bytes.size()))) {
    dissector->feed(direction, {}, bytes.first(std::min(piece, bytes.size())), messages);
  }
  dissector->finish(messages);
  return messages;
}
std::vector<std::string> named(const std::vector<Message>& messages) {
  std::vector<std::string> texts;
  for (const auto& one : messages) texts.push_back(std::string{one.name} + ' ' + to_hex(one.raw));
  return texts;
}

TEST(RtuDissector, FindsTheSameHoweverTheBytesAreCut) {
  const auto bytes = hex("FF 11 03 00 6B 00 03 76 87 11 06 00 01 00 03 9A 9B 11");
  const auto whole = named(dissect(Direction::kToDevice, bytes, bytes.size()));
  EXPECT_THAT(whole, ElementsAre("noise ff", "read 1103006b00037687", "write 1106000100039a9b",
                                 "noise 11"));
  EXPECT_EQ(named(dissect(Direction::kToDevice, bytes, 1)), whole);
  EXPECT_EQ(named(dissect(Direction::kToDevice, bytes, 5)), whole);
}

TEST(RtuDissector, LosesNoByteOfWhatIsCutShort) {
  const auto frame = write_many_request(1, kTarget, {1, 2});
  for (std::size_t size = 0; size < frame.size(); ++size) {
    Frame back;
    for (const auto& one : dissect(Direction::kToDevice, Bytes{frame}.first(size), 1)) {
      EXPECT_EQ(one.name, "noise");
      back.insert(back.end(), one.raw.begin(), one.raw.end());
    }
    EXPECT_EQ(to_hex(back), to_hex(Bytes{frame}.first(size)));
  }
}

TEST(RtuDissector, NamesRegistersByTheRequest) {
  const auto dissector = make_dissector();
  std::vector<Message> messages;
  dissector->feed(Direction::kToDevice, {}, read_request(1, kStatus, 2), messages);
  dissector->feed(Direction::kFromDevice, {}, hex("01 03 04 00 02 01 2C 5B BE"), messages);
  ASSERT_EQ(messages.size(), 2);
  const auto& reply = messages[1];
  ASSERT_NE(find_field(reply.fields, "position"), nullptr) << to_text(reply);
  EXPECT_EQ(field_value(*find_field(reply.fields, "status"), reply.raw), 2);
  EXPECT_EQ(field_value(*find_field(reply.fields, "position"), reply.raw), 300);
}

/// Sizes of the frames that come of two characters with so much silence between them; 0 is one that
/// is spoilt.
std::vector<std::size_t> frames(unsigned baud, Duration silence) {
  const auto line = Silence::at(baud);
  Receiver receiver{line};
  std::vector<std::size_t> sizes;
  const auto take = [&](Instant time) {
    if (const auto frame = receiver.take(time)) sizes.push_back(frame->size());
  };
  receiver.receive(at(1s), std::byte{1});
  const auto next = at(1s) + silence + line.character;
  take(next);
  receiver.receive(next, std::byte{2});
  take(next + 1s);
  return sizes;
}

// 11 bits at 1,200 baud are 9.1667 ms: t1.5 is 13.75 ms, t3.5 is 32.083 ms.
TEST(Receiver, CutsBySilenceAtTwelveHundredBaud) {
  EXPECT_THAT(frames(1200, 0ms), ElementsAre(2));
  EXPECT_THAT(frames(1200, 13'740us), ElementsAre(2));
  EXPECT_THAT(frames(1200, 13'760us), ElementsAre(0));
  EXPECT_THAT(frames(1200, 32'080us), ElementsAre(0));
  EXPECT_THAT(frames(1200, 32'090us), ElementsAre(1, 1));
}

// 0.57292 ms: t1.5 is 859 us, t3.5 is 2005 us.
TEST(Receiver, CutsBySilenceAtTheUsualSpeed) {
  EXPECT_THAT(frames(19'200, 859us), ElementsAre(2));
  EXPECT_THAT(frames(19'200, 860us), ElementsAre(0));
  EXPECT_THAT(frames(19'200, 2005us), ElementsAre(0));
  EXPECT_THAT(frames(19'200, 2006us), ElementsAre(1, 1));
}

TEST(Receiver, HasFixedSilencesAboveTheUsualSpeed) {
  EXPECT_THAT(frames(115'200, 750us), ElementsAre(2));
  EXPECT_THAT(frames(115'200, 751us), ElementsAre(0));
  EXPECT_THAT(frames(115'200, 1749us), ElementsAre(0));
  EXPECT_THAT(frames(115'200, 1750us), ElementsAre(1, 1));
}

TEST(Receiver, DropsAFrameLongerThanThereIs) {
  Receiver receiver{Silence::at(1200)};
  for (std::size_t i = 0; i <= kMostFrame; ++i) receiver.receive(at(1s), std::byte{1});
  EXPECT_THAT(receiver.take(at(2s)), Optional(Eq(Frame{})));
}

}  // namespace
}  // namespace gripper
