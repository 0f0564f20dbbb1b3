// SPDX-License-Identifier: Apache-2.0
#include "harness/summary/session_timeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/wire/parol6/fields.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/wire/parol6/vectors.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using test::hex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const CaptureLink kTimedArm{"arm", "parol6", LinkKind::kStream};

Message telemetry(Duration time, std::int64_t steps, std::int64_t io = 0x8F) {
  auto raw = parol6::vectors::kRestTelemetry;
  set_field_value(*find_field(parol6::telemetry_fields(), "position.j1"), raw, steps);
  set_field_value(*find_field(parol6::telemetry_fields(), "io"), raw, io);
  return {Direction::kFromDevice, at(time), "telemetry", raw, parol6::telemetry_fields(), {}};
}

Message jog(Duration time) {
  return {Direction::kToDevice,     at(time), "command", parol6::vectors::kJogCommand,
          parol6::command_fields(), {}};
}

const TimelineLane& lane(const Timeline& timeline, std::string_view title) {
  return *std::ranges::find(timeline.lanes, title, &TimelineLane::title);
}

TEST(SessionTimeline, HasCurvesOfWhatMovesAndMarksThatNameMessages) {
  SessionTimeline session;
  session.add(kTimedArm, 0, jog(1ms));
  session.add(kTimedArm, 0, telemetry(2ms, 100));
  session.add(kTimedArm, 0, jog(11ms));
  session.add(kTimedArm, 0, telemetry(12ms, -50, 0x87));
  session.add(kTimedArm, 0, {Direction::kToDevice, at(13ms), "noise", hex("12"), {}, "no start"});
  const auto timeline = session.timeline("session", at(20ms));
  ASSERT_EQ(timeline.charts.size(), 1);
  EXPECT_EQ(timeline.charts[0].title, "telemetry position / steps");
  ASSERT_EQ(timeline.charts[0].curves.size(), 6);
  const auto& curve = timeline.charts[0].curves[0];
  EXPECT_EQ(curve.name, "j1");
  EXPECT_EQ(curve.stretches.front().most, 100);
  EXPECT_EQ(curve.stretches.back().least, -50);
  const auto& commands = lane(timeline, "commands");
  ASSERT_EQ(commands.marks.size(), 1);  // the second goes on with the first
  EXPECT_EQ(commands.marks[0].text, "command jog and 1 more");
  EXPECT_DOUBLE_EQ(commands.marks[0].end, 0.011);
  const auto& states = lane(timeline, "states");
  ASSERT_EQ(states.marks.size(), 1);
  EXPECT_THAT(states.marks[0].text, HasSubstr("io: "));
  EXPECT_EQ(states.marks[0].message, 3);
  EXPECT_EQ(lane(timeline, "findings").marks[0].text, "no start");
  EXPECT_EQ(timeline.messages.size(), 5);
  EXPECT_TRUE(timeline.messages[4].is_bad);
  EXPECT_THAT(timeline.left_out, IsEmpty());
}

TEST(SessionTimeline, KeepsPeaksMarksAndMessagesOfLongSessionsWithinBounds) {
  constexpr int kMany = 100'000;
  constexpr int kPeak = 77'777;
  SessionTimeline session;
  for (int i = 0; i < kMany; ++i) {
    session.add(kTimedArm, 0, telemetry(i * 10ms, i == kPeak ? 9999 : 0, i % 2 == 0 ? 0x8F : 0x87));
  }
  const auto timeline = session.timeline("session", at(kMany * 10ms));
  ASSERT_EQ(timeline.charts.size(), 1);
  const auto& stretches = timeline.charts[0].curves[0].stretches;
  EXPECT_LE(stretches.size(), 2000);
  EXPECT_GE(stretches.size(), 1000);
  const auto peak = std::ranges::max_element(stretches, {}, &TimelineStretch::most);
  EXPECT_EQ(peak->most, 9999);
  EXPECT_EQ(peak->least, 0);
  EXPECT_NEAR(peak->seconds, kPeak * 0.01, 1);
  const auto& states = lane(timeline, "states").marks;
  EXPECT_LE(states.size(), 1000);
  EXPECT_DOUBLE_EQ(states.front().begin, 0.01);
  EXPECT_DOUBLE_EQ(states.back().end, (kMany - 1) * 0.01);
  EXPECT_LE(timeline.messages.size(), 3100);
  for (const auto& mark : states) {
    EXPECT_TRUE(
        std::ranges::binary_search(timeline.messages, mark.message, {}, &TimelineMessage::number));
  }
  EXPECT_THAT(timeline.left_out, HasSubstr("of 100000 messages are listed"));
  EXPECT_LT(to_figure(timeline).size(), 4'000'000);
}

TEST(SessionTimeline, TellsEndsOfConnectionsAndBusesApart) {
  SessionTimeline session;
  const CaptureLink bus{"bus", "demo", LinkKind::kBus};
  session.add(bus, 0x12, jog(1ms));
  session.add(bus, 0x13, jog(2ms));
  const auto timeline = session.timeline("session", at(3ms));
  EXPECT_EQ(lane(timeline, "commands").marks[1].text, "0x13 command jog");
}

}  // namespace
}  // namespace armjig
