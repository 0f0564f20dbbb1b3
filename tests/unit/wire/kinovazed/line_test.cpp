// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/kinovazed/line.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/unit/support/property.hpp"

namespace armjig::kinovazed {
namespace {

using Profile::kDocumented;
using Profile::kFirmware;
using namespace std::string_literals;

struct FormCase {
  std::string line;
  std::optional<LineFault> firmware;    ///< none: a command
  std::optional<LineFault> documented;  ///< none: a command
};

/// The table of line forms in docs/spec/kinovazed.md.
const std::vector<FormCase> kForms{
    {"EStop\r", {}, {}},
    {"EStop", {}, {}},
    {"EStop\r\r", {}, LineFault::kNotAscii},
    {" \t EStop \t \r", {}, LineFault::kNotAscii},
    {"  EStop \r", {}, LineFault::kBlank},
    {"EStop:\r", {}, LineFault::kArgumentCount},
    {"EStop: \r", {}, LineFault::kBlank},
    {"EStop :\r", {}, LineFault::kBlank},
    {"EStop::\r", LineFault::kArgumentCount, LineFault::kArgumentCount},
    {"EStop: :\r", LineFault::kArgumentCount, LineFault::kBlank},
    {"EStop:1\r", LineFault::kArgumentCount, LineFault::kArgumentCount},
    {":EStop\r", LineFault::kUnknownWord, LineFault::kUnknownWord},
    {":\r", LineFault::kUnknownWord, LineFault::kUnknownWord},
    {"\r", LineFault::kEmpty, LineFault::kEmpty},
    {"   \r", LineFault::kEmpty, LineFault::kBlank},
    {"estop\r", LineFault::kUnknownWord, LineFault::kUnknownWord},
    {"EStop\rEStop\r", LineFault::kUnknownWord, LineFault::kNotAscii},
    {"EStop\0\r"s, LineFault::kUnknownWord, LineFault::kNotAscii},
    {"\xEF\xBB\xBF"
     "EStop\r",
     LineFault::kUnknownWord, LineFault::kNotAscii},
    {"Heartbeat:3\r", LineFault::kUnknownWord, LineFault::kUnknownWord},
    {"SetJoystickMode\r", LineFault::kArgumentCount, LineFault::kArgumentCount},
    {"SetJoystickMode:\r", LineFault::kArgumentCount, LineFault::kNotAMode},
    {"SetJoystickMode::\r", LineFault::kNotAMode, LineFault::kArgumentCount},
    {"SetJoystickMode:xyz\r", LineFault::kNotAMode, LineFault::kNotAMode},
    {"SetJoystickMode: XYZ\r", LineFault::kNotAMode, LineFault::kBlank},
    {"SetJoystickMode:XYZ:1\r", LineFault::kArgumentCount, LineFault::kArgumentCount},
    {"SetJoystickMode:XYZ \r", {}, LineFault::kBlank},
    {"SetJoystickMode:XYZ:\r", {}, LineFault::kArgumentCount},
    {"RunObjective::Home\r", LineFault::kArgumentCount, LineFault::kArgumentCount},
    {"RunObjective:Bell\r", LineFault::kNotAnObjective, LineFault::kNotAnObjective},
    {"RunObjective:Home\r", {}, {}},
    {"MoveJoystick:1:2\r", LineFault::kArgumentCount, LineFault::kArgumentCount},
    {"MoveJoystick:1:2:\r", LineFault::kArgumentCount, LineFault::kNotANumber},
    {"MoveJoystick:1:2:3:4\r", LineFault::kArgumentCount, LineFault::kArgumentCount},
    {"MoveJoystick:1:2:3::\r", LineFault::kArgumentCount, LineFault::kArgumentCount},
    {"MoveJoystick:::\r", LineFault::kArgumentCount, LineFault::kNotANumber},
    {"MoveJoystick::::\r", LineFault::kNotANumber, LineFault::kArgumentCount},
    {"MoveJoystick:1,2,3\r", LineFault::kArgumentCount, LineFault::kArgumentCount},
    {"MoveJoystick:a:b:c\r", LineFault::kNotANumber, LineFault::kNotANumber},
    {"MoveJoystick:2147483648:0:0\r", LineFault::kNumberTooLarge, LineFault::kNumberTooLarge},
    {"MoveJoystick:0:-2147483649:0\r", LineFault::kNumberTooLarge, LineFault::kNumberTooLarge},
    {"MoveJoystick:0:0:99999999999999999999\r", LineFault::kNumberTooLarge,
     LineFault::kNumberTooLarge},
    {"MoveJoystick:+-1:0:0\r", LineFault::kNotANumber, LineFault::kNotANumber},
    {"MoveJoystick:- 1:0:0\r", LineFault::kNotANumber, LineFault::kBlank},
    {"MoveJoystick:1.9:1e3:0x10\r", {}, LineFault::kNotANumber},
    {"MoveJoystick: 1 : 2 : 3 \r", {}, LineFault::kBlank},
    {"MoveJoystick:1:2:3:\r", {}, LineFault::kArgumentCount},
    {"MoveJoystick:+5:-5:005\r", {}, {}},
    {" MoveJoystick :7:8:9\r", {}, LineFault::kBlank},
};

std::optional<LineFault> fault_of(std::string_view line, Profile profile) {
  const auto command = decode_command(line, profile);
  return command ? std::nullopt : std::optional{command.error()};
}

TEST(KinovaCommand, IsForgivenWhatTheShippedServerForgives) {
  for (const auto& form : kForms)
    EXPECT_EQ(fault_of(form.line, kFirmware), form.firmware) << form.line;
}

TEST(KinovaCommand, IsReadStrictlyByTheDocument) {
  for (const auto& form : kForms) {
    EXPECT_EQ(fault_of(form.line, kDocumented), form.documented) << form.line;
  }
}

TEST(KinovaCommand, HasNumbersThatEndAtTheFirstOtherByte) {
  const auto command = decode_command("MoveJoystick:1.9:+005:-3x\r", kFirmware);
  ASSERT_TRUE(command);
  EXPECT_EQ(command->deflection, (Deflection{1, 5, -3}));
  EXPECT_EQ(decode_command("MoveJoystick:-2147483648:2147483647:\v4\r", kFirmware)->deflection,
            (Deflection{INT32_MIN, INT32_MAX, 4}));
}

TEST(KinovaCommand, IsWrittenAsTheDocumentWritesIt) {
  EXPECT_EQ(encode(Command{Verb::kEStop}).view(), "EStop\r\n");
  EXPECT_EQ(encode(Command{.verb = Verb::kSetJoystickMode, .mode = Mode::kXyz}).view(),
            "SetJoystickMode:XYZ\r\n");
  EXPECT_EQ(encode(Command{.verb = Verb::kMoveJoystick, .deflection = {100, -200, 300}}).view(),
            "MoveJoystick:100:-200:300\r\n");
}

TEST(KinovaCommand, SurvivesTheWireInBothProfiles) {
  test::for_all([](std::int32_t x, std::int32_t y, std::int32_t z) {
    Command command{.verb = static_cast<Verb>(*rc::gen::inRange(0, 13))};
    if (command.verb == Verb::kMoveJoystick) command.deflection = {x, y, z};
    if (command.verb == Verb::kSetJoystickMode) {
      command.mode = static_cast<Mode>(*rc::gen::inRange(0, 5));
    }
    const bool has_objective =
        command.verb == Verb::kRunObjective || command.verb == Verb::kSetActiveObjective;
    if (has_objective) command.objective = static_cast<Objective>(*rc::gen::inRange(0, 9));
    const auto line = encode(command);
    RC_ASSERT(line.view().ends_with("\r\n"));
    const auto text = line.view().substr(0, line.view().size() - 1);
    RC_ASSERT(decode_command(text, kFirmware) == command);
    RC_ASSERT(decode_command(text, kDocumented) == command);
  });
}

TEST(KinovaMessage, HasTheSizesOfTheWire) {  // the log of a real session
  EXPECT_EQ(encode(Event::kAccepted).view(), "Accepted\r\n");
  EXPECT_EQ(encode(Event::kFreezed).view().size(), 9U);
  EXPECT_EQ(encode(Event::kJoystickModeSet).view().size(), 17U);
  EXPECT_EQ(encode(Heartbeat{3}).view(), "Heartbeat:3\r\n");
  EXPECT_EQ(encode(Heartbeat{133}).view(), "Heartbeat:133\r\n");
}

TEST(KinovaMessage, SurvivesTheWire) {
  for (std::size_t i = 0; i < kEventNames.size(); ++i) {
    const auto line = encode(static_cast<Event>(i));
    EXPECT_EQ(decode_message(line.view().substr(0, line.view().size() - 1)),
              ServerMessage{static_cast<Event>(i)});
  }
  for (int flags = 0; flags < 256; ++flags) {
    const Heartbeat heartbeat{static_cast<std::uint8_t>(flags)};
    const auto line = encode(heartbeat);
    EXPECT_EQ(decode_message(line.view().substr(0, line.view().size() - 1)),
              ServerMessage{heartbeat});
  }
}

TEST(KinovaMessage, IsReadStrictly) {
  const std::vector<std::pair<std::string, LineFault>> wrong{
      {"", LineFault::kEmpty},
      {"\r", LineFault::kEmpty},
      {"Accepted", LineFault::kNoCarriageReturn},
      {"accepted\r", LineFault::kUnknownWord},
      {" Accepted\r", LineFault::kUnknownWord},
      {"Accepted:\r", LineFault::kArgumentCount},
      {"Heartbeat\r", LineFault::kArgumentCount},
      {"Heartbeat:\r", LineFault::kNotANumber},
      {"Heartbeat:03\r", LineFault::kNotANumber},
      {"Heartbeat:-1\r", LineFault::kNotANumber},
      {"Heartbeat:+3\r", LineFault::kNotANumber},
      {"Heartbeat:3 \r", LineFault::kNotANumber},
      {"Heartbeat:256\r", LineFault::kNumberTooLarge},
      {"EStop\r", LineFault::kUnknownWord},
  };
  for (const auto& [line, fault] : wrong) {
    const auto message = decode_message(line);
    ASSERT_FALSE(message) << line;
    EXPECT_EQ(message.error(), fault) << line;
  }
}

TEST(KinovaLineFault, HasWordsForEachKind) {
  std::set<std::string_view> texts;
  for (std::size_t i = 0; i < kLineFaultCount; ++i)
    texts.insert(describe(static_cast<LineFault>(i)));
  EXPECT_EQ(texts.size(), kLineFaultCount);
}

}  // namespace
}  // namespace armjig::kinovazed
