// SPDX-License-Identifier: Apache-2.0
#include "harness/report/failures.hpp"

#include <gmock/gmock.h>

#include <string>

#include "tests/unit/report/sample_report.hpp"

namespace armjig {
namespace {

TEST(Failures, AreALineEachAndNothingElseIs) {
  Report report;
  report.rows = {{.verdict = Verdict::kPass, .name = "a.good"},
                 {.verdict = Verdict::kFail, .name = "a.bad", .expected = "1", .actual = "2"},
                 {.verdict = Verdict::kSkipped, .name = "a.left", .actual = "needs a hand"},
                 {.verdict = Verdict::kFlaky, .name = "a.odd", .actual = "3"},
                 {.verdict = Verdict::kError, .name = "a.alive", .actual = "silence"}};
  EXPECT_EQ(failures_text(report),
            "FAIL      a.bad                                expected 1; got 2\n"
            "FLAKY     a.odd                                3\n"
            "ERROR     a.alive                              silence\n");
}

TEST(Failures, AreNothingIfThereAreNone) {
  Report report;
  report.rows = {{.verdict = Verdict::kPass, .name = "a.good"}};
  EXPECT_EQ(failures_text(report), "");
}

TEST(Failures, AreCutInWholeCharacters) {
  Report report;
  std::string micro;
  for (int i = 0; i < 120; ++i) micro += "\u00B5";
  report.rows = {{.verdict = Verdict::kFail, .name = "a.bad", .actual = micro}};
  EXPECT_EQ(failures_text(report),
            "FAIL      a.bad                                " + micro.substr(0, 2 * 96) + " ...\n");
}

TEST(Failures, LetNoDeviceWriteToTheTerminal) {
  EXPECT_THAT(failures_text(test::nasty_report()), ::testing::Not(::testing::HasSubstr("\x1b")));
}

TEST(Failures, HaveTheColourOfTheirVerdict) {
  Report report;
  report.rows = {{.verdict = Verdict::kFail, .name = "a.bad"}};
  EXPECT_THAT(failures_text(report, Style::kColour),
              ::testing::HasSubstr("\x1b[1;31mFAIL     \x1b[0m"));
}

}  // namespace
}  // namespace armjig
