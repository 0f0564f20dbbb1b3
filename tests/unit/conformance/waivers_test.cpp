// SPDX-License-Identifier: Apache-2.0
#include "conformance/waivers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

namespace armjig {
namespace {

using testing::HasSubstr;

constexpr Requirement kExcusable[] = {{"n.fail", Level::kMust, "It is one.", "here"}};
const Chapter kExcusableChapters[] = {
    {"Excused", {std::begin(kExcusable), std::end(kExcusable)}, {}}};
const Suite kExcused{"n", "7", kExcusableChapters, {}};

constexpr std::chrono::year_month_day kToday{std::chrono::year{2026}, std::chrono::month{11},
                                             std::chrono::day{21}};

Outcome<std::vector<Waiver>> waivers(const std::string& entries) {
  return parse_waivers(R"({"schema": "armjig.waivers/1", "waivers": [)" + entries + "]}", kExcused,
                       kToday, "w.json");
}

TEST(ConformanceWaivers, AreReadWithReasonAndLastDay) {
  const auto read =
      waivers(R"({"requirement": "n.fail", "reason": "why", "expires": "2026-11-21"})");
  ASSERT_TRUE(read) << describe(read.error());
  EXPECT_EQ(read->at(0).requirement, "n.fail");
  EXPECT_EQ(read->at(0).reason, "why");
  EXPECT_EQ(to_string(read->at(0).expires), "2026-11-21");
}

TEST(ConformanceWaivers, AreRefusedWithTheReasonWhy) {
  const auto hint = [](const std::string& entries) { return describe(waivers(entries).error()); };
  EXPECT_THAT(hint(R"({"requirement": "n.fail", "reason": "why", "expires": "2026-11-20"})"),
              HasSubstr("expired on 2026-11-20"));
  EXPECT_THAT(hint(R"({"requirement": "n.none", "reason": "why", "expires": "2027-01-01"})"),
              HasSubstr("n.none"));
  EXPECT_THAT(hint(R"({"requirement": "n.fail", "reason": "", "expires": "2027-01-01"})"),
              HasSubstr("reason"));
  EXPECT_THAT(hint(R"({"requirement": "n.fail", "reason": "why", "expires": "2027-02-30"})"),
              HasSubstr("date"));
  const auto twice =
      std::string{R"({"requirement": "n.fail", "reason": "w", "expires": "2027-01-01"})"};
  EXPECT_THAT(hint(twice + "," + twice), HasSubstr("twice"));
  for (const auto* text : {"", "[]", "{}", R"({"schema": "armjig.waivers/1"})"}) {
    EXPECT_FALSE(parse_waivers(text, kExcused, kToday, "w.json")) << text;
  }
}

}  // namespace
}  // namespace armjig
