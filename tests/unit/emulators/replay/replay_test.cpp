// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "emulators/replay/parol6.hpp"
#include "harness/capture/trace.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

constexpr Replay kReplay{.run = parol6::replay::replay};
const std::string kCaptures = source_dir() + "/captures/parol6";

/// All recordings; none if they cannot be found, which a test of its own reports.
std::vector<std::string> recordings() {
  return find_traces({kCaptures}).value_or(std::vector<std::string>{});
}

TEST(Recordings, AreAllHere) { EXPECT_GE(recordings().size(), 87U); }

class Recording : public testing::TestWithParam<std::string> {};

TEST_P(Recording, IsReproducedToTheByte) {
  const auto trace = read_trace(GetParam());
  ASSERT_TRUE(trace) << describe(trace.error());
  const auto difference = verify(*trace, kReplay);
  ASSERT_TRUE(difference) << describe(difference.error());
  EXPECT_FALSE(*difference) << describe(**difference, *trace, parol6::make_dissector)
                            << "  again: armjig trace verify " << GetParam();
}

std::string name_of(const testing::TestParamInfo<std::string>& recording) {
  auto name = std::filesystem::path{recording.param}.stem().string();
  std::ranges::replace(name, '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Parol6, Recording, testing::ValuesIn(recordings()), name_of);

Trace jog_recording() {
  const auto trace = read_trace(kCaptures + "/jog_single_joints_a.jsonl");
  EXPECT_TRUE(trace);
  return trace.value_or(Trace{});
}

/// The `number`-th telemetry line.
TraceEvent& telemetry(Trace& trace, int number) {
  return *std::ranges::find_if(trace.events, [&number](const TraceEvent& event) {
    return event.dir == "from_device" && number-- == 0;
  });
}

TEST(CorruptedRecording, IsFoundOutWithLineAndField) {
  auto trace = jog_recording();
  auto& event = telemetry(trace, 10);
  event.bytes[40] ^= std::byte{0x80};  // homed: J1
  const auto difference = verify(trace, kReplay);
  ASSERT_TRUE(difference && *difference);
  EXPECT_EQ((*difference)->expected->line, event.line);
  const auto text = describe(**difference, trace, parol6::make_dissector);
  EXPECT_THAT(text, HasSubstr(":" + std::to_string(event.line) + ": differs at "));
  EXPECT_THAT(text, EndsWith("  homed: expected j1 (0x83), got (0x03)\n"));
}

TEST(CorruptedRecording, IsFoundOutByEveryBitOfAFrame) {
  const auto trace = jog_recording();
  const auto replayed = kReplay.run(trace);
  ASSERT_TRUE(replayed);
  for (std::size_t bit = 0; bit < std::size_t{60} * 8; ++bit) {
    auto recorded = replayed->recorded;
    recorded.at(20).bytes[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    const auto difference = first_difference(recorded, replayed->actual);
    ASSERT_TRUE(difference) << bit;
    EXPECT_EQ(difference->expected->line, recorded[20].line);
  }
}

TEST(CorruptedRecording, IsFoundOutByTheTimeOfAnAnswer) {
  auto trace = jog_recording();
  telemetry(trace, 10).time += std::chrono::microseconds{1};
  const auto difference = verify(trace, kReplay);
  ASSERT_TRUE(difference && *difference);
  EXPECT_THAT(describe(**difference, trace, parol6::make_dissector),
              HasSubstr("  time: expected "));
}

TEST(CorruptedRecording, IsFoundOutByAnAnswerThatIsMissing) {
  auto trace = jog_recording();
  const auto line = telemetry(trace, 11).line;
  std::erase_if(trace.events,
                [lost = telemetry(trace, 10).line](const auto& e) { return e.line == lost; });
  const auto difference = verify(trace, kReplay);
  ASSERT_TRUE(difference && *difference);
  EXPECT_EQ((*difference)->expected->line, line);
}

TEST(CorruptedRecording, IsFoundOutByAnAnswerTooMany) {
  auto trace = jog_recording();
  trace.events.push_back(telemetry(trace, 10));
  const auto difference = verify(trace, kReplay);
  ASSERT_TRUE(difference && *difference);
  EXPECT_FALSE((*difference)->actual);
}

TEST(MalformedRecording, IsRefusedWithTheKeyThatIsWrong) {
  const auto refusal = [](const std::string& from, const std::string& to) {
    auto trace = jog_recording();
    const auto place = trace.header.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    trace.header.replace(place, from.size(), to);
    const auto result = verify(trace, kReplay);
    return result ? "accepted" : describe(result.error());
  };
  EXPECT_THAT(
      refusal(R"("loop_us":20)", R"("loop_us":0)"),
      EndsWith(R"(jsonl:1: the content is malformed; "loop_us" is missing or out of range)"));
  EXPECT_THAT(refusal(R"("loop_us")", R"("loop")"), HasSubstr(R"("loop_us")"));
  EXPECT_THAT(refusal(R"("tim2_bits":16)", R"("tim2_bits":33)"), HasSubstr(R"("tim2_bits")"));
  EXPECT_THAT(refusal(R"("micros_at_t0":740000)", R"("micros_at_t0":-1)"),
              HasSubstr(R"("micros_at_t0")"));
  EXPECT_THAT(refusal(R"("side":"<=")", R"("side":"=")"), HasSubstr(R"("side")"));
  EXPECT_THAT(refusal(R"("estop":1)", R"("estop":2)"), HasSubstr(R"("estop")"));
  EXPECT_THAT(refusal(R"("joint":1)", R"("joint":7)"), HasSubstr(R"("joint")"));
  EXPECT_THAT(refusal(R"("joints")", R"("limbs")"), HasSubstr(R"("plant.joints")"));
  EXPECT_THAT(refusal(R"("plant")", R"("plants")"), HasSubstr(R"("plant.joints")"));
  EXPECT_THAT(refusal(R"("can_recorded":)", R"("can_recorded":1,"x":)"),
              HasSubstr(R"("can_recorded")"));
}

TEST(MalformedRecording, IsRefusedWithTheLineThatNoBoardCanHave) {
  const auto refusal = [](TraceEvent event) {
    auto trace = jog_recording();
    event.time = trace.events.front().time;
    event.line = 2;
    trace.events.insert(trace.events.begin(), event);
    const auto result = verify(trace, kReplay);
    return result ? "accepted" : describe(result.error());
  };
  TraceEvent event;
  event.dir = "bus_write";
  EXPECT_THAT(refusal(event), HasSubstr(".jsonl:2: "));
  event.dir = "input";
  event.name = "in3";
  EXPECT_THAT(refusal(event), HasSubstr(".jsonl:2: "));
  event.dir = "can_to_device";
  event.id = 0x800;
  EXPECT_THAT(refusal(event), HasSubstr(".jsonl:2: "));
  event.id = 0;
  event.bytes.resize(9);
  EXPECT_THAT(refusal(event), HasSubstr(".jsonl:2: "));
}

}  // namespace
}  // namespace armjig
