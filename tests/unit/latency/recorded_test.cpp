// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/recorded.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/latency/generic_probe.hpp"
#include "harness/latency/kinovazed_probe.hpp"
#include "harness/latency/morap_probe.hpp"
#include "harness/latency/parol6_probe.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/latency/scripted_capture.hpp"
#include "tests/unit/report/validity.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using test::hex;
using test::ScriptedCapture;
using test::text;
using testing::Contains;
using testing::HasSubstr;

std::unique_ptr<Probe> echo_of_a_byte() { return generic::make_probe("byte", hex("55"), 1); }

LatencyRun read(ScriptedCapture& capture, std::unique_ptr<Probe> (*make_listener)()) {
  return run_of(capture, {.make_listener = make_listener,
                          .is_ours = [](std::string_view device) { return device.empty(); }})
      .value();
}

/// A request each 10 ms, answered after `delay(n)`; none: never.
LatencyRun steady(int count, const std::function<std::optional<Duration>(int)>& delay) {
  std::vector<std::pair<Duration, bool>> said;  // whether it is a request
  Duration free{};
  for (int i = 0; i < count; ++i) {
    said.emplace_back(i * 10ms, true);
    if (!delay(i)) continue;
    free = std::max(free, i * 10ms + *delay(i));
    said.emplace_back(free, false);
  }
  std::ranges::stable_sort(said, {}, [](const auto& one) { return one.first; });
  ScriptedCapture capture{LinkKind::kStream};
  for (const auto& [time, is_request] : said) {
    is_request ? capture.request(time, hex("55")) : capture.answer(time, hex("55"));
  }
  return read(capture, echo_of_a_byte);
}

double value_of(const LatencyRun& run, std::string_view name) {
  for (const auto& figure : run.figures) {
    if (figure.name == name) return figure.value;
  }
  ADD_FAILURE() << "no figure " << name;
  return 0;
}

TEST(Recording, GivesRoundTripsAndTheRateBack) {
  const auto run = steady(500, [](int i) { return i % 10 == 0 ? 3ms : 1ms; });
  EXPECT_EQ(run.measured.sent, 500U);
  EXPECT_EQ(run.measured.round_trips.count(), 500U);
  EXPECT_EQ(run.measured.round_trips.counts()[LatencyHistogram::bucket_of(3ms)], 50U);
  EXPECT_EQ(run.measured.lost + run.measured.surplus + run.measured.skipped, 0U);
  EXPECT_EQ(run.plan.period, 10ms);
  EXPECT_EQ(run.measured.outliers.front().trip.duration, 3ms);
  EXPECT_EQ(run.measured.time, 4991ms);
  EXPECT_TRUE(test::is_valid_json(to_latency_json(run), "docs/schemas/latency.schema.json"));
}

TEST(Recording, KeepsTheOrderWhenAnswersComeLateAllAtOnce) {
  // The tenth takes 45 ms, and four more requests leave meanwhile: 45, 35, 25, 15 and 5 ms.
  const auto run = steady(100, [](int i) { return i == 10 ? 45ms : 1ms; });
  EXPECT_EQ(run.measured.lost, 0U);
  for (const auto late : {45ms, 35ms, 25ms, 15ms, 5ms}) {
    EXPECT_EQ(run.measured.round_trips.counts()[LatencyHistogram::bucket_of(late)], 1U);
  }
}

TEST(Recording, TakesNoAnswerForThatOfALostRequest) {
  const auto run = steady(500, [](int i) -> std::optional<Duration> {
    if (i == 100 || i == 101 || i == 300) return std::nullopt;
    return 1ms;
  });
  EXPECT_EQ(run.measured.lost, 3U);
  EXPECT_EQ(run.measured.round_trips.count(), 497U);
  EXPECT_EQ(run.measured.round_trips.max(), 1ms);
  EXPECT_EQ(run.measured.surplus, 0U);
}

TEST(Recording, CallsNothingLostThatMayComeAfterItsEnd) {
  const auto run = steady(50, [](int i) -> std::optional<Duration> {
    return i < 49 ? std::optional<Duration>{1ms} : std::nullopt;
  });
  EXPECT_EQ(run.measured.lost, 0U);
  EXPECT_EQ(run.measured.round_trips.count(), 49U);
}

