// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/morap/dissector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "harness/wire/morap/fields.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig::morap {
namespace {

using test::hex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// What is found in transactions, one after the other.
std::vector<Message> dissect(std::initializer_list<std::string_view> transactions) {
  const auto dissector = make_dissector();
  std::vector<Message> messages;
  for (const auto text : transactions) {
    dissector->feed(Direction::kToDevice, {}, hex(text), messages);
  }
  dissector->finish(messages);
  return messages;
}

std::vector<std::string> names(const std::vector<Message>& messages) {
  std::vector<std::string> names;
  for (const auto& message : messages) names.emplace_back(message.name);
  return names;
}

std::string text_of(const Message& message, std::string_view field) {
  const auto* found = find_field(message.fields, field);
  return found == nullptr ? "none" : field_text(*found, field_value(*found, message.raw));
}

TEST(MorapDissector, ReadsWhatWasChosenForThatAddress) {
  const auto messages = dissect({"25 00000000", "24 83", "25 03", "22 88", "23 11", "25 02"});
  EXPECT_THAT(names(messages), ElementsAre("angle", "select", "motor_status", "select",
                                           "own_address", "motor_status"));
  EXPECT_EQ(messages[0].direction, Direction::kFromDevice);
  EXPECT_EQ(text_of(messages[2], "motor_status"), "3 (needs_calibration)");
  EXPECT_EQ(text_of(messages[5], "motor_status"), "2 (disabled)");
}

TEST(MorapDissector, ShowsFloatsWithTheirUnit) {
  const auto messages = dissect({"24 01 0000C03F"});
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].direction, Direction::kToDevice);
  EXPECT_EQ(text_of(messages[0], "command"), "1 (position)");
  EXPECT_EQ(text_of(messages[0], "value"), "1.5 rad");
}

TEST(MorapDissector, ShowsParametersByTheirCounts) {
  const auto set =
      std::string{"00 7102 02 CE19C9BF 86C91040 02 CE19C9BF 86C91040 01 C7BA78BF 00000000 A8"};
  const auto messages = dissect({"24 20 " + set, "24 8A", "25 " + set});
  EXPECT_THAT(names(messages), ElementsAre("program", "select", "position_set"));
  for (const auto* message : {&messages[0], &messages[2]}) {
    EXPECT_EQ(text_of(*message, "rate"), "625 Hz");
    EXPECT_EQ(text_of(*message, "d.1"), "2.2623");
    EXPECT_EQ(text_of(*message, "f.0"), "-0.9716");
    EXPECT_EQ(text_of(*message, "checksum"), "168");
    EXPECT_EQ(text_of(*message, "d.2"), "none");
  }
}

TEST(MorapDissector, KeepsWhatIsWrongAsNoiseWithAReason) {
  const auto fault = [](std::string_view transaction) {
    return dissect({transaction}).back().fault;
  };
  EXPECT_THAT(fault("24 01 0000"), HasSubstr("cut short"));
  EXPECT_THAT(fault("24 01 00000000 55"), HasSubstr("behind the end"));
  EXPECT_THAT(fault("24 20 00C80005"), HasSubstr("a count above four at byte 3"));
  EXPECT_THAT(fault("24 06 01"), HasSubstr("ignored"));
  EXPECT_THAT(fault("25 0000000011"), HasSubstr("past the end"));
  EXPECT_THAT(fault("33 00"), HasSubstr("nothing to read"));
  EXPECT_THAT(fault("32 0100"), HasSubstr("hangs"));
}

TEST(MorapDissector, KnowsThePenByItsAddress) {
  const auto messages = dissect({"32", "32 01", "32 0780"});
  EXPECT_THAT(names(messages), ElementsAre("poke", "pen", "pen"));
  EXPECT_EQ(text_of(messages[1], "command"), "1 (deploy)");
  EXPECT_EQ(text_of(messages[2], "position"), "128");
}

TEST(MorapDissector, GivesEveryByteBackOnce) {
  test::for_all([] {
    const auto transaction = *rc::gen::container<std::vector<std::uint8_t>>(
        rc::gen::oneOf(rc::gen::arbitrary<std::uint8_t>(),
                       rc::gen::element<std::uint8_t>(0x24, 0x25, 0x20, 0x8A, 0, 1, 2)));
    const auto bytes = std::as_bytes(std::span{transaction});
    std::vector<Message> messages;
    make_dissector()->feed(Direction::kToDevice, {}, bytes, messages);
    std::vector<std::byte> back;
    for (const auto& message : messages) {
      back.insert(back.end(), message.raw.begin(), message.raw.end());
      RC_ASSERT(message.fault.empty() == (message.name != "noise"));
      RC_ASSERT(message.fault.empty() == !message.fields.empty());
    }
    RC_ASSERT(back == test::as_vector(bytes));
  });
}

/// Fields lie one behind the other and have names of their own.
void expect_tiled(std::span<const Field> fields, std::size_t size) {
  std::size_t end = 0;
  std::set<std::string_view> names;
  for (const auto& field : fields) {
    EXPECT_EQ(field.offset, end) << field.name;
    EXPECT_TRUE(names.insert(field.name).second) << field.name;
    end = std::size_t{field.offset} + field.width;
  }
  EXPECT_EQ(end, size);
}

TEST(MorapFields, TileEveryMessage) {
  for (const auto& info : commands()) {
    if (info.payload == Payload::kControllerSet) continue;
    const std::size_t sizes[]{2, 6, 0, 11};
    expect_tiled(write_fields(info), sizes[static_cast<std::size_t>(info.payload)]);
  }
  for (const auto& info : readings()) {
    if (info.kind == ReadKind::kControllerSet) continue;
    expect_tiled(read_fields(info), info.kind == ReadKind::kFloat ? 5 : 2);
  }
  for (std::uint8_t i = 0; i < 125; ++i) {
    ControllerSet set;
    set.d.count = i / 25;
    set.c.count = i / 5 % 5;
    set.f.count = i % 5;
    expect_tiled(program_fields(set), 2 + wire_size(set));
    expect_tiled(read_set_fields(set), 1 + wire_size(set));
  }
  expect_tiled(pen_position_fields(), 3);
}

TEST(MorapFields, NameEveryCommandAsTheCodecDoes) {
  const auto& names = select_fields()[1].values;
  for (const auto& info : commands()) {
    const auto named =
        std::ranges::find(names, static_cast<std::int64_t>(info.id), &NamedValue::value);
    ASSERT_NE(named, names.end()) << info.name;
    EXPECT_EQ(named->name, info.name);
  }
  for (const auto& info : readings()) {
    const auto named =
        std::ranges::find(names, static_cast<std::int64_t>(info.selector), &NamedValue::value);
    ASSERT_NE(named, names.end()) << info.name;
    EXPECT_EQ(named->name, "read_" + std::string{info.name});
  }
  EXPECT_EQ(names.size(), commands().size() + readings().size());
}

}  // namespace
}  // namespace armjig::morap
