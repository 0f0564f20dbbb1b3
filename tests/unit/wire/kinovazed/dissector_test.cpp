// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/kinovazed/dissector.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/wire/kinovazed/fields.hpp"
#include "harness/wire/kinovazed/line.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig::kinovazed {
namespace {

Bytes bytes_of(std::string_view text) { return std::as_bytes(std::span{text}); }

std::vector<Message> dissect(Direction direction, std::string_view text, std::size_t piece = 9999) {
  const auto dissector = make_dissector();
  std::vector<Message> out;
  for (; !text.empty(); text.remove_prefix(std::min(piece, text.size()))) {
    dissector->feed(direction, {}, bytes_of(text.substr(0, piece)), out);
  }
  dissector->finish(out);
  return out;
}

TEST(KinovaDissector, NamesCommandsAndTheirArguments) {
  const auto messages = dissect(Direction::kToDevice, "MoveJoystick:100:-200: 300\r\n");
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(
      to_text(messages[0]),
      "to_device MoveJoystick, 28 bytes\n"
      "  4D 6F 76 65 4A 6F 79 73 74 69 63 6B 3A 31 30 30 3A 2D 32 30 30 3A 20 33 30 30 0D 0A\n"
      "  command            8 (MoveJoystick)\n"
      "  x                  100\n"
      "  y                  -200\n"
      "  z                  300\n");
}

TEST(KinovaDissector, NamesTheFlagsOfAHeartbeat) {
  const auto messages = dissect(Direction::kFromDevice, "Heartbeat:21\r\nJoystickModeSet\r\n");
  ASSERT_EQ(messages.size(), 2U);
  const auto& state = messages[0].fields[1];
  EXPECT_EQ(field_text(state, field_value(state, messages[0].raw)),
            "isIdle isInitialized isConnected (0x15)");
  EXPECT_EQ(messages[1].name, "JoystickModeSet");
}

TEST(KinovaDissector, SaysWhatIsWrongWithALine) {
  const auto messages = dissect(Direction::kToDevice, "RunObjective:Bell\r\nESt");
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].fault, "not an objective");
  EXPECT_EQ(messages[1].fault, "a line without an end");
}

TEST(KinovaDissector, LosesNoByteHoweverTheStreamIsCut) {
  test::for_all([] {
    const auto stream =
        *rc::gen::container<std::string>(rc::gen::elementOf(std::string{"\r\n:EStop "})) +
        std::string(1160, 'x');
    const auto direction = *rc::gen::element(Direction::kToDevice, Direction::kFromDevice);
    const auto whole = dissect(direction, stream);
    const auto pieces = dissect(direction, stream, 3);
    RC_ASSERT(whole.size() == pieces.size());
    std::string all;
    for (const auto& message : whole) {
      for (const auto byte : message.raw) all.push_back(static_cast<char>(byte));
    }
    RC_ASSERT(all == stream);
  });
}

TEST(KinovaFields, AgreeWithTheCodec) {
  for (std::size_t i = 0; i < kVerbNames.size(); ++i) {
    const Command command{static_cast<Verb>(i), Mode::kAxis4to6, Objective::kAntenna, {1, -2, 3}};
    const auto line = encode(command);
    const auto fields = command_fields(command.verb);
    std::vector<std::int64_t> values;
    for (const auto& field : fields) values.push_back(field_value(field, line.bytes()));
    std::vector<std::int64_t> expected{static_cast<std::int64_t>(i)};
    if (command.verb == Verb::kSetJoystickMode) expected.push_back(4);
    if (command.verb == Verb::kMoveJoystick) expected.insert(expected.end(), {1, -2, 3});
    if (fields.size() == 2 && command.verb != Verb::kSetJoystickMode) expected.push_back(6);
    EXPECT_EQ(values, expected) << line.view();
  }
}

}  // namespace
}  // namespace armjig::kinovazed
