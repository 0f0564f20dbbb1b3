// SPDX-License-Identifier: Apache-2.0
#include "harness/script/interpreter.hpp"

#include <gmock/gmock.h>

#include "tests/unit/script/programs.hpp"

namespace armjig::script {
namespace {

using parol6::Command;
using parol6::JointSteps;
using test::program_of;

constexpr std::string_view kMove = "MoveJoint(70, -90, 180, 0, 0, 180, t=1)";

/// Calls it with one place until it ends; how many frames it has sent.
int frames_until_end(Interpreter& interpreter, const JointSteps& position) {
  int count = 0;
  while (true) {
    const auto frame = interpreter.next(position);
    EXPECT_TRUE(frame.has_value());
    if (!frame || !*frame) return count;
    ++count;
  }
}

TEST(Interpreter, HoldsTheLastSetPointUntilTheJointsAreThere) {
  const auto program = program_of(kMove, Dialect::kDocumented);
  Interpreter interpreter{program, {}};
  for (int k = 0; k <= 100; ++k) ASSERT_TRUE(interpreter.next(test::kStandby).has_value());
  const auto goal = interpreter.move()->position();
  auto nearly = goal;
  nearly[0] = nearly[0] + Steps{1};
  for (int held = 0; held < 3; ++held) {
    const auto frame = interpreter.next(nearly);
    ASSERT_TRUE(frame && *frame);
    EXPECT_EQ((*frame)->position, goal);
    EXPECT_EQ((*frame)->command, Command::kGoTo);
  }
  const auto end = interpreter.next(goal);
  ASSERT_TRUE(end.has_value());
  EXPECT_FALSE(end->has_value());
}

TEST(Interpreter, DoesNotWaitForEverForJointsThatDoNotCome) {
  const auto program = program_of(kMove, Dialect::kDocumented);
  Interpreter interpreter{program, {}};
  EXPECT_EQ(frames_until_end(interpreter, test::kStandby), 101 + 20);
}

TEST(Interpreter, DoesNotHoldWhatFollowsSpeeds) {
  const auto program =
      program_of("MoveJoint(70, -90, 180, 0, 0, 180, t=1, speed)", Dialect::kDocumented);
  Interpreter interpreter{program, {}};
  EXPECT_EQ(frames_until_end(interpreter, test::kStandby), 101);
}

TEST(Interpreter, TheCommanderDoesNotWait) {
  const auto program = program_of("MoveJoint(0,-90,180,0,0,180,t=1)", Dialect::kCommander);
  Interpreter interpreter{program, {}};
  EXPECT_EQ(frames_until_end(interpreter, test::kStandby), 101 + 1);  // the move's and End()'s
}

TEST(Interpreter, PlansEachMoveFromWhereTheJointsAre) {
  const auto program = program_of(kMove, Dialect::kDocumented);
  Interpreter interpreter{program, {}};
  auto position = test::kStandby;
  position[0] = Steps{5000};
  const auto frame = interpreter.next(position);
  ASSERT_TRUE(frame && *frame);
  EXPECT_EQ((*frame)->position, position);
  EXPECT_EQ(interpreter.move()->start, position);
  EXPECT_EQ(interpreter.statement(), 1U);
}

TEST(Interpreter, FramesOfSpeedsCarryThePlaceOfTheStart) {
  const auto program =
      program_of("MoveJoint(70, -90, 180, 0, 0, 180, t=1, speed)", Dialect::kDocumented);
  Interpreter interpreter{program, {}};
  for (int k = 0; k <= 100; ++k) {
    const auto frame = interpreter.next(test::kStandby);
    ASSERT_TRUE(frame && *frame);
    EXPECT_EQ((*frame)->position, test::kStandby);
    EXPECT_EQ((*frame)->command, Command::kJog);
  }
  EXPECT_EQ(interpreter.move()->position()[0], Steps{7964});
}

}  // namespace
}  // namespace armjig::script
