// SPDX-License-Identifier: Apache-2.0
#include "harness/console/device_console.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <string>
#include <utility>

#include "tests/unit/console/transcript.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;

/// A crane that turns for a second, on a clock of its own.
class Crane final : public DeviceConsole {
 public:
  explicit Crane(Say say)
      : DeviceConsole{rows(), "crane:", std::move(say), {1s, "is it plugged in?"}} {}

  Instant now() override { return now_; }

  bool is_plugged = true;
  bool is_gone = false;
  int stood = 0;

 private:
  static std::span<const Row> rows() noexcept {
    static constexpr std::array kRows{
        Row{"turn", "left|right [FAR]", "turn for a second", When::kAlone, run<&Crane::turn>,
            "left right|far"},
        Row{"hoot", "", "make a noise", When::kAlways, run<&Crane::hoot>, ""},
        Row{"lift", "BOX ...", "lift boxes", When::kAlone, run<&Crane::lift>, ""},
        Row{"hook", "open | close SOFTLY", "use the hook", When::kAlone, run<&Crane::hook>, ""},
    };
    return kRows;
  }

  Outcome<void> exchange() override {
    now_ += 10ms;
    if (is_gone) return gone(ErrorCode::kDisconnected, "look for it");
    if (!name().empty() && name() != "wait" && now_ - began() >= 1s) {
      end();
      say(Tone::kAnswer, "turned");
    }
    return {};
  }
  bool hears_the_device() const override { return is_plugged && now_ >= Instant{50ms}; }
  Parsed<std::string> state() override {
    if (!is_plugged) return wrong("it says nothing");
    return "upright";
  }
  void stand() override {
    ++stood;
    if (name().empty()) say(Tone::kAnswer, "stands");
  }

  Read turn(Words words) {
    if (words[0] != "left" && words[0] != "right") return wrong("it cannot turn there");
    go_on("turn");
    return {};
  }
  void hoot() { say(Tone::kAnswer, "hoot"); }
  void lift(Words words) { say(Tone::kAnswer, std::to_string(words.size())); }
  Read hook(Words words) {
    if (words.empty()) return wrong("");
    return {};
  }

  Instant now_{};
};

class DeviceConsoleTest : public ::testing::Test {
 protected:
  std::string said_to(std::string_view line) {
    crane_.begin(line);
    return transcript_.take();
  }
  Transcript transcript_;
  Crane crane_{transcript_.say()};
};

TEST_F(DeviceConsoleTest, DoesNothingForABlankLineOrAComment) {
  EXPECT_EQ(said_to(""), "");
  EXPECT_EQ(said_to(" \t\r"), "");
  EXPECT_EQ(said_to("# turn left"), "");
  EXPECT_FALSE(crane_.is_busy());
}

TEST_F(DeviceConsoleTest, SaysThatThereIsNoSuchCommand) {
  EXPECT_EQ(said_to("fly high"), "? there is no command 'fly'; 'help' lists them\n");
}

TEST_F(DeviceConsoleTest, CountsTheWordsByTheUsageThatItShows) {
  EXPECT_EQ(said_to("hoot loud"), "? usage: hoot\n");
  EXPECT_EQ(said_to("turn"), "? usage: turn left|right [FAR]\n");
  EXPECT_EQ(said_to("turn left far away"), "? usage: turn left|right [FAR]\n");
  EXPECT_EQ(said_to("lift"), "? usage: lift BOX ...\n");
  EXPECT_EQ(said_to("lift a b c"), "3\n");
  EXPECT_EQ(said_to("hook"), "? usage: hook open | close SOFTLY\n");
  EXPECT_EQ(said_to("hook close softly"), "") << "alternatives are the command's to count";
}

TEST_F(DeviceConsoleTest, SaysWhyAWordCannotBeReadAndTheUsage) {
  EXPECT_EQ(said_to("turn up"), "? it cannot turn there; usage: turn left|right [FAR]\n");
}

TEST_F(DeviceConsoleTest, ListsTheCommandsOfAllDevicesAndItsOwn) {
  const auto all = said_to("help");
  for (const auto* const name : {"help", "status", "turn", "hoot", "stop", "wait", "quit"}) {
    EXPECT_THAT(all, HasSubstr(name));
  }
  EXPECT_EQ(said_to("help hoot"), "hoot                      make a noise\n");
  EXPECT_EQ(said_to("help fly"), "? there is no command 'fly'; usage: help [COMMAND]\n");
}

