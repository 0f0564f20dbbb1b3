// SPDX-License-Identifier: Apache-2.0
// What the shipped PC program takes, line by line. Source: reference of the host software,
// "Script acceptance"; the lines are quoted from there.
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

ParseResult parse_program_line(std::string_view line) {
  return parse("Begin()\n" + std::string{line} + "\nEnd()\n", Dialect::kCommander);
}

/// The command of a line that passes the name check.
Command command_of(std::string_view line) {
  const auto program = parse_program_line(line);
  if (!program) {
    ADD_FAILURE() << describe(program.error().front(), "line");
    return Dummy{};
  }
  return program->statements.at(1).command;
}

Move move_of(std::string_view line) {
  const auto command = command_of(line);
  const auto* const move = std::get_if<Move>(&command);
  EXPECT_NE(move, nullptr) << line;
  return move == nullptr ? Move{} : *move;
}

struct Taken {
  std::string_view line;
  parol6::planning::Timing timing;
  Tracking tracking{};
  std::string_view ignored{};  ///< behind what was understood
};

class TakenMove : public ::testing::TestWithParam<Taken> {};

TEST_P(TakenMove, IsUnderstoodAsTheCommanderDoes) {
  const auto& expected = GetParam();
  const auto move = move_of(expected.line);
  EXPECT_EQ(move.timing.speed, expected.timing.speed);
  EXPECT_EQ(move.timing.acceleration, expected.timing.acceleration);
  EXPECT_EQ(move.timing.duration, expected.timing.duration);
  EXPECT_EQ(move.timing.law, expected.timing.law);
  EXPECT_EQ(move.tracking, expected.tracking);
  const auto remarks = parse_program_line(expected.line)->remarks;
  ASSERT_EQ(remarks.size(), expected.ignored.empty() ? 0U : 1U);
  for (const auto& remark : remarks) EXPECT_THAT(remark.text, HasSubstr(expected.ignored));
}

constexpr auto kPositions = Tracking::kSpeedAndPosition;
INSTANTIATE_TEST_SUITE_P(
    Reference, TakenMove,
    ::testing::Values(
        Taken{"MoveJoint(0,-90,180,0,0,180,t=4,trap,speed)",
              {.duration = 4, .law = Law::kTrapezoid},
              Tracking::kSpeed},
        Taken{"MoveJoint(0, -90 , 180, 0,0,180 , t = 4 )", {.duration = 4}, kPositions},
        Taken{"MoveJoint(0,-90,180,0,0,180,speed)", {}, Tracking::kSpeed},
        Taken{"MoveJoint(0,-90,180,0,0,180,speed,trap)", {}, Tracking::kSpeed, "',trap)'"},
        Taken{
            "MoveJoint(0,-90,180,0,0,180,a=50,v=50)", {.acceleration = 50}, kPositions, "',v=50)'"},
        Taken{"MoveJoint(0,-90,180,0,0,180,t=4,v=50)", {.duration = 4}, kPositions, "',v=50)'"},
        Taken{"MoveJoint(0,-90,180,0,0,180,t=4.)", {.duration = 4}, kPositions, "'.)'"},
        Taken{"MoveCart(34.564,-140.522,216.188,77.031,-19.574,141.983.t=9)",
              {},
              kPositions,
              "'.t=9)'"}));

TEST(CommanderScript, TakesTheNumbersInFrontOfADroppedDuration) {
  const auto move = move_of("MoveCart(34.564,-140.522,216.188,77.031,-19.574,141.983.t=9)");
  EXPECT_EQ(move.kind, Move::Kind::kLine);
  EXPECT_THAT(move.target,
              ::testing::ElementsAre(34.564, -140.522, 216.188, 77.031, -19.574, 141.983));
}

struct Flawed {
  std::string_view line;
  Flaw::Effect effect{};
};

class FlawedLine : public ::testing::TestWithParam<Flawed> {};

