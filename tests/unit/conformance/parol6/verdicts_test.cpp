// SPDX-License-Identifier: Apache-2.0
// What a run says of boards that must not pass for sound ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "conformance/parol6/suite.hpp"
#include "conformance/run.hpp"
#include "harness/link/port_around.hpp"
#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig::parol6::conformance {
namespace {

using testing::Contains;
using testing::HasSubstr;

using Change = std::function<void(std::span<std::byte> frame)>;

/// An emulated board whose answers are changed before they are read. Nobody can touch it.
class ChangedBoard final : public StreamPort {
 public:
  explicit ChangedBoard(Change change)
      : board_{test::emulated<cli::OnStream>("parol6")}, change_{std::move(change)} {}

  Result<void> write(Bytes bytes) override { return board_.port().write(bytes); }
  /// Frame by frame: in memory an answer comes as a whole.
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    auto size = board_.port().read(into, deadline);
    if (!size) return size;
    for (std::size_t at = 0; at + kTelemetryFrameSize <= *size; at += kTelemetryFrameSize) {
      change_(into.subspan(at, kTelemetryFrameSize));
    }
    return size;
  }
  [[nodiscard]] Instant now() const override { return board_.port().now(); }

 private:
  Rig<StreamPort> board_;
  Change change_;
};

/// As reached by a machine that stands still for 300 ms, five seconds after the first command to
/// home.
class BoardBehindAPause final : public StreamAround {
 public:
  using PortAround::PortAround;
  Result<void> write(Bytes bytes) override {
    constexpr std::chrono::seconds kLater{5};
    if (!stands_ && frame_command(bytes) == Command::kHome) stands_ = now() + kLater;
    return inner().write(bytes);
  }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    constexpr std::chrono::milliseconds kStands{300};
    auto size = inner().read(into, deadline);
    const bool is_pause = size && *size == 0;
    if (!is_pause || !stands_ || now() < *stands_) return size;
    stands_ = Instant::max();
    return inner().read(into, now() + kStands);
  }

 private:
  static Command frame_command(Bytes frame) {
    const auto offset = find_field(command_fields(), "command")->offset;
    return offset < frame.size() ? Command{std::to_integer<std::uint8_t>(frame[offset])}
                                 : Command::kIdle;
  }
  std::optional<Instant> stands_;
};

std::byte& byte_of(std::span<std::byte> frame, std::string_view field) {
  return frame[find_field(telemetry_fields(), field)->offset];
}

void invert_estop(std::span<std::byte> frame) {
  byte_of(frame, "io") ^= std::byte{io_flag::kEstopReleased};
}
void never_home(std::span<std::byte> frame) { byte_of(frame, "homed") = std::byte{0x03}; }
void end_wrongly(std::span<std::byte> frame) { frame.back() = std::byte{0x03}; }

Report run(Change change, const std::string& filter, Hand hand = {}) {
  Rig<StreamPort> rig{std::make_unique<ChangedBoard>(std::move(change))};
  const auto bench = make_bench(std::move(rig), {});
  (*bench)->set_hand(std::move(hand));
  RunOptions options;
  options.selection.filter = filter;
  options.permissions = Permissions::all();
  return run_suite(suite(), **bench, options, [](const ReportRow&) {});
}

const ReportRow* row(const Report& report, std::string_view name) {
  const auto found = std::ranges::find(report.rows, name, &ReportRow::name);
  return found == report.rows.end() ? nullptr : &*found;
}

TEST(BoardVerdicts, AnEmergencyStopThatReadsInvertedIsNoGreenRun) {
  const auto report = run(invert_estop, "parol6.jog.");
  const auto* start = row(report, "parol6.start");
  ASSERT_TRUE(start);
  EXPECT_EQ(start->verdict, Verdict::kError);
  EXPECT_THAT(start->actual, HasSubstr("pressed, or reads inverted"));
  EXPECT_EQ(conclusion_of(report), Conclusion::kRig);
}

TEST(BoardVerdicts, AnEmergencyStopThatAHandReleasedHasToReadReleased) {
  std::vector<std::string> asked;
  const auto report = run(invert_estop, "parol6.jog.",
                          {.has = [](std::string_view input) { return input == "estop"; },
                           .set =
                               [&asked](std::string_view input, std::int64_t value) {
                                 asked.push_back(std::string{input} + std::to_string(value));
                                 return true;
                               }});
  EXPECT_THAT(asked, Contains("estop1"));
  const auto* start = row(report, "parol6.start");
  ASSERT_TRUE(start);
  EXPECT_EQ(start->verdict, Verdict::kFail);
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
}