TEST_F(DeviceConsoleTest, CompletesNamesAndTheirWords) {
  EXPECT_THAT(crane_.candidates(""), IsSupersetOf({"help", "turn", "wait", "quit"}));
  EXPECT_THAT(crane_.candidates("help t"), IsSupersetOf({"turn", "stop"}));
  EXPECT_THAT(crane_.candidates("turn "), ElementsAre("left", "right"));
  EXPECT_THAT(crane_.candidates("turn le"), ElementsAre("left", "right"));
  EXPECT_THAT(crane_.candidates("turn left "), ElementsAre("far"));
  EXPECT_THAT(crane_.candidates("turn left far "), IsEmpty());
  EXPECT_THAT(crane_.candidates("fly "), IsEmpty());
}

TEST_F(DeviceConsoleTest, GoesOnUntilTheCommandHasEnded) {
  EXPECT_EQ(crane_.occupation(), "");
  EXPECT_EQ(said_to("turn left"), "");
  EXPECT_TRUE(crane_.is_busy());
  EXPECT_EQ(crane_.occupation(), "turn");
  while (crane_.is_busy()) ASSERT_TRUE(crane_.cycle());
  EXPECT_EQ(transcript_.take(), "turned\n");
  EXPECT_EQ(crane_.now(), Instant{1s});
}

TEST_F(DeviceConsoleTest, SaysThatAnotherCommandIsStillGoingOn) {
  EXPECT_EQ(said_to("turn left"), "");
  EXPECT_EQ(said_to("turn right"), "! turn is still going on; 'stop' ends it\n");
  EXPECT_EQ(said_to("hoot"), "hoot\n");
  EXPECT_TRUE(crane_.is_busy());
}

TEST_F(DeviceConsoleTest, StopsWhateverGoesOn) {
  EXPECT_EQ(said_to("turn left"), "");
  EXPECT_EQ(said_to("stop"), "* turn is ended\nstands\n");
  EXPECT_FALSE(crane_.is_busy());
  EXPECT_EQ(said_to("stop"), "stands\n");
  EXPECT_EQ(crane_.stood, 2);
}

TEST_F(DeviceConsoleTest, WaitsForATime) {
  EXPECT_EQ(transcript_.run(crane_, "wait 2.5"), "");
  EXPECT_EQ(crane_.now(), Instant{2500ms});
  EXPECT_THAT(said_to("wait long"), HasSubstr("? 'long' is not a number; usage: wait SECONDS"));
  EXPECT_THAT(said_to("wait 3601"), HasSubstr("at most 3600 s"));
  EXPECT_EQ(said_to("wait 9"), "");
  while (crane_.now() < Instant{5s}) ASSERT_TRUE(crane_.cycle());
  EXPECT_EQ(crane_.occupation(), "wait 2 s");
  EXPECT_EQ(said_to("stop"), "* wait is ended\nstands\n");
  EXPECT_FALSE(crane_.is_busy());
}

TEST_F(DeviceConsoleTest, TellsItsStateOrWhyItHasNone) {
  EXPECT_EQ(said_to("status"), "upright\n");
  crane_.is_plugged = false;
  EXPECT_EQ(said_to("status"), "! it says nothing\n");
}

TEST_F(DeviceConsoleTest, LeavesByTwoNames) {
  EXPECT_FALSE(crane_.wants_to_quit());
  EXPECT_EQ(said_to("exit"), "");
  EXPECT_TRUE(crane_.wants_to_quit());
  Transcript other;
  Crane second{other.say()};
  second.begin("quit");
  EXPECT_TRUE(second.wants_to_quit());
  EXPECT_TRUE(second.leave());
  EXPECT_EQ(second.stood, 1);
}

TEST_F(DeviceConsoleTest, WaitsForASignOfLifeButNotForEver) {
  EXPECT_TRUE(crane_.find_device().value_or(false));
  EXPECT_EQ(crane_.now(), Instant{50ms});
  crane_.is_plugged = false;
  EXPECT_FALSE(crane_.find_device().value_or(true));
  EXPECT_EQ(crane_.now(), Instant{1050ms});
  EXPECT_EQ(crane_.silence(), "is it plugged in?");
}

TEST_F(DeviceConsoleTest, TellsThatTheTargetIsGone) {
  crane_.is_gone = true;
  const auto cycled = crane_.cycle();
  ASSERT_FALSE(cycled);
  EXPECT_EQ(cycled.error().where, "crane:");
  EXPECT_EQ(cycled.error().code, ErrorCode::kDisconnected);
}

}  // namespace
}  // namespace armjig