TEST(Recording, CorrectsForRequestsThatSomebodyDidNotSendMeanwhile) {
  // After the one that took 45 ms the program goes on with the deadlines that are left.
  ScriptedCapture capture{LinkKind::kStream};
  for (int i = 0; i < 100; ++i) {
    if (i > 50 && i < 55) continue;
    capture.request(i * 10ms, hex("55"));
    capture.answer(i * 10ms + (i == 50 ? 45ms : 1ms), hex("55"));
  }
  const auto run = read(capture, echo_of_a_byte);
  EXPECT_EQ(run.plan.period, 10ms);
  EXPECT_EQ(run.measured.skipped, 4U);
  EXPECT_EQ(run.measured.round_trips.count(), 96U);
  EXPECT_EQ(run.measured.corrected.count(), 99U) << "and 35, 25 and 15 ms";
}

TEST(Recording, ShowsNoScheduleWhereTheAnswerSetsTheRate) {
  ScriptedCapture capture{LinkKind::kStream};
  for (int i = 0; i < 100; ++i) {
    capture.request(i * 2ms, hex("55"));
    capture.answer(i * 2ms + 1950us, hex("55"));
  }
  const auto run = read(capture, echo_of_a_byte);
  EXPECT_EQ(run.plan.period, std::nullopt);
  EXPECT_THAT(run.left_out, Contains(HasSubstr("a schedule")));
  EXPECT_EQ(run.measured.corrected.count(), 100U);
}

TEST(Recording, NamesWhatItCannotSay) {
  const auto run = steady(20, [](int) { return 1ms; });
  for (const auto* what : {"a sentinel", "permissions", "time stamps", "deadlines"}) {
    EXPECT_THAT(run.left_out, Contains(HasSubstr(what)));
  }
  EXPECT_FALSE(run.witness);
  EXPECT_EQ(run.measured.lateness.count(), 0U);
  const auto report = to_text(report_of(run));
  EXPECT_THAT(report, HasSubstr("left out"));
  EXPECT_THAT(report, testing::Not(HasSubstr("machine")));
  EXPECT_EQ(blame_of(run.measured.outliers.front(), run), "host, device or link");
}

TEST(Recording, PassesOverLinksOfOtherDevices) {
  ScriptedCapture capture{LinkKind::kStream};
  capture.request(0ms, hex("55"));
  capture.answer(1ms, hex("55"));
  const auto run = run_of(capture, {.make_listener = echo_of_a_byte,
                                    .is_ours = [](std::string_view) { return false; }});
  EXPECT_EQ(run->measured.sent, 0U);
}

TEST(RecordingOfABoard, HoldsTheBoardsFieldAgainstTheTimesOfSending) {
  // A board whose clock is 0.5 % fast, and a host that sends each tenth frame 2 ms late: ticks of
  // 18 MHz / 25.6 (docs/spec/parol6.md); 65,536 of them are 93.2 ms.
  ScriptedCapture capture{LinkKind::kStream};
  const auto sent = [](int i) { return i * 10ms + (i % 10 == 9 ? 2ms : 0ms); };
  for (int i = 0; i < 200; ++i) {
    const auto frame = parol6::encode(parol6::CommandFrame{.command = parol6::Command::kIdle});
    capture.request(sent(i), {frame.begin(), frame.end()});
    const auto interval = std::chrono::duration<double>{i == 0 ? 0ms : sent(i) - sent(i - 1)};
    parol6::TelemetryFrame telemetry;
    telemetry.timing =
        static_cast<std::uint16_t>(interval.count() * 1.005 * parol6::kTicksPerSecond);
    const auto answer = parol6::encode(telemetry);
    capture.answer(sent(i) + 300us, {answer.begin(), answer.end()});
  }
  const auto run = read(capture, parol6::latency::make_listener);
  EXPECT_EQ(run.measured.round_trips.count(), 200U);
  EXPECT_NEAR(value_of(run, "board's clock against the host's"), 0.5, 0.02);
  EXPECT_LT(value_of(run, "frames accepted later than sent, most"), 0.07);
}

