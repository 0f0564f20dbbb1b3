// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/intervals.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "emulators/campaign/talk.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

constexpr ToldInterval kTiming{"telemetry", "timing", parol6::kTicksPerSecond};

struct Answer {
  Duration time;
  Duration interval;
};

using Answers = std::vector<Answer>;

RecordedMessages board_answering(const Answers& answers) {
  std::vector<KeptRecord> said;
  for (const auto& [time, interval] : answers) {
    const auto ticks = interval.count() * parol6::kTicksPerSecond / 1'000'000'000;
    const auto bytes = encode(parol6::TelemetryFrame{.timing = static_cast<std::uint16_t>(ticks)});
    said.push_back({.time = Instant{time},
                    .kind = LinkKind::kStream,
                    .direction = Direction::kFromDevice,
                    .bytes = {bytes.begin(), bytes.end()}});
  }
  return messages_of(said, parol6::make_dissector);
}

std::vector<RecordingDifference> false_ones(const std::vector<Answers>& models,
                                            const Answers& target) {
  std::vector<RecordedMessages> expected;
  for (const auto& model : models) expected.push_back(board_answering(model));
  return false_intervals(kTiming, expected, board_answering(target));
}

/// Three messages are due at 10, 110 and 120 ms.
std::size_t count_false(const Answers& target) {
  const Answers model{{10ms, 0ms}, {110ms, 100ms}, {120ms, 10ms}};
  return false_ones({model, model}, target).size();
}

TEST(FalseIntervals, AreNoneOfAPromptBoard) {
  EXPECT_EQ(count_false({{10ms, 0ms}, {110ms, 100ms}, {120ms, 10ms}}), 0U);
}

TEST(FalseIntervals, AreNoneWhateverOfItALinkMayHaveDelayed) {
  EXPECT_EQ(count_false({{10ms, 7ms}, {140ms, 115ms}, {141ms, 20ms}}), 0U);
  EXPECT_EQ(count_false({{50ms, 7ms}, {111ms, 60ms}, {160ms, 30ms}}), 0U);
}

TEST(FalseIntervals, AreThoseThatAreTooShortOrTooLong) {
  EXPECT_EQ(count_false({{10ms, 0ms}, {110ms, 80ms}, {120ms, 10ms}}), 1U);
  EXPECT_EQ(count_false({{10ms, 0ms}, {110ms, 100ms}, {120ms, 13ms}}), 1U);
  EXPECT_EQ(count_false({{10ms, 0ms}, {110ms, 120ms}, {120ms, 7ms}}), 2U);
}

/// Its counter has 16 bits and is back at 0 after 93.2 ms.
TEST(FalseIntervals, BeginAgainAfterTheGreatestValue) {
  EXPECT_EQ(count_false({{10ms, 0ms}, {110ms, 6'800us}, {120ms, 10ms}}), 0U);
  EXPECT_EQ(count_false({{10ms, 0ms}, {110ms, 1ms}, {120ms, 10ms}}), 1U);
}

TEST(FalseIntervals, AreNoneWhereAModelWouldHaveOneOrAnswersAreNotAsMany) {
  const Answers good{{10ms, 0ms}, {20ms, 10ms}};
  const Answers odd{{10ms, 0ms}, {20ms, 50ms}};
  EXPECT_EQ(false_ones({good, good}, odd).size(), 1U);
  EXPECT_TRUE(false_ones({good, odd}, odd).empty());
  const Answers one{{20ms, 50ms}};
  EXPECT_TRUE(false_ones({good, good}, one).empty());
  EXPECT_TRUE(false_ones({good, one}, odd).empty());
  EXPECT_TRUE(false_ones({}, odd).empty());
}

TEST(FalseIntervals, SayBetweenWhatTheyShouldBe) {
  const auto all = false_ones({{{10ms, 0ms}, {20ms, 10ms}}}, {{10ms, 0ms}, {20ms, 50ms}});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all.front().what,
            std::vector<std::string>{"timing: 6188 to 7875 ticks, modulo 65536, 35156 ticks"});
}

}  // namespace
}  // namespace armjig::campaign
