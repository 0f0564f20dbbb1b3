// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/siblings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "harness/wire/morap/dissector.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::campaign {
namespace {

Script command_of(const parol6::CommandFrame& frame) {
  const auto bytes = parol6::encode(frame);
  return {{.kind = LinkKind::kStream,
           .direction = Direction::kToDevice,
           .bytes = {bytes.begin(), bytes.end()}}};
}

parol6::CommandFrame jog_of(std::size_t joint) {
  parol6::CommandFrame frame{.command = parol6::Command::kJog};
  frame.speed[joint] = StepsPerSecond{1234};
  return frame;
}

TEST(Siblings, HaveTheSameCommandForEachOtherJoint) {
  const auto others =
      for_siblings(command_of(jog_of(0)), "position.j1", parol6::make_dissector, nullptr);
  ASSERT_EQ(others.size(), 5U);
  EXPECT_NE(std::ranges::find(others, command_of(jog_of(5))), others.end());
}

TEST(Siblings, AreNoneWhereNoFieldHasANumberOrNothingChanges) {
  EXPECT_TRUE(
      for_siblings(command_of(jog_of(0)), "homed", parol6::make_dissector, nullptr).empty());
  EXPECT_TRUE(for_siblings(command_of({.command = parol6::Command::kHome}), "position.j1",
                           parol6::make_dissector, nullptr)
                  .empty());
}

Symptom wrong(const std::string& part, const std::string& expected, const std::string& actual) {
  return {.asked = "command jog",
          .answer = "telemetry",
          .parts = {part},
          .expected = part + " " + expected,
          .actual = part + " " + actual};
}

TEST(Siblings, AreAlikeWhereTheyAreWrongInTheSameManner) {
  const auto one = wrong("speed.j1", "100 steps/s", "-100 steps/s");
  EXPECT_TRUE(are_alike(one, wrong("speed.j2", "700 steps/s", "-700 steps/s")));
  EXPECT_FALSE(are_alike(one, wrong("speed.j2", "700 steps/s", "1400 steps/s")));
  EXPECT_FALSE(are_alike(one, wrong("position.j2", "700 steps", "-700 steps")));
  EXPECT_TRUE(are_alike(wrong("speed.j1", "100", "101"), wrong("speed.j2", "5", "6")));
}

TEST(Siblings, ReadWhatWasCutAsAWhole) {
  const Script script{{.kind = LinkKind::kBus,
                       .direction = Direction::kFromDevice,
                       .details = R"("n":3,"ack":"")"}};
  EXPECT_EQ(with_whole_reads(script).front().details, R"("n":80,"ack":"")");
  EXPECT_EQ(with_whole_reads(with_whole_reads(script)), with_whole_reads(script));
}

}  // namespace
}  // namespace armjig::campaign
