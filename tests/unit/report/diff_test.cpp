// SPDX-License-Identifier: Apache-2.0
#include "harness/report/diff.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "harness/report/report.hpp"

namespace armjig {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string report(const std::vector<std::pair<std::string, Verdict>>& rows) {
  Report report;
  for (const auto& [name, verdict] : rows) {
    ReportRow row;
    row.name = name;
    row.verdict = verdict;
    report.rows.push_back(row);
  }
  return to_json(report);
}

std::vector<std::string> names(const std::vector<VerdictChange>& changes) {
  std::vector<std::string> names;
  for (const auto& change : changes) names.push_back(change.name);
  return names;
}

TEST(ReportDiff, TellsFixedBrokenAndNew) {
  const auto before = report({{"stays", Verdict::kPass},
                              {"mended", Verdict::kFail},
                              {"broken", Verdict::kPass},
                              {"broken-rig", Verdict::kDeviation},
                              {"still-bad", Verdict::kFlaky},
                              {"silent", Verdict::kPass},
                              {"gone", Verdict::kPass}});
  const auto after = report({{"stays", Verdict::kDeviation},
                             {"mended", Verdict::kPass},
                             {"broken", Verdict::kFail},
                             {"broken-rig", Verdict::kError},
                             {"still-bad", Verdict::kFail},
                             {"silent", Verdict::kSkipped},
                             {"new", Verdict::kPass},
                             {"new-and-bad", Verdict::kFail}});
  const auto diff = compare_reports(before, "a", after, "b");
  ASSERT_TRUE(diff);
  EXPECT_THAT(names(diff->fixed), ElementsAre("mended"));
  EXPECT_THAT(names(diff->broken), ElementsAre("broken", "broken-rig", "new-and-bad"));
  EXPECT_THAT(names(diff->added), ElementsAre("new"));
  EXPECT_THAT(names(diff->lost), ElementsAre("gone", "silent"));
  EXPECT_THAT(to_text(*diff), HasSubstr("broken  new-and-bad (absent -> fail)\n"));
  EXPECT_THAT(to_text(*diff), HasSubstr("1 fixed, 3 broken, 1 new, 2 not run any more\n"));
}

TEST(ReportDiff, NamesWhatIsNoReport) {
  const auto good = report({});
  for (const auto* bad : {"", "[]", "{}", R"({"schema": "armjig.report/1"})",
                          R"({"schema": "armjig.report/1", "rows": [3]})",
                          R"({"schema": "armjig.report/1", "rows": [{"name": 3}]})"}) {
    const auto diff = compare_reports(good, "good.json", bad, "bad.json");
    ASSERT_FALSE(diff) << bad;
    EXPECT_EQ(diff.error().where, "bad.json");
    EXPECT_FALSE(compare_reports(bad, "bad.json", good, "good.json")) << bad;
  }
}

}  // namespace
}  // namespace armjig
