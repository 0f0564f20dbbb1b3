// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <string>
#include <string_view>
#include <vector>

#include "harness/script/parser.hpp"

namespace armjig::script {
namespace {

using parol6::planning::Law;
using parol6::planning::Move;
using parol6::planning::Tracking;
using ::testing::HasSubstr;

ParseResult parse_line(std::string_view line) {
  return parse("Begin()\n" + std::string{line} + "\nEnd()\n", Dialect::kDocumented);
}

template <class T>
T command_of(std::string_view line) {
  const auto program = parse_line(line);
  if (!program) {
    ADD_FAILURE() << describe(program.error().front(), "line");
    return {};
  }
  const auto* const command = std::get_if<T>(&program->statements.at(1).command);
  EXPECT_NE(command, nullptr) << line;
  return command == nullptr ? T{} : *command;
}

TEST(DocumentedScript, TakesCommentsAndBlanks) {
  const auto program = parse(
      "// turn joint 1\n"
      "\n"
      "  Begin() // here\n"
      "\tMoveJoint( 0 , -90,180, 0,0,180 , t = 4 , trap , speed )// there\r\n"
      "   \r"
      "Loop( )\n",
      Dialect::kDocumented);
  ASSERT_TRUE(program.has_value()) << describe(program.error().front(), "text");
  ASSERT_EQ(program->statements.size(), 3U);
  EXPECT_EQ(program->statements[1].place, (Place{4, 2}));
  EXPECT_EQ(program->statements[2].place, (Place{6, 1}));
  const auto move = std::get<Move>(program->statements[1].command);
  EXPECT_THAT(move.target, ::testing::ElementsAre(0, -90, 180, 0, 0, 180));
  EXPECT_EQ(move.timing.duration, 4);
  EXPECT_EQ(move.timing.law, Law::kTrapezoid);
  EXPECT_EQ(move.tracking, Tracking::kSpeed);
}

TEST(DocumentedScript, TakesBothOutputsAndTheWholeRangeOfCurrents) {
  EXPECT_EQ(command_of<Output>("Output(2, LOW)").number, 2);
  EXPECT_EQ(command_of<GripperMove>("Gripper(10, 20, 1300)").current, Milliamperes{1300});
  EXPECT_EQ(command_of<GripperMove>("Gripper(0, 255, 0)").current, Milliamperes{0});
}

TEST(DocumentedScript, DelaysForOneFrameAtLeast) {
  EXPECT_DOUBLE_EQ(command_of<Delay>("Delay(0.01)").seconds, 0.01);
  EXPECT_FALSE(parse_line("Delay(0.009)").has_value());
}

TEST(DocumentedScript, TellsTheKindsOfMovesApart) {
  EXPECT_EQ(command_of<Move>("MovePose(1,2,3,4,5,6,v=10,a=20)").kind, Move::Kind::kPose);
  EXPECT_EQ(command_of<Move>("MoveCart(1,2,3,4,5,6,t=2)").kind, Move::Kind::kLine);
  EXPECT_EQ(command_of<Move>("MoveCartRelTRF(1,2,3,4,5,6,poly)").kind, Move::Kind::kToolLine);
}

struct Bad {
  std::string_view line;
  int column{};
  std::string_view text;
};

class BadLine : public ::testing::TestWithParam<Bad> {};

TEST_P(BadLine, IsOneErrorAtItsPlace) {
  const auto program = parse_line(GetParam().line);
  ASSERT_FALSE(program.has_value());
  ASSERT_EQ(program.error().size(), 1U);
  EXPECT_EQ(program.error().front().place, (Place{2, GetParam().column}));
  EXPECT_THAT(program.error().front().text, HasSubstr(GetParam().text));
}

INSTANTIATE_TEST_SUITE_P(
    Lines, BadLine,
    ::testing::Values(
        Bad{"Home()", 1, "Home is a name without a meaning"},
        Bad{"  Input()", 3, "Input is a name without a meaning"},
        Bad{"SpeedJoint(1)", 1, "SpeedJoint is a name without a meaning"},
        Bad{"SpeedCart()", 1, "no command 'SpeedCart'"},
        Bad{"movejoint(0,0,0,0,0,0)", 1, "is it MoveJoint?"}, Bad{"123", 1, "no command '123'"},
        Bad{"(1)", 1, "a command should stand here, not '(1)'"}, Bad{"Delay", 6, "'(' is missing"},
        Bad{"Delay(1", 8, "')' is missing"}, Bad{"Delay()", 7, "the delay in seconds is missing"},
        Bad{"Delay(abc)", 7, "should be a number like -12.5, not 'abc)'"},
        Bad{"Delay(1, 2)", 8, "too many arguments"},
        Bad{"Delay(1)Delay(2)", 9, "a line has one command"},
        Bad{"Delay(3601)", 7, "0.01 to 3600, not '3601'"}, Bad{"Dummy(1)", 7, "too many arguments"},
        Bad{"Output(3, HIGH)", 8, "the output is 1 to 2"},
        Bad{"Output(1, high)", 11, "HIGH or LOW, not 'high'"},
        Bad{"Output(1)", 9, "an argument is missing"},
        Bad{"Gripper(120.5,30,500)", 9, "a whole number"},
        Bad{"Gripper(120,30,1301)", 16, "0 to 1300"},
        Bad{"MoveJoint(0,-90,180,0,0)", 24, "an argument is missing"},
        Bad{"MoveJoint(.5,-90,180,0,0,180)", 11, "J1 should be a number"},
        Bad{"MoveJoint(1e1,-90,180,0,0,180)", 12, "',' or ')' in front of 'e1"},
        Bad{"MoveJoint(0,-90,180,0,0,180,t=4.)", 32, "',' or ')' in front of '.)'"},
        Bad{"MoveJoint(0,-90,180,0,0,180,t=0)", 31, "t in seconds is 0.01 to 3600, not '0'"},
        Bad{"MoveJoint(0,-90,180,0,0,180,t=-1)", 31, "not '-1'"},
        Bad{"MoveJoint(0,-90,180,0,0,180,v=101)", 31, "v in percent is 0 to 100, not '101'"},
        Bad{"MoveJoint(0,-90,180,0,0,180,v=50,a=-1)", 36, "a in percent is 0 to 100"},
        Bad{"MoveJoint(0,-90,180,0,0,180,a=5,v=5)", 33, "'v' stands here twice or too late"},
        Bad{"MoveJoint(0,-90,180,0,0,180,trap,poly)", 34, "'poly' stands here twice"},
        Bad{"MoveJoint(0,-90,180,0,0,180,fast)", 29, "no argument 'fast'"},
        Bad{"MoveJoint(0,-90,180,0,0,180,v 50)", 31, "'=' in front of '50)'"},
        Bad{"MoveCart(1,2,3,4,5,6,v=50)", 22, "a move along a line has no 'v'"},
        Bad{"MoveCartRelTRF(1,2,3,4,5,6,a=50)", 28, "a move along a line has no 'a'"},
        Bad{"MoveCart(34.564,-140.522,216.188,77.031,-19.574,141.983.t=9)", 56, "',' or ')'"},
        Bad{"MoveJoint(9999999,0,0,0,0,0)", 11, "-1000000 to 1000000"},
        Bad{"Begin()", 1, "Begin() stands once"}));

TEST(DocumentedScript, NumbersTooLongForAnyTypeAreTooLarge) {
  const auto program = parse_line("Delay(" + std::string(5000, '9') + ")");
  ASSERT_FALSE(program.has_value());
}

TEST(DocumentedScript, TellsEveryLineThatIsWrong) {
  const auto program = parse("Begin()\nWait(1)\nDelay(1)\nStop()\nEnd()", Dialect::kDocumented);
  ASSERT_FALSE(program.has_value());
  ASSERT_EQ(program.error().size(), 2U);
  EXPECT_EQ(program.error()[1].place.line, 4);
}

TEST(DocumentedScript, StopsTellingAfterTwenty) {
  std::string text = "Begin()\n";
  for (int i = 0; i < 1000; ++i) text += "Wait(1)\n";
  const auto program = parse(text, Dialect::kDocumented);
  ASSERT_FALSE(program.has_value());
  EXPECT_EQ(program.error().size(), 20U);
}

TEST(DocumentedScript, WantsBeginInFrontAndEndOrLoopBehind) {
  const auto no_begin = parse("Dummy()\nEnd()", Dialect::kDocumented);
  ASSERT_FALSE(no_begin.has_value());
  EXPECT_THAT(no_begin.error().front().text, HasSubstr("Begin()"));
  const auto no_end = parse("Begin()\nDummy()\n// the end", Dialect::kDocumented);
  ASSERT_FALSE(no_end.has_value());
  EXPECT_EQ(no_end.error().front().place, (Place{2, 1}));
  const auto nothing = parse("// nothing\n\n", Dialect::kDocumented);
  ASSERT_FALSE(nothing.has_value());
  EXPECT_EQ(nothing.error().front().place, (Place{2, 1}));
}

class Hostile : public ::testing::TestWithParam<Dialect> {};

TEST_P(Hostile, BytesThatAreNoTextAreOneError) {
  const std::string_view binary{"Begin()\nDe\0lay(1)\n\x7F\x45LF", 23};
  const auto program = parse(binary, GetParam());
  ASSERT_FALSE(program.has_value());
  ASSERT_EQ(program.error().size(), 1U);
  EXPECT_EQ(describe(program.error().front(), "a.out"),
            "a.out:2:3: error: byte 0x00: this is no text");
}

TEST_P(Hostile, AHugeTextIsRefusedUnread) {
  const auto program = parse(std::string(kMostBytes + 1, '('), GetParam());
  ASSERT_FALSE(program.has_value());
  EXPECT_THAT(program.error().front().text, HasSubstr("longer than 1 MiB"));
}

TEST_P(Hostile, NestingAsDeepAsTheTextIsOneError) {
  const auto line = "Delay" + std::string(500'000, '(') + std::string(500'000, ')');
  const auto program = parse("Begin()\n" + line + "\nEnd()", GetParam());
  ASSERT_FALSE(program.has_value());
  EXPECT_EQ(program.error().size(), 1U);
  EXPECT_LT(program.error().front().text.size(), 200U);
}

INSTANTIATE_TEST_SUITE_P(Dialects, Hostile,
                         ::testing::Values(Dialect::kDocumented, Dialect::kCommander));

}  // namespace
}  // namespace armjig::script
