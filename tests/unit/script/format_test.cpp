// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <string>

#include "harness/script/format.hpp"

namespace armjig::script {
namespace {

TEST(Format, BringsADocumentedProgramIntoOneStyle) {
  const auto text = format(
      "\n  // corner\nBegin( )   //go\n\n\n"
      "MoveJoint( 0.50,-90 , 180.0,0,0,  180,v = 50 , a=20,trap,speed )\n"
      "\tOutput(2,HIGH)\nGripper(1,2,300)\nGripper_cal()\nDelay(0.0100)\nLoop()\n\n\n",
      Dialect::kDocumented);
  ASSERT_TRUE(text.has_value());
  EXPECT_EQ(*text,
            "// corner\nBegin()  //go\n\n"
            "MoveJoint(0.5, -90, 180, 0, 0, 180, v=50, a=20, trap, speed)\n"
            "Output(2, HIGH)\nGripper(1, 2, 300)\nGripper_cal()\nDelay(0.01)\nLoop()\n");
}

TEST(Format, WritesForTheCommanderWhatItUnderstands) {
  const auto text = format(
      "Begin()\n\nMoveJoint(0, -90 , 180, 0,0,180,a=50,v=50)\n"
      "MoveCart(34.564,-140.522,216.188,77.031,-19.574,141.983.t=9)\n"
      "Output(2,HIGH)\nHome()\nEnd()",
      Dialect::kCommander);
  ASSERT_TRUE(text.has_value());
  EXPECT_EQ(*text,
            "Begin()\nMoveJoint(0,-90,180,0,0,180,a=50)\n"
            "MoveCart(34.564,-140.522,216.188,77.031,-19.574,141.983)\n"
            "Output(2,HIGH)\nHome()\nEnd()\n");
}

TEST(Format, DoesNotChangeItsOwnText) {
  const std::string program =
      "Begin()\nMoveCartRelTRF(0.00001, -0.1234567, 100000, 0, -0, 1, t=2.5)  // a\n\nEnd()\n";
  const auto once = format(program, Dialect::kDocumented);
  ASSERT_TRUE(once.has_value());
  EXPECT_EQ(format(*once, Dialect::kDocumented), *once);
  EXPECT_THAT(*once, ::testing::HasSubstr("-0.1234567, 100000, 0, -0, 1, t=2.5)  // a"));
}

TEST(Format, WritesSmallNumbersWithoutAnExponent) {
  const auto text = format("Begin()\nMoveCart(0.00001,0,0,0,0,0)\nEnd()", Dialect::kDocumented);
  ASSERT_TRUE(text.has_value());
  const auto again = format(*text, Dialect::kDocumented);
  ASSERT_TRUE(again.has_value()) << describe(again.error().front(), *text);
  EXPECT_EQ(*again, *text);
}

}  // namespace
}  // namespace armjig::script
