// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/demo/demo.hpp"

#include <gtest/gtest.h>

#include "tests/unit/support/bytes.hpp"

namespace armjig::demo {
namespace {

using test::hex;

TEST(DemoWire, EncodesRequestsAndReplies) {
  EXPECT_TRUE(test::same_bytes(encode(Operation::kStart), hex("A5 73 8C")));
  EXPECT_TRUE(test::same_bytes(encode(State::kRunning), hex("5A 01 FE")));
}

std::vector<Message> dissect(const test::ByteVector& stream, std::size_t piece) {
  const auto dissector = make_dissector();
  std::vector<Message> messages;
  for (std::size_t place = 0; place < stream.size(); place += piece) {
    dissector->feed(Direction::kToDevice, {},
                    Bytes{stream}.subspan(place, std::min(piece, stream.size() - place)), messages);
  }
  dissector->finish(messages);
  return messages;
}

TEST(DemoWire, DissectsRequestsAndNoiseHoweverTheyAreCut) {
  const auto stream = hex("00 A5 A5 73 8C A5 71 8E A5 00");
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    const auto messages = dissect(stream, piece);
    ASSERT_EQ(messages.size(), 4U);
    EXPECT_EQ(messages[0].name, "noise");
    EXPECT_EQ(messages[0].raw, hex("00 A5"));
    EXPECT_EQ(messages[1].name, "request");
    EXPECT_EQ(messages[1].raw, hex("A5 73 8C"));
    EXPECT_EQ(messages[2].raw, hex("A5 71 8E"));
    EXPECT_EQ(messages[3].raw, hex("A5 00"));
  }
}

TEST(DemoWire, NamesOperationsAndStates) {
  EXPECT_EQ(field_text(*find_field(request_fields(), "operation"), 's'), "115 (start)");
  EXPECT_EQ(field_text(*find_field(reply_fields(), "state"), 2), "2 (halted)");
}

}  // namespace
}  // namespace armjig::demo
