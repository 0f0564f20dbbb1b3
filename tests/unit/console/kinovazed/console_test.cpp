// SPDX-License-Identifier: Apache-2.0
#include "harness/console/kinovazed/console.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "tests/unit/console/transcript.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig::kinovazed::console {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A person and a server on virtual time, its emergency stop ended.
class ServerConsole : public ::testing::Test {
 protected:
  ServerConsole() {
    constexpr auto kTarget = "emulated:?plant=bench";
    console_ =
        *open(test::emulated<cli::OnServer>("kinovazed", kTarget), kTarget, transcript_.say());
    EXPECT_TRUE(console_->find_device().value_or(false));
    EXPECT_THAT(run("quitestop"), StartsWith("QuitEStop is done ("));
  }
  std::string run(std::string_view line) { return transcript_.run(*console_, line); }
  void pass(Duration time) {
    for (const auto end = console_->now() + time; console_->now() < end;) {
      ASSERT_TRUE(console_->cycle());
    }
  }

  Transcript transcript_;
  std::unique_ptr<DeviceConsole> console_;
};

TEST_F(ServerConsole, DrivesThroughAnObjective) {
  EXPECT_THAT(run("initialize"), StartsWith("Initialize is done"));
  EXPECT_THAT(run("run Home"), StartsWith("RunObjective:Home is done"));
  EXPECT_THAT(run("retract"), StartsWith("Retract is done"));
  pass(1500ms);  // a beat
  EXPECT_THAT(run("status"), AllOf(HasSubstr("state      retracted"), HasSubstr("at rest")));
  EXPECT_EQ(console_->occupation(), "retracted");
}

TEST_F(ServerConsole, SaysThatTheServerRejectsACommand) {
  EXPECT_THAT(run("run Home"), AllOf(StartsWith("! "), HasSubstr("was rejected")));
}

TEST_F(ServerConsole, HoldsTheStickForATime) {
  EXPECT_THAT(run("initialize"), HasSubstr("done"));
  EXPECT_THAT(run("mode XYZ"), HasSubstr("done"));
  const auto start = console_->now();
  EXPECT_THAT(run("move 100 0 0 2"), AllOf(HasSubstr("MoveJoystick:100:0:0 is done"),
                                           HasSubstr("MoveJoystick:0:0:0 is done")));
  EXPECT_GE(console_->now() - start, 2s) << "a pipe must not go on before it is over";
  EXPECT_LT(console_->now() - start, 2200ms);
}

TEST_F(ServerConsole, HoldsTheStickUntilItIsStopped) {
  EXPECT_THAT(run("initialize"), HasSubstr("done"));
  EXPECT_THAT(run("mode XYZ"), HasSubstr("done"));
  EXPECT_THAT(run("move 0 100 0"), HasSubstr("done"));
  pass(3s);
  EXPECT_EQ(console_->occupation(), "move");
  EXPECT_EQ(transcript_.take(), "") << "renewals are silent";
  EXPECT_THAT(run("stop"), StartsWith("MoveJoystick:0:0:0 is done"));
  EXPECT_EQ(run("stop"), "nothing moves\n");
}

TEST_F(ServerConsole, EndsAMotionByAnEmergencyStop) {
  console_->begin("initialize");
  pass(1s);
  EXPECT_EQ(console_->occupation(), "Initialize 1 s");
  console_->begin("retract");
  EXPECT_EQ(transcript_.take(), "! Initialize is still going on; 'stop' ends it\n");
  EXPECT_THAT(run("stop"),
              AllOf(StartsWith("* Initialize is ended\n"), HasSubstr("EStop is done")));
}

TEST_F(ServerConsole, SaysWhatItCannotRead) {
  EXPECT_THAT(run("run Nowhere"), HasSubstr("? 'Nowhere' is none of Current, Home"));
  EXPECT_THAT(run("mode Sideways"), HasSubstr("is none of NoMode, XYZ"));
  EXPECT_EQ(run("move 1 2"), "? usage: move X Y Z [SECONDS]\n");
  EXPECT_THAT(run("move 1 2 x"), HasSubstr("? 'x' is no deflection"));
  EXPECT_EQ(run("position here"), "? usage: position [objective]\n");
}

}  // namespace
}  // namespace armjig::kinovazed::console
