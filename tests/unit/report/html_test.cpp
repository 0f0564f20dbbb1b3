// SPDX-License-Identifier: Apache-2.0
// What a browser makes of the page is tested by tests/integration/report_page_test.py.
#include <gmock/gmock.h>

#include <string>

#include "harness/report/report.hpp"
#include "tests/unit/report/sample_report.hpp"

namespace armjig {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Html, NeedsNoNetwork) {
  EXPECT_THAT(to_html(test::drive_report()),
              AllOf(Not(HasSubstr("http:")), Not(HasSubstr("https:")), Not(HasSubstr("src=")),
                    Not(HasSubstr("@import")), Not(HasSubstr("url("))));
}

TEST(Html, ForbidsTheNetworkAndForeignScripts) {
  EXPECT_THAT(to_html(Report{}),
              AllOf(HasSubstr("default-src 'none';"), HasSubstr("script-src 'sha256-"),
                    Not(HasSubstr("script-src 'unsafe"))));
}

TEST(Html, ShowsWhatADeviceSentAsText) {
  const auto page = to_html(test::nasty_report());
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("\x1b")));
  EXPECT_THAT(page, HasSubstr(R"(&lt;script&gt;alert(&quot;x&quot;)&lt;/script&gt; &amp; )"));
  EXPECT_THAT(page, HasSubstr("{{title}}"));
}

TEST(Html, OpensFindingsAndTroubleOnly) {
  const auto page = to_html(test::one_of_each());
  for (const auto* open : {"fail", "flaky", "error"}) {
    EXPECT_THAT(page, HasSubstr("data-verdict=\"" + std::string{open} + "\" open>"));
  }
  for (const auto* closed : {"pass", "deviation", "skipped", "inconclusive"}) {
    EXPECT_THAT(page, HasSubstr("data-verdict=\"" + std::string{closed} + "\">\n<summary>"));
  }
}

TEST(Html, SaysFirstWhatCameOfTheRun) {
  EXPECT_THAT(to_html(test::one_of_each()), HasSubstr("<strong>2 findings</strong>"));
  Report passed;
  passed.rows.emplace_back();
  EXPECT_THAT(to_html(passed), HasSubstr("<strong>Passed</strong>"));
}

TEST(Html, OfAReportWithoutChecksHasNoneOfTheirTools) {
  auto report = test::drive_report();
  report.rows.clear();
  EXPECT_THAT(to_html(report), AllOf(Not(HasSubstr("id=\"search\"")), Not(HasSubstr("<strong>")),
                                     HasSubstr("J1 follows its command")));
}

TEST(Html, AlignsColumnsOfNumbersRight) {
  Report report;
  report.sections = {
      {.title = "T", .table = {.columns = {"name", "n"}, .rows = {{"2 of", "-3 ms"}, {"b", ""}}}}};
  EXPECT_THAT(to_html(report), AllOf(HasSubstr("<td>2 of</td><td class=\"number\">-3 ms</td>"),
                                     HasSubstr("<th scope=\"col\" class=\"number\">n</th>")));
}

TEST(Html, HasFailuresBeforePasses) {
  Report report;
  report.rows = {{.verdict = Verdict::kPass, .name = "a.one.good"},
                 {.verdict = Verdict::kPass, .name = "a.two.good"},
                 {.verdict = Verdict::kFail, .name = "a.two.bad"},
                 {.verdict = Verdict::kPass, .name = "a.three.good"}};
  const auto page = to_html(report);
  const auto place = [&page](const char* name) { return page.find(name); };
  EXPECT_LT(place("a.two.bad"), place("a.two.good"));
  EXPECT_LT(place("a.two.good"), place("a.one.good"));
  EXPECT_LT(place("a.one.good"), place("a.three.good"));
}

}  // namespace
}  // namespace armjig