TEST(RecordingOfABoard, LeavesIntervalsOutThatWrapTheBoardsField) {
  ScriptedCapture capture{LinkKind::kStream};
  for (int i = 0; i < 30; ++i) {
    const auto frame = parol6::encode(parol6::CommandFrame{.command = parol6::Command::kIdle});
    capture.request(i * 100ms, {frame.begin(), frame.end()});
    const auto answer = parol6::encode(parol6::TelemetryFrame{.timing = 4'800});
    capture.answer(i * 100ms + 1ms, {answer.begin(), answer.end()});
  }
  const auto run = read(capture, parol6::latency::make_listener);
  EXPECT_THAT(run.figures,
              testing::Not(Contains(testing::Field(&Figure::name, HasSubstr("clock")))));
}

TEST(RecordingOfABus, AddsTheBitsOfTheReadToItsBeginning) {
  // An angle of node 2: 200 us for the choice, 470 us for the read, which began 100 us later.
  ScriptedCapture capture{LinkKind::kBus};
  for (int i = 0; i < 20; ++i) {
    capture.request(i * 10ms, hex("80"), 0x12);
    capture.set_details(R"("op":"write","ack":"AA")");
    capture.answer(i * 10ms + 300us, hex("00 00 00 00"), 0x12);
    capture.set_details(R"("op":"read","ack":"A")");
  }
  const auto run = read(capture, morap::latency::make_listener);
  EXPECT_EQ(run.measured.round_trips.count(), 20U);
  EXPECT_EQ(run.measured.round_trips.max(), 770us);
  EXPECT_EQ(run.time_on_wire, 670us);
  EXPECT_DOUBLE_EQ(value_of(run, "utilisation at this rate"), 6.7);
  EXPECT_NEAR(value_of(run, "highest rate for a read of 3 joints"), 1e3 / (3 * 0.77), 0.5);
}

TEST(RecordingOfAServer, TimesCommandsToTheirReplyAndToTheirEnd) {
  ScriptedCapture capture{LinkKind::kSession};
  capture.request(0ms, text("QuitEStop\r\nInit"));
  capture.answer(2ms, text("Accepted\r\n"));
  capture.request(10ms, text("ialize\r\n"));
  capture.answer(14ms, text("Accep"));
  capture.answer(15ms, text("ted\r\n"));
  capture.request(30ms, text("Initialize\r\nnonsense\r\n"));  // while it initializes
  capture.answer(32ms, text("Rejected\r\n"));
  capture.answer(1000ms, text("Heartbeat:1\r\n"));
  capture.answer(2000ms, text("Heartbeat:1\r\n"));
  capture.answer(2510ms, text("Initialized\r\n"));
  capture.answer(3006ms, text("Heartbeat:21\r\n"));
  // Done before it is accepted: it was there already.
  capture.request(3100ms, text("SetJoystickMode:NoMode\r\n"));
  capture.answer(3101ms, text("JoystickModeSet\r\nAccepted\r\n"));
  const auto run = read(capture, kinovazed::latency::make_listener);
  EXPECT_EQ(run.measured.round_trips.count(), 4U);
  EXPECT_EQ(run.measured.lost + run.measured.surplus, 0U);
  EXPECT_EQ(run.measured.round_trips.max(), 5ms);
  EXPECT_DOUBLE_EQ(value_of(run, "Initialize to Initialized, median"), 2500);
  EXPECT_DOUBLE_EQ(value_of(run, "SetJoystickMode to JoystickModeSet, most"), 1);
  EXPECT_DOUBLE_EQ(value_of(run, "heartbeat period, mean"), 1003);
  EXPECT_NEAR(value_of(run, "heartbeat drift against one second"), 3000, 1e-6);
}

TEST(HistogramLog, IsReadAsTheRunThatItWasOf) {
  const auto run = steady(1'000, [](int i) { return i % 100 == 0 ? 25ms : 1ms; });
  const auto again = run_of_log(to_latency_log(run), "run.hlog").value();
  EXPECT_EQ(again.measured.round_trips.count(), 1'000U);
  EXPECT_EQ(again.measured.round_trips.percentile(50), run.measured.round_trips.percentile(50));
  EXPECT_EQ(again.measured.corrected.count(), run.measured.corrected.count());
  const auto rows = percentiles_of(again.measured);
  ASSERT_FALSE(rows.empty());
  EXPECT_FALSE(rows.front().interval);
  EXPECT_TRUE(test::is_valid_json(to_latency_json(again), "docs/schemas/latency.schema.json"));
  EXPECT_THAT(to_text(report_of(again)), HasSubstr("unknown"));
}

TEST(HistogramLog, IsRefusedWithTheLine) {
  const auto run = run_of_log("#[comment]\nnonsense\n", "run.hlog");
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().where, "run.hlog:2");
}

}  // namespace
}  // namespace armjig
