// SPDX-License-Identifier: Apache-2.0
#include "harness/script/check.hpp"

#include <gmock/gmock.h>

#include "tests/unit/script/programs.hpp"

namespace armjig::script {
namespace {

using test::program_of;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

std::vector<std::string> said(std::string_view lines, Dialect dialect = Dialect::kDocumented) {
  std::vector<std::string> texts;
  for (const auto& diagnostic : check(program_of(lines, dialect))) {
    texts.push_back(describe(diagnostic, "p"));
  }
  return texts;
}

TEST(Check, HasNothingToSayOfAGoodProgram) {
  EXPECT_THAT(said("MoveJoint(0, -90, 180, 0, 0, 180, t=4, trap)\n"
                   "MoveJoint(0, -90, 180, 0, 0, 180, v=4, a=5, speed)\n"
                   "Gripper(1, 2, 300)\nDelay(1)\nMoveCart(1, 2, 3, 4, 5, 6)\n"
                   "Gripper_cal()\nDelay(2)\nDelay(2)\nGripper(1, 2, 300)"),
              IsEmpty());
}

TEST(Check, FindsAGripperThatIsNotWaitedFor) {
  EXPECT_THAT(said("Gripper(1, 2, 300)\nMoveJoint(0, -90, 180, 0, 0, 180)"),
              ElementsAre(HasSubstr("p:3:1: warning: the gripper is not waited for")));
  EXPECT_THAT(said("Gripper_cal()\nDelay(2)\nGripper(1, 2, 300)"),
              ElementsAre(HasSubstr("p:4:1: warning: the gripper's calibration takes 4 s, and is "
                                    "given 2.00")));
}

TEST(Check, FindsAGripperThatIsNotWaitedForFromOnePassToTheNext) {
  const auto is_found = Contains(AllOf(HasSubstr("p:2:1: warning: the gripper is not waited for"),
                                       HasSubstr("on the way from Loop")));
  const std::string pass = "MoveJoint(0, -90, 180, 0, 0, 180)\nGripper(1, 2, 300)\n";
  EXPECT_THAT(said(pass + "Loop()"), is_found);
  EXPECT_THAT(said(pass + "Delay(1)\nLoop()"), Not(is_found));
  EXPECT_THAT(said(pass), Not(is_found));
}

TEST(Check, FindsArgumentsThatDoNothing) {
  EXPECT_THAT(said("MoveJoint(0, -90, 180, 0, 0, 180, v=4, t=5)"),
              ElementsAre(HasSubstr("v and a do nothing beside t")));
  EXPECT_THAT(said("MoveJoint(0, -90, 180, 0, 0, 180, v=4)"),
              ElementsAre(HasSubstr("v and a count only together")));
  EXPECT_THAT(said("MovePose(0, -90, 180, 0, 0, 180, v=4, a=4, poly)"),
              ElementsAre(HasSubstr("trap and poly do nothing without t")));
  EXPECT_THAT(said("MoveCart(0,0,0,0,0,0,v=4,a=4)", Dialect::kCommander),
              ElementsAre(HasSubstr("v and a do nothing on a line")));
}

TEST(Check, FindsWhatIsNeverReached) {
  EXPECT_THAT(said("Delay(1)\nEnd()\nDelay(1)"),
              ElementsAre(HasSubstr("p:4:1: warning: this is never reached")));
}

TEST(Check, FindsWhereTheCommanderStumbles) {
  EXPECT_THAT(said("Gripper(1,2,5)\nDelay(1)\nHome()\nDelay()", Dialect::kCommander),
              ElementsAre(HasSubstr("p:2:1: warning: the commander skips this"),
                          HasSubstr("p:4:1: error: the commander has no code"),
                          HasSubstr("p:5:1: error: the delay '' is no number")));
}

TEST(Check, SaysHowLongItTakes) {
  const auto program = program_of("Delay(1.5)", Dialect::kDocumented);
  const auto found = check(program, test::schedule_of(program));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(describe(found.front(), "p"), "p:3:1: note: takes 1.50 s");
}

std::vector<std::string> commander_says(std::string_view lines) {
  const auto program = test::program_of(lines, Dialect::kCommander);
  std::vector<std::string> texts;
  for (const auto& one : inspect(program, {}, test::kStandby).found) {
    if (one.severity != Severity::kNote) texts.push_back(one.text);
  }
  return texts;
}

TEST(Check, WarnsOfWhatTheCommanderDoesNotLookAt) {
  EXPECT_THAT(commander_says("MoveJoint(90,-90,180,0,0,180,t=4)\nMoveJoint(90,-90,180,0,0,180)"),
              ElementsAre(HasSubstr("the joints are there already")));
  EXPECT_THAT(commander_says("MoveJoint(0,-90,180,0,0,180,t=0.6)"),
              ElementsAre(HasSubstr("it can do 6500")));
}

TEST(Check, SaysOfEachMoveThatItCannotBePlannedUnlessItBeginsWhereSuchAOneEnds) {
  EXPECT_THAT(commander_says("MoveJoint(900,-90,180,0,0,180,t=4)\n"
                             "MoveCart(250,0,330,90,0,90,t=4)\n"
                             "MoveJoint(80,-90,180,0,0,180,t=4)\n"
                             "MoveJoint(80,-90,900,0,0,180,t=4)"),
              ElementsAre(HasSubstr("j1"), HasSubstr("j3")));
}

TEST(Check, SaysOfTwentyMovesThatTheyCannotBePlannedAndLeavesItAtThat) {
  std::string text;
  for (int i = 0; i < 30; ++i) text += "MoveJoint(900,-90,180,0,0,180,t=4)\n";
  EXPECT_THAT(commander_says(text), SizeIs(20));
}

TEST(Check, SaysAllErrorsAtOnceAndWarningsBesideThem) {
  EXPECT_THAT(commander_says("Home()\nGripper(1,2,3)\nDelay(x)"),
              ElementsAre(HasSubstr("hangs"), HasSubstr("skips"), HasSubstr("no number")));
}

}  // namespace
}  // namespace armjig::script
