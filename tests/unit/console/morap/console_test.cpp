// SPDX-License-Identifier: Apache-2.0
#include "harness/console/morap/console.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/unit/console/transcript.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig::morap::console {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A person and a bus on virtual time, with nodes 1 and 2 and a pen.
class NodeConsole : public ::testing::Test {
 protected:
  NodeConsole() {
    constexpr auto kTarget = "emulated:?nodes=1,2&pen=yes";
    console_ = *open(test::emulated<cli::OnBus>("morap", kTarget), kTarget, transcript_.say());
    EXPECT_TRUE(console_->find_device().value_or(false));
  }
  std::string run(std::string_view line) { return transcript_.run(*console_, line); }

  Transcript transcript_;
  std::unique_ptr<DeviceConsole> console_;
};

TEST_F(NodeConsole, DrivesANodeToAnAngle) {
  EXPECT_EQ(console_->occupation(), "node 2");
  EXPECT_EQ(run("calibrate"), "calibrated\n");
  EXPECT_EQ(run("goto 0.5"), "sent\n");
  EXPECT_EQ(run("wait 2"), "");
  EXPECT_THAT(run("status"), AllOf(HasSubstr("enabled"), HasSubstr("0.4")));
}

TEST_F(NodeConsole, DisablesEveryNodeThatWasToldToMove) {
  EXPECT_EQ(run("stop"), "nothing moves\n");
  EXPECT_EQ(run("volt 1"), "sent\n");
  EXPECT_EQ(run("volt 2"), "sent\n");
  EXPECT_EQ(run("node 1"), "node 1\n");
  EXPECT_EQ(run("torque 0.01"), "sent\n");
  EXPECT_EQ(run("stop"), "node 2 is disabled\nnode 1 is disabled\n");
  EXPECT_EQ(run("stop"), "nothing moves\n");
}

TEST_F(NodeConsole, SaysWhoAnswersAndThatSomebodyDoesNot) {
  EXPECT_EQ(run("scan"), "0x11 0x12 0x19\n");
  EXPECT_EQ(run("node 3"), "node 3\n");
  EXPECT_EQ(run("status"), "! nobody acknowledges the address\n");
  EXPECT_EQ(run("speed 1"), "! nobody acknowledges the address\n");
}

TEST_F(NodeConsole, TunesANode) {
  EXPECT_THAT(run("tune pd 0.2 -9"), StartsWith("controller = \"position\""));
  EXPECT_THAT(run("tune px 0.2 -9"), HasSubstr("? the type is pd, pid or pi; usage: tune"));
  EXPECT_THAT(run("tune pd 0.2 9"), HasSubstr("? the pole has to be below 0"));
  EXPECT_EQ(run("defaults"), "loaded\n");
}

TEST_F(NodeConsole, MovesThePen) {
  EXPECT_EQ(run("pen deploy"), "sent\n");
  EXPECT_EQ(run("pen 128"), "sent\n");
  EXPECT_THAT(run("pen 256"), HasSubstr("? '256' is no position"));
}

TEST_F(NodeConsole, SaysWhatItCannotRead) {
  EXPECT_THAT(run("goto there"), HasSubstr("? 'there' is not a number"));
  EXPECT_THAT(run("goto nan"), HasSubstr("? 'nan' is not a number"));
  EXPECT_THAT(run("node 17"), HasSubstr("? '17' is no node"));
  EXPECT_THAT(run("program /nonexistent"), StartsWith("? /nonexistent"));
}

}  // namespace
}  // namespace armjig::morap::console
