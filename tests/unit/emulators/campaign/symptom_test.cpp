// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/symptom.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/device.hpp"
#include "cli/devices/devices.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

struct Said {
  Duration time;
  std::int32_t speed;
  std::uint8_t object = 0;
  std::int32_t first = 0;
};

/// What a board says of the speeds of its last joint and its first, and of its gripper.
Heard board(std::initializer_list<Said> all) {
  Heard heard;
  for (const auto& said : all) {
    parol6::TelemetryFrame frame;
    frame.speed.back() = StepsPerSecond{said.speed};
    frame.speed.front() = StepsPerSecond{said.first};
    frame.gripper.object_detection = said.object;
    const auto bytes = parol6::encode(frame);
    heard.said.push_back({.time = Instant{said.time},
                          .kind = LinkKind::kStream,
                          .direction = Direction::kFromDevice,
                          .bytes = {bytes.begin(), bytes.end()}});
  }
  return heard;
}

std::optional<Symptom> judge(const BothHeard& heard, Duration tolerance = 4ms,
                             const Excuses& excuses = {}) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  Judging judging{.make_dissector = device.make_dissector, .rules = {}, .horizon = 20ms};
  judging.rules.time_tolerance = tolerance;
  const Script script{{.time = Instant{1s}, .kind = LinkKind::kStream}};
  return symptom_of(script, heard, judging, excuses);
}

/// Two frames came in one tick here and in two there; then two more, the other way round.
const auto kApart = board({{10ms, 1}, {20ms, 2}, {30ms, 3}, {40ms, 4}});
const auto kTogether = board({{10ms, 1}, {20ms, 1}, {30ms, 3}, {40ms, 3}});

TEST(Symptom, IsNoneWhereEachMomentIsAsSomeModelHadIt) {
  EXPECT_FALSE(judge({board({{10ms, 1}, {20ms, 2}, {30ms, 3}, {40ms, 3}}), {kApart, kTogether}}));
  EXPECT_FALSE(judge({board({{10ms, 1}, {20ms, 1}, {30ms, 3}, {40ms, 4}}), {kApart, kTogether}}));
}

TEST(Symptom, IsWhatNoModelSaysAtThatMoment) {
  const auto changed =
      judge({board({{10ms, 1}, {20ms, 2}, {30ms, 7}, {40ms, 4}}), {kApart, kTogether}});
  ASSERT_TRUE(changed);
  EXPECT_EQ(changed->parts, std::vector<std::string>{"speed.j6"});
  EXPECT_EQ(changed->time, Instant{30ms});
  EXPECT_TRUE(judge({board({{10ms, 1}, {30ms, 3}, {40ms, 4}}), {kApart, kTogether}}));
  EXPECT_TRUE(judge({board({}), {kApart, kTogether}}));
  EXPECT_TRUE(
      judge({board({{10ms, 1}, {20ms, 2}, {25ms, 9}, {30ms, 3}, {40ms, 4}}), {kApart, kTogether}}));
}

/// What was wrong from the beginning does not make what follows wrong.
TEST(Symptom, IsNoneWhereAModelComesPastApartFromWhatIsNoNews) {
  Excuses excuses;
  excuses.add({}, "telemetry", "gripper.object");
  const BothHeard early{board({{10ms, 1}, {20ms, 3}, {30ms, 4}}),
                        {board({{10ms, 1, 1}, {20ms, 2, 1}, {30ms, 4, 1}})}};
  EXPECT_FALSE(judge(early, 12ms, excuses));
  EXPECT_TRUE(judge(early, 4ms, excuses));
  const BothHeard wrong{board({{10ms, 1}, {20ms, 7}, {30ms, 4}}),
                        {board({{10ms, 1, 1}, {20ms, 2, 1}, {30ms, 4, 1}})}};
  EXPECT_TRUE(judge(wrong, 12ms, excuses));
}

/// What comes alike in all of them, whenever it came, is no matter of time.
TEST(Symptom, IsWhatAllModelsAgreeOnThoughOneComesPast) {
  const auto sound = board({{10ms, 1}, {20ms, 3}, {30ms, 4}});
  const auto other = board({{10ms, 1}, {20ms, 1}, {30ms, 4}});
  const auto stale = board({{10ms, 1}, {20ms, 2}, {30ms, 4}});
  EXPECT_TRUE(judge({stale, {sound, sound}}, 12ms));
  EXPECT_FALSE(judge({stale, {sound, other}}, 12ms));
}

