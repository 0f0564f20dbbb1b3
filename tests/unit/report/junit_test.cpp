// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <string>

#include "harness/report/report.hpp"
#include "tests/unit/report/sample_report.hpp"
#include "tests/unit/report/validity.hpp"

namespace armjig {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(Junit, IsValidAgainstTheSchema) {
  for (const auto& report :
       {Report{}, test::one_of_each(), test::nasty_report(), test::drive_report()}) {
    EXPECT_TRUE(test::is_valid_junit(to_junit(report)));
  }
}

TEST(Junit, WouldBeInvalidWithAWrongTimeOrWithoutACount) {
  const auto xml = to_junit(test::one_of_each());
  EXPECT_FALSE(test::is_valid_junit(replaced(xml, R"(time="0.012")", R"(time="12 ms")")));
  EXPECT_FALSE(test::is_valid_junit(replaced(xml, R"( errors="0")", "")));
  EXPECT_FALSE(test::is_valid_junit(replaced(xml, "made-up", "made-up\x1b")));
}

TEST(Junit, HasASuiteForEachTopic) {
  const auto xml = to_junit(test::drive_report());
  EXPECT_THAT(xml, HasSubstr(R"(<testsuites name="Drive run of parol6, 60 s at 100 Hz" tests="7")"
                             R"( failures="2" errors="1" time="0.086">)"));
  EXPECT_THAT(xml, HasSubstr(R"(<testsuite name="parol6.telemetry" tests="2" failures="2")"
                             R"( errors="0" time="0.025" skipped="0")"
                             R"( timestamp="2026-03-29T14:05:09">)"));
  EXPECT_THAT(xml, HasSubstr(R"(<property name="seed" value="42" />)"));
}

TEST(Junit, SaysNothingInsideACaseThatPassed) {
  EXPECT_THAT(to_junit(test::one_of_each()),
              HasSubstr(R"(<testcase classname="parol6.frame" name="parol6.frame.burst")"
                        R"( time="0.012" />)"));
}

TEST(Junit, CallsFailedAndFlakyFailures) {
  const auto xml = to_junit(test::one_of_each());
  EXPECT_THAT(xml, HasSubstr(R"(<failure type="fail" message="expected speed.j1 of 10000 steps/s;)"
                             R"( got speed.j1 of 4135 steps/s">Speeds are big-endian.)"));
  EXPECT_THAT(xml, HasSubstr(R"(<failure type="flaky" message="late in 3 of 20 runs">)"));
}

TEST(Junit, CallsTroubleWithTheRigAnError) {
  EXPECT_THAT(to_junit(test::one_of_each()), HasSubstr(R"(<error type="error" message=")"));
}

TEST(Junit, SkipsWithTheReason) {
  const auto xml = to_junit(test::one_of_each());
  EXPECT_THAT(xml, HasSubstr(R"(<skipped message="skipped: motion needs --allow move" />)"));
  EXPECT_THAT(xml, HasSubstr(R"(<skipped message="inconclusive: nothing had moved)"));
}

TEST(Junit, ShowsWhatXmlForbids) {
  const auto xml = to_junit(test::nasty_report());
  EXPECT_THAT(xml,
              HasSubstr(R"(&lt;script&gt;alert("x")&lt;/script&gt; &amp; 'q' ]]&gt; {{title}} )"
                        R"(\x1B[31mred)"));
  EXPECT_THAT(xml, HasSubstr(R"(&lt;script>alert(&quot;x&quot;)&lt;/script> &amp; 'q' ]]> )"
                             R"({{title}} \x1B[31mred)"));
  EXPECT_THAT(xml, Not(HasSubstr("<script>")));
}

}  // namespace
}  // namespace armjig