TEST_P(FlawedLine, IsFoundOnlyWhenTheProgramGetsThere) {
  const auto command = command_of(GetParam().line);
  const auto* const flaw = std::get_if<Flaw>(&command);
  ASSERT_NE(flaw, nullptr);
  EXPECT_EQ(flaw->effect, GetParam().effect);
  EXPECT_FALSE(flaw->why.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Reference, FlawedLine,
    ::testing::Values(
        Flawed{"MoveJoint(.5,-90,180,0,0,180)", Flaw::Effect::kStops},
        Flawed{"MoveJoint(1e1,-90,180,0,0,180)", Flaw::Effect::kStops},
        Flawed{"MoveJoint(+1,-90,180,0,0,180)", Flaw::Effect::kStops},
        Flawed{"MoveJoint(0,-90,180,0,0)", Flaw::Effect::kStops},
        Flawed{"Delay(0.01)", Flaw::Effect::kStops}, Flawed{"Delay()", Flaw::Effect::kStops},
        Flawed{"Delay(abc)", Flaw::Effect::kStops}, Flawed{"Delay(nan)", Flaw::Effect::kStops},
        Flawed{"Delay(inf)", Flaw::Effect::kStops}, Flawed{"Output(1, HIGH)", Flaw::Effect::kStops},
        Flawed{"Output(2,HIGH)", Flaw::Effect::kStops},
        Flawed{"Gripper(120,30,50)", Flaw::Effect::kSkipped},
        Flawed{"Gripper(120.5,30,500)", Flaw::Effect::kSkipped},
        Flawed{"Gripper(256,30,500)", Flaw::Effect::kSkipped},
        Flawed{"Gripper(1,2)", Flaw::Effect::kSkipped},
        Flawed{"Gripper(1,2,300,4)", Flaw::Effect::kSkipped},
        Flawed{"Home()", Flaw::Effect::kHangs}, Flawed{"Input()", Flaw::Effect::kHangs},
        Flawed{"SpeedJoint()", Flaw::Effect::kHangs}, Flawed{"Begin()", Flaw::Effect::kHangs}));

struct Unknown {
  std::string_view line;
  int column{};
};

class UnknownLine : public ::testing::TestWithParam<Unknown> {};

TEST_P(UnknownLine, KeepsTheProgramFromStarting) {
  const auto program = parse_program_line(GetParam().line);
  ASSERT_FALSE(program.has_value());
  ASSERT_EQ(program.error().size(), 1U);
  EXPECT_EQ(program.error().front().place, (Place{2, GetParam().column}));
}

INSTANTIATE_TEST_SUITE_P(
    Reference, UnknownLine,
    ::testing::Values(Unknown{"MoveJoint(0,-90,180,0,0,180) ", 29},
                      Unknown{"movejoint(0,-90,180,0,0,180)", 1}, Unknown{"Delay(1.5) // x", 11},
                      Unknown{"MoveJoint(0,-90,180,0,0,180", 11}, Unknown{"Delay(1)Delay(2)", 9},
                      Unknown{"SpeedCart()", 1}, Unknown{" Delay(1)", 1}, Unknown{"   ", 1},
                      Unknown{"Delay (1)", 6}, Unknown{"Delay((1))", 10}));

TEST(CommanderScript, ReadsWhatItTakesOfTheOtherCommands) {
  const auto output = command_of("Output(1,HIGH)");
  EXPECT_EQ(std::get<Output>(output).level, Output::Level::kHigh);
  EXPECT_DOUBLE_EQ(std::get<Delay>(command_of("Delay( 1.5e0 )")).seconds, 1.5);
  const auto gripper = std::get<GripperMove>(command_of("Gripper(120, 30,500)"));
  EXPECT_EQ(gripper.position, 120);
  EXPECT_EQ(gripper.current, Milliamperes{500});
}

TEST(CommanderScript, RemovesLinesOnlyIfTheyAreEmpty) {
  EXPECT_TRUE(parse("\nBegin()\n\n\r\nEnd()\n", Dialect::kCommander).has_value());
}

TEST(CommanderScript, WantsBeginInFrontAndEndOrLoopBehind) {
  EXPECT_TRUE(parse("Begin()\nLoop()", Dialect::kCommander).has_value());
  EXPECT_FALSE(parse("Dummy()\nEnd()", Dialect::kCommander).has_value());
  EXPECT_FALSE(parse("Begin()\nDummy()", Dialect::kCommander).has_value());
  EXPECT_FALSE(parse("", Dialect::kCommander).has_value());
}

}  // namespace
}  // namespace armjig::script