TEST(BoardVerdicts, AHomingThatThisMachineDidNotSeeIsBegunAgain) {
  auto board =
      *test::wiring<cli::OnStream>("parol6").open_emulated(parse_target("emulated:").value());
  const auto bench =
      make_bench(Rig<StreamPort>{std::make_unique<BoardBehindAPause>(std::move(board))}, {});
  RunOptions options;
  options.selection.filter = "parol6.home.back-off";
  options.selection.tier = Tier::kFull;
  options.permissions = Permissions::all();
  const auto report = run_suite(suite(), **bench, options, [](const ReportRow&) {});
  EXPECT_GE(report.count(Verdict::kPass), 5U);
  EXPECT_EQ(report.count(Verdict::kInconclusive), 0U);
  EXPECT_EQ(report.count(Verdict::kFail), 0U);
}

TEST(BoardVerdicts, ABoardThatNeverHomesIsAFinding) {
  const auto report = run(never_home, "parol6.goto.law");
  const auto* start = row(report, "parol6.start");
  ASSERT_TRUE(start);
  EXPECT_EQ(start->verdict, Verdict::kFail);
  EXPECT_THAT(start->expected, HasSubstr("homed within 90 s"));
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
}

TEST(BoardVerdicts, AnswersThatEndWronglyAreTheFindingAndNoSilence) {
  const auto report = run(end_wrongly, "parol6.frame.");
  const auto* alive = row(report, "parol6.alive");
  ASSERT_TRUE(alive);
  EXPECT_EQ(alive->verdict, Verdict::kFail);
  EXPECT_THAT(alive->expected, HasSubstr("01 02"));
  EXPECT_THAT(alive->actual, HasSubstr("FF FF FF 38"));
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
}

/// Some of the suite's cases on an emulated board in memory that is guarded like a real one.
Report run_guarded(const std::string& emulated, const std::string& filter) {
  static std::string target;
  target = emulated;
  auto wiring = test::wiring<cli::OnStream>("parol6");
  wiring.open_real = [](const Target& /*place*/, const SerialLine& /*line*/) {
    return test::wiring<cli::OnStream>("parol6").open_emulated(parse_target(target).value());
  };
  RigOptions how{.target = parse_target("pty:/dev/null").value()};
  how.permissions = Permissions::all();
  const auto bench = make_bench(*Rig<StreamPort>::open(wiring, how), how);
  RunOptions options;
  options.selection.filter = filter;
  options.permissions = how.permissions;
  return run_suite(suite(), **bench, options, [](const ReportRow&) {});
}

TEST(BoardVerdicts, AGoToThatKeepsSixteenBitsIsAFailureOfTheCaseAndNotTheGuards) {
  const auto report = run_guarded("emulated:?fault=quirk:goal-16-bit", "parol6.goto.arrives");
  const auto* arrives = row(report, "parol6.goto.arrives");
  ASSERT_TRUE(arrives);
  EXPECT_EQ(arrives->verdict, Verdict::kFail) << to_text(*arrives);
  EXPECT_THAT(arrives->actual, HasSubstr("the guard stopped it: j3"));
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
}

TEST(BoardVerdicts, AGoToThatKeepsSixteenBitsIsFoundWhicheverCaseIsFirst) {
  const auto report = run_guarded("emulated:?fault=quirk:goal-16-bit", "parol6.goto.");
  const auto* stops = row(report, "parol6.goto.stops");
  ASSERT_TRUE(stops);
  EXPECT_EQ(stops->verdict, Verdict::kFail) << to_text(*stops);
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
}

TEST(BoardVerdicts, AnArmThatStraysOnItsWayToTheStartIsTheDevicesDoing) {
  const auto report = run_guarded("emulated:?fault=quirk:goal-16-bit", "parol6.goto.s");
  const auto* start = row(report, "parol6.start");
  ASSERT_TRUE(start);
  EXPECT_EQ(start->verdict, Verdict::kFail) << to_text(*start);
  EXPECT_THAT(start->actual, HasSubstr("the guard stopped it: j3"));
}

TEST(BoardVerdicts, ASoundBoardIsNotStoppedByTheGuardInAGoTo) {
  const auto report = run_guarded("emulated:", "parol6.goto.");
  for (const auto& each : report.rows) EXPECT_NE(each.verdict, Verdict::kFail) << to_text(each);
}

}  // namespace
}  // namespace armjig::parol6::conformance
