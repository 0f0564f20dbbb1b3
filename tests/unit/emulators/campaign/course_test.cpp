// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/course.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <set>
#include <vector>

#include "harness/rig/judge.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/emulators/campaign/live_material.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;
using parol6::Command;
using parol6::CommandFrame;

const Material& live_board() {
  static const auto kBoard = live_material("parol6", "pty:/tmp/nowhere");
  return kBoard;
}

struct TimedFrame {
  Instant time{};
  CommandFrame frame{};
};

std::vector<TimedFrame> timed_frames_in(const Script& script) {
  std::vector<TimedFrame> all;
  for (const auto& record : script) {
    if (record.bytes.size() != parol6::kCommandFrameSize) continue;
    const auto body = Bytes{record.bytes}.first<parol6::kCommandFrameSize>();
    all.push_back({record.time, parol6::decode_command(parol6::body_of(body))});
  }
  return all;
}

std::vector<TimedFrame> timed_go_tos_in(const Script& script) {
  auto frames = timed_frames_in(script);
  std::erase_if(frames, [](const TimedFrame& one) { return one.frame.command != Command::kGoTo; });
  return frames;
}

/// The one course that there is on a board.
const Script& steered() {
  static const auto kScript = [] {
    const Repertoire repertoire{live_board(), 1};
    auto all = Courses{live_board(), repertoire}.steered();
    return all.size() == 1 ? all.front() : Script{};
  }();
  return kScript;
}

TEST(Courses, SteerAnArmOnceItIsHomed) {
  const auto frames = timed_frames_in(steered());
  const auto home = std::ranges::find(frames, Command::kHome,
                                      [](const TimedFrame& one) { return one.frame.command; });
  ASSERT_NE(home, frames.end());
  const auto goals = timed_go_tos_in(steered());
  ASSERT_GT(goals.size(), 1000U);
  EXPECT_GT(goals.front().time - home->time, 20s);
}

TEST(Courses, SendNothingThatTheGuardRefusesThere) {
  auto script = steered();
  live_board().permit_case(script);
  EXPECT_EQ(script.size(), steered().size());
}

TEST(Courses, LeadEachJointFartherThanLiveRulesLetPass) {
  const auto goals = timed_go_tos_in(steered());
  ASSERT_FALSE(goals.empty());
  for (std::size_t j = 0; j < parol6::kJointCount; ++j) {
    const auto place = [j](const TimedFrame& one) { return one.frame.position.at(j).value; };
    const auto [least, most] = std::ranges::minmax_element(goals, {}, place);
    EXPECT_GT(place(*most) - place(*least), 1000) << j;
  }
}

TEST(Courses, SteerWithOtherNumbersAndBitsOnEachLeg) {
  std::set<std::int32_t> feeds;
  std::set<int> joints;
  for (const auto& one : timed_go_tos_in(steered())) {
    feeds.insert(one.frame.speed[2].value);
    joints.insert(one.frame.affected_joints);
  }
  for (const auto feed : {0, 128, -128, 256, 1000}) EXPECT_TRUE(feeds.contains(feed)) << feed;
  EXPECT_GT(joints.size(), 10U);
}

TEST(Courses, SendEachOtherCommandBetweenLegs) {
  std::set<Command> between;
  const auto frames = timed_frames_in(steered());
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames[i - 1].frame.command == Command::kGoTo) between.insert(frames[i].frame.command);
  }
  for (const auto command :
       {Command::kIdle, Command::kJog, Command::kEnable, Command::kDisable, Command::kClearError}) {
    EXPECT_TRUE(between.contains(command)) << int(command);
  }
}

TEST(Courses, AreNoneOnABoardThatMayStandAnywhere) {
  auto material = live_board();
  material.can_be_reset = false;
  const Repertoire repertoire{live_board(), 1};
  EXPECT_TRUE(Courses(material, repertoire).steered().empty());
}

TEST(Courses, AreNoneWhereNobodyKnowsWhatASoundDeviceSaysOrMessagesTellAll) {
  auto material = live_board();
  material.rehearse = {};
  const Repertoire repertoire{live_board(), 1};
  EXPECT_TRUE(Courses(material, repertoire).steered().empty());
  const auto node = live_material("morap", "i2c:/dev/nowhere");
  const Repertoire of_node{node, 1};
  EXPECT_TRUE(Courses(node, of_node).steered().empty());
}

}  // namespace
}  // namespace armjig::campaign