/// The target's second answer is the models' third or fourth, so that what comes before that seems
/// to be missing, and what comes after it too much.
TEST(Symptom, IsNoneWhereAsManyComeAsShouldAndAModelComesPastWhatIsOutOfStep) {
  const auto with = [](Said second, Said third) {
    return board({{10ms, 0}, second, third, {40ms, 50, 0, 100}, {50ms, 50, 0, 150}});
  };
  const auto late = with({20ms, 0}, {30ms, 50, 0, 50});
  const auto later =
      board({{10ms, 0}, {15ms, 0, 0, 10}, {20ms, 0, 0, 20}, {30ms, 50, 0, 50}, {50ms, 50, 0, 150}});
  const Said early{20ms, 50, 0, 50};
  EXPECT_FALSE(judge({with(early, {30ms, 50, 0, 25}), {late, later}}, 12ms));
  EXPECT_TRUE(judge({with(early, {30ms, 50, 0, 25}), {late, late}}, 12ms));
  EXPECT_TRUE(judge({with(early, {30ms, 50, 0, 25}), {late, later}}, 4ms));
  EXPECT_TRUE(judge({with(early, {30ms, 50, 0, 125}), {late, later}}, 12ms));
  const auto fewer = board({{10ms, 0}, early, {40ms, 50, 0, 100}, {50ms, 50, 0, 150}});
  EXPECT_TRUE(judge({fewer, {late, later}}, 12ms));
}

/// Some from `begin` to before `end`, one each 10 ms.
Heard many(int begin, int end) {
  Heard heard;
  for (auto i = begin; i < end; ++i) {
    auto one = board({{i * 10ms, 1}});
    heard.said.push_back(std::move(one.said.front()));
  }
  return heard;
}

TEST(Symptom, IsOneMessageLessOfManyThatAreAlikeWhicheverItIs) {
  EXPECT_TRUE(judge({many(1, 40), {many(0, 40), many(1, 41)}}));
  EXPECT_FALSE(judge({many(1, 40), {many(0, 40), many(1, 40)}}));
}

struct Beat {
  Duration time;
  std::string line;
};

/// What a server says by itself.
Heard server(const std::vector<Beat>& beats) {
  Heard heard;
  for (const auto& [time, line] : beats) {
    const auto bytes = std::as_bytes(std::span{line});
    heard.said.push_back({.time = Instant{time},
                          .kind = LinkKind::kSession,
                          .direction = Direction::kFromDevice,
                          .bytes = {bytes.begin(), bytes.end()}});
  }
  return heard;
}

/// Of a server whose beats nobody can tell the moment of; what is done is done at 2 s.
std::optional<Symptom> judge_beats(const std::vector<Beat>& target) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "kinovazed");
  Judging judging{.make_dissector = device.make_dissector, .rules = {}, .horizon = 20ms};
  judging.rules.time_tolerance = 100ms;
  judging.rules.is_order_free = true;
  judging.rules.ignored_messages = {"Heartbeat"};
  const Script script{{.time = Instant{2s}, .kind = LinkKind::kSession, .bytes = {std::byte{'x'}}}};
  const auto model = server({{500ms, "Heartbeat:1\r\n"},
                             {1500ms, "Heartbeat:1\r\n"},
                             {2500ms, "Heartbeat:3\r\n"},
                             {3500ms, "Heartbeat:3\r\n"}});
  return symptom_of(script, {server(target), {model, model}}, judging, {});
}

TEST(Symptom, IsABeatOfAnotherStateWhereNothingHappens) {
  const auto symptom = judge_beats({{700ms, "Heartbeat:1\r\n"}, {3000ms, "Heartbeat:1\r\n"}});
  ASSERT_TRUE(symptom);
  EXPECT_EQ(symptom->answer, "Heartbeat");
  EXPECT_EQ(symptom->parts, std::vector<std::string>{"state"});
  EXPECT_EQ(symptom->time, Instant{2500ms});
}

TEST(Symptom, IsNoneWhereABeatComesAtAnotherMoment) {
  EXPECT_FALSE(judge_beats({{100ms, "Heartbeat:1\r\n"},
                            {1100ms, "Heartbeat:1\r\n"},
                            {2300ms, "Heartbeat:3\r\n"},
                            {3900ms, "Heartbeat:3\r\n"}}));
}

TEST(Symptom, IsNoneWhereABeatMayBeOfBeforeOrOfAfter) {
  EXPECT_FALSE(judge_beats({{1950ms, "Heartbeat:3\r\n"}, {2050ms, "Heartbeat:1\r\n"}}));
}

}  // namespace
}  // namespace armjig::campaign
