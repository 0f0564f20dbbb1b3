// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "harness/report/report.hpp"
#include "tests/unit/report/sample_report.hpp"
#include "tests/unit/report/validity.hpp"

namespace armjig {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

constexpr auto kReport = "docs/schemas/report.schema.json";
constexpr auto kRow = "docs/schemas/report-row.schema.json";

TEST(Json, HasAllOfARow) {
  auto report = test::one_of_each();
  report.rows = {report.rows[1]};
  report.rows[0].evidence = "1 ms\n2 ms";
  EXPECT_EQ(Json::parse(to_json(report)), Json::parse(R"({
    "schema": "armjig.report/1",
    "title": "Conformance of parol6",
    "facts": {"target": "emulated:?profile=firmware", "seed": "42", "armjig": "0.1.0"},
    "conclusion": "findings",
    "counts": {"pass": 0, "deviation": 0, "fail": 1, "flaky": 0, "skipped": 0,
               "inconclusive": 0, "error": 0},
    "rows": [{
      "verdict": "fail",
      "name": "parol6.telemetry.layout",
      "summary": "Speeds are big-endian.",
      "requirement": "parol6.telemetry.layout",
      "level": "must",
      "demand": "The board does what the sentence says.",
      "source": "section 4.2 of the made-up manual",
      "expected": "speed.j1 of 10000 steps/s",
      "actual": "speed.j1 of 4135 steps/s",
      "evidence": "1 ms\n2 ms",
      "repeat": "armjig conformance parol6 --target emulated: --filter parol6.telemetry.layout",
      "duration_s": 0.012345
    }]})"));
}

TEST(Json, HasAllOfASection) {
  Report report;
  report.sections = {{.title = "Latency",
                      .table = {.columns = {"worst"}, .rows = {{"1 ms"}}},
                      .plots = {{.title = "Round trips",
                                 .x = {.label = "ms", .scale = Scale::kLog},
                                 .y = {.label = "count"},
                                 .series = {{.name = "all",
                                             .points = {{1, 2}, {3, HUGE_VAL}},
                                             .shape = Shape::kBars}}}}}};
  EXPECT_EQ(Json::parse(to_json(report))["sections"], Json::parse(R"([{
    "title": "Latency",
    "table": {"columns": ["worst"], "rows": [["1 ms"]]},
    "plots": [{"title": "Round trips",
               "x": {"label": "ms", "scale": "log"},
               "y": {"label": "count", "scale": "linear"},
               "series": [{"name": "all", "shape": "bars",
                           "points": [[1.0, 2.0], [3.0, null]]}]}]}])"));
}

TEST(Json, IsValidAgainstItsPublishedSchema) {
  for (const auto& report :
       {Report{}, test::one_of_each(), test::nasty_report(), test::drive_report()}) {
    EXPECT_TRUE(test::is_valid_json(to_json(report), kReport));
  }
}

TEST(Json, WithAnUnknownVerdictIsInvalid) {
  auto json = Json::parse(to_json(test::one_of_each()));
  json["rows"][0]["verdict"] = "perhaps";
  EXPECT_FALSE(test::is_valid_json(json.dump(), kReport));
}

TEST(Json, WithoutCountsIsInvalid) {
  auto json = Json::parse(to_json(test::one_of_each()));
  json.erase("counts");
  EXPECT_FALSE(test::is_valid_json(json.dump(), kReport));
}

TEST(Json, KeepsWhatADeviceSent) {
  const auto summary = Json::parse(to_json(test::nasty_report()))["rows"][0]["summary"];
  EXPECT_THAT(summary.get<std::string>(), HasSubstr("\x1b[31mred"));
  EXPECT_THAT(summary.get<std::string>(), HasSubstr("bad:\xEF\xBF\xBD "));  // was no UTF-8
}

TEST(Jsonl, IsOneLineAnEvent) {
  const auto report = test::nasty_report();
  for (const auto& line :
       {to_jsonl_start(report), to_jsonl(report.rows[0]), to_jsonl_end(report)}) {
    EXPECT_EQ(std::ranges::count(line, '\n'), 1);
    EXPECT_EQ(line.back(), '\n');
  }
}

TEST(Jsonl, IsValidAgainstItsPublishedSchema) {
  const auto report = test::nasty_report();
  const std::array events{to_jsonl_start(report), to_jsonl(report.rows[1]), to_jsonl_end(report)};
  for (const auto& event : events) {
    EXPECT_TRUE(test::is_valid_json(event, kRow));
    EXPECT_FALSE(test::is_valid_json(event, kReport));
  }
}

TEST(Jsonl, SaysTheSameAsTheWholeReport) {
  const auto report = test::drive_report();
  auto joined = Json::parse(to_jsonl_start(report));
  joined.update(Json::parse(to_jsonl_end(report)));
  for (const auto& row : report.rows) {
    auto event = Json::parse(to_jsonl(row));
    EXPECT_EQ(event["schema"], "armjig.report-row/1");
    event.erase("schema");
    event.erase("event");
    joined["rows"].push_back(event);
  }
  joined["schema"] = "armjig.report/1";
  joined.erase("event");
  EXPECT_EQ(joined, Json::parse(to_json(report)));
}

}  // namespace
}  // namespace armjig
