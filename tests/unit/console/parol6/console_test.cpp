// SPDX-License-Identifier: Apache-2.0
#include "harness/console/parol6/console.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "tests/unit/console/transcript.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig::parol6::console {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A person and a board on virtual time.
class BoardConsole : public ::testing::Test {
 protected:
  BoardConsole() {
    auto rig = test::emulated<cli::OnStream>("parol6");
    port_ = &rig.port();
    console_ = *open(std::move(rig), "emulated:", transcript_.say());
    EXPECT_TRUE(console_->find_device().value_or(false));
  }
  std::string run(std::string_view line) { return transcript_.run(*console_, line); }
  void pass(Duration time) {
    for (const auto end = console_->now() + time; console_->now() < end;) {
      ASSERT_TRUE(console_->cycle());
    }
  }

  Transcript transcript_;
  StreamPort* port_ = nullptr;
  std::unique_ptr<DeviceConsole> console_;
};

TEST_F(BoardConsole, JogsForATimeAndStands) {
  EXPECT_EQ(run("enable"), "enabled\n");
  EXPECT_THAT(run("jog j1 500 0.5"), AllOf(StartsWith("moved +"), HasSubstr("j1 ")));
  EXPECT_EQ(console_->occupation(), "");
  EXPECT_THAT(run("status"), HasSubstr("estop      released"));
}

TEST_F(BoardConsole, JogsUntilItIsStopped) {
  EXPECT_EQ(run("enable"), "enabled\n");
  EXPECT_THAT(run("jog j2 10deg"), HasSubstr("j2"));
  EXPECT_EQ(console_->occupation(), "jog");
  pass(1s);
  EXPECT_THAT(run("stop"), HasSubstr("stopped"));
  EXPECT_EQ(console_->occupation(), "");
}

TEST_F(BoardConsole, TellsHowLongItHomesAndThatItWasEnded) {
  console_->begin("home");
  pass(2s);
  EXPECT_EQ(console_->occupation(), "home 2 s");
  (void)transcript_.take();
  console_->begin("jog j1 100");
  EXPECT_EQ(transcript_.take(), "! home is still going on; 'stop' ends it\n");
  EXPECT_THAT(run("disable"), AllOf(StartsWith("* home is ended\n"), EndsWith("disabled\n")));
}

TEST_F(BoardConsole, LatchesTheEmergencyStop) {
  ASSERT_TRUE(port_->touch("estop", 0));
  pass(100ms);
  EXPECT_THAT(transcript_.take(), HasSubstr("* EMERGENCY STOP pressed"));
  EXPECT_EQ(console_->occupation(), "ESTOP");
  EXPECT_EQ(run("estop"), "PRESSED, latched: 'enable' ends it\n");
  EXPECT_THAT(run("home"), HasSubstr("! refused: the emergency stop is pressed"));
  ASSERT_TRUE(port_->touch("estop", 1));
  pass(100ms);
  EXPECT_THAT(transcript_.take(), HasSubstr("* emergency stop released"));
  EXPECT_THAT(run("home"), HasSubstr("! refused: the emergency stop is latched"));
  EXPECT_EQ(run("enable"), "enabled\n");
}

TEST_F(BoardConsole, SaysWhatItCannotRead) {
  EXPECT_THAT(run("jog j7 100"), HasSubstr("? 'j7' is no joint: they are j1 to j6; usage: jog"));
  EXPECT_THAT(run("jog j1"), StartsWith("? usage: jog"));
  EXPECT_THAT(run("jog world q 1"), HasSubstr("? 'q' is no axis"));
  EXPECT_THAT(run("jog j1 100 0"), HasSubstr("is not a time"));
  EXPECT_THAT(run("goto j1"), HasSubstr("? where shall j1 go?"));
  EXPECT_THAT(run("out 3 on"), HasSubstr("? '3 on' is no state of an output"));
  EXPECT_THAT(run("gripper move 256 0 100"), HasSubstr("? '256' is no position"));
  EXPECT_THAT(run("gripper"), StartsWith("? usage: gripper"));
}

TEST_F(BoardConsole, SwitchesAnOutputAndSaysWhatTheLinkDid) {
  EXPECT_EQ(run("wait 1"), "waited 1 s\n");
  EXPECT_THAT(run("out 2 on"), Not(HasSubstr("!")));
  EXPECT_THAT(run("status"), HasSubstr("out1 off, out2 on"));
  EXPECT_THAT(run("stats"), ContainsRegex("link       [0-9]+ sent, [0-9]+ answered, 0 lost"));
}

TEST_F(BoardConsole, MakesTheArmStandBeforeItLeaves) {
  EXPECT_EQ(run("enable"), "enabled\n");
  EXPECT_THAT(run("jog j1 500"), HasSubstr("j1"));
  ASSERT_TRUE(console_->leave());
  EXPECT_FALSE(console_->is_busy());
  EXPECT_THAT(transcript_.take(), HasSubstr("stopped"));
}

}  // namespace
}  // namespace armjig::parol6::console
