// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <regex>
#include <string>

#include "harness/report/report.hpp"
#include "tests/unit/report/sample_report.hpp"

namespace armjig {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr auto kPassed =
    "PASS      parol6.frame.burst                   A burst of 32 frames is answered frame by "
    "frame.\n";

constexpr auto kFailed =
    R"(FAIL      parol6.telemetry.layout              Speeds are big-endian.
          requirement  parol6.telemetry.layout (must): The board does what the sentence says.
          source       section 4.2 of the made-up manual
          expected     speed.j1 of 10000 steps/s
          got          speed.j1 of 4135 steps/s
          last exchange
            12.000 ms to_device   command, 52 bytes
                      FF FF FF 34 00 00 27 10 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 7B
                      command            123 (jog)
                      speed.j1           10000 steps/s
            13.250 ms from_device telemetry, 60 bytes
                      FF FF FF 38 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 10 27 00 00 00 00
                      speed.j1           4135 steps/s
          again        armjig conformance parol6 --target emulated: --filter parol6.telemetry.layout
)";

TEST(Text, IsOneLineForARowThatPassed) { EXPECT_EQ(to_text(test::one_of_each().rows[0]), kPassed); }

TEST(Text, ShowsAllThatAFindingHas) { EXPECT_EQ(to_text(test::one_of_each().rows[1]), kFailed); }

TEST(Text, GivesTheReasonOfASkip) {
  EXPECT_THAT(to_text(test::one_of_each().rows[4]),
              HasSubstr("reason       motion needs --allow move\n"));
}

TEST(Text, HasTheSameWordsWithColour) {
  const auto report = test::drive_report();
  const auto coloured = to_text(report, Style::kColour);
  EXPECT_THAT(coloured, HasSubstr("\x1b[1;31mFAIL     \x1b[0m"));
  EXPECT_EQ(std::regex_replace(coloured, std::regex{"\x1b\\[[0-9;]*m"}, ""), to_text(report));
}

TEST(Text, LetsNoDeviceWriteToTheTerminal) {
  const auto text = to_text(test::nasty_report());
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  EXPECT_THAT(text, Not(HasSubstr("\xC2\x9B")));
  EXPECT_THAT(text, HasSubstr(R"(\x1B[31mred\x1B[0m nul:\x00)"));
}

TEST(Text, LinesUpTables) {
  const ReportSection section{
      .title = "Latency",
      .text = "All of them.",
      .table = {.columns = {"stage", "worst"}, .rows = {{"send µs", "21", "odd"}, {"receive"}}},
      .plots = {{.title = "Round trips"}}};
  EXPECT_EQ(to_text(section),
            "Latency\n"
            "All of them.\n"
            "  stage     worst\n"
            "  send µs   21      odd\n"
            "  receive\n"
            "  plot: Round trips\n");
}

TEST(Text, OfAnEmptyReportIsItsTitleAndCounts) {
  Report report;
  report.title = "Nothing";
  EXPECT_EQ(to_text(report), "Nothing\n\n0 passed, 0 failed\n");
}

}  // namespace
}  // namespace armjig
