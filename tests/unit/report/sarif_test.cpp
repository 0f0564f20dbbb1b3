// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/report/report.hpp"
#include "tests/unit/report/sample_report.hpp"
#include "tests/unit/report/validity.hpp"

namespace armjig {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAre;

Json run_of(const Report& report) { return Json::parse(to_sarif(report))["runs"][0]; }

std::vector<std::string> values(const Json& array, const char* key) {
  std::vector<std::string> values;
  for (const auto& entry : array) values.push_back(entry[key]);
  return values;
}

/// Of each result, as FILE:LINE.
std::vector<std::string> places(const Json& run) {
  std::vector<std::string> places;
  for (const auto& result : run["results"]) {
    const auto& place = result["locations"][0]["physicalLocation"];
    places.push_back(place["artifactLocation"]["uri"].get<std::string>() + ':' +
                     std::to_string(place["region"]["startLine"].get<int>()));
  }
  return places;
}

TEST(Sarif, IsValidAgainstTheSchema) {
  for (const auto& report :
       {Report{}, test::one_of_each(), test::nasty_report(), test::drive_report()}) {
    EXPECT_TRUE(test::is_valid_json(to_sarif(report), "tests/data/sarif-subset.schema.json"));
  }
}

TEST(Sarif, WouldBeInvalidWithAnUnknownLevel) {
  auto json = Json::parse(to_sarif(test::one_of_each()));
  json["runs"][0]["results"][0]["level"] = "fatal";
  EXPECT_FALSE(test::is_valid_json(json.dump(), "tests/data/sarif-subset.schema.json"));
}

TEST(Sarif, HasAResultForEachFindingAndDeviation) {
  const auto results = run_of(test::one_of_each())["results"];
  EXPECT_THAT(
      values(results, "ruleId"),
      ElementsAre("parol6.telemetry.layout", "parol6.frame.check", "parol6.telemetry.timing"));
  EXPECT_THAT(values(results, "level"), ElementsAre("error", "note", "warning"));
}

TEST(Sarif, NamesEachRequirementOnce) {
  auto report = test::one_of_each();
  report.rows.insert(report.rows.begin(), report.rows[1]);
  report.rows[0].name = "parol6.telemetry.layout.again";
  const auto run = run_of(report);
  const auto& rules = run["tool"]["driver"]["rules"];
  EXPECT_EQ(rules.size(), 6);  // of eight rows: one is there twice, one is the rig
  for (const auto& result : run["results"]) {
    EXPECT_EQ(rules[result["ruleIndex"].get<std::size_t>()]["id"], result["ruleId"]);
  }
  EXPECT_EQ(run["results"][0]["partialFingerprints"]["armjigCase/v1"],
            "parol6.telemetry.layout.again");
}

TEST(Sarif, TakesARowWithoutRequirementForItsOwnRule) {
  auto report = test::one_of_each();
  report.rows[1].requirement.clear();
  EXPECT_EQ(run_of(report)["results"][0]["ruleId"], "parol6.telemetry.layout");
}

TEST(Sarif, PointsToTheLineOfTheRequirement) {
  auto report = test::one_of_each();
  for (auto& row : report.rows) row.document = "docs/spec/parol6.md";
  report.rows[1].line = 17;
  EXPECT_TRUE(test::is_valid_json(to_sarif(report), "tests/data/sarif-subset.schema.json"));
  const auto run = run_of(report);
  EXPECT_THAT(places(run), ElementsAre("docs/spec/parol6.md:17", "docs/spec/parol6.md:1",
                                       "docs/spec/parol6.md:1"));
  const auto rule = run["results"][0]["ruleIndex"].get<std::size_t>();
  EXPECT_EQ(run["tool"]["driver"]["rules"][rule]["help"]["text"],
            "Source: section 4.2 of the made-up manual (docs/spec/parol6.md, line 17)");
}

TEST(Sarif, OfADeviceWithoutADocumentPointsToTheReport) {
  EXPECT_THAT(places(run_of(test::one_of_each())),
              ElementsAre("armjig.sarif:1", "armjig.sarif:1", "armjig.sarif:1"));
}

TEST(Sarif, BlamesTheRigNotTheDevice) {
  const auto invocation = run_of(test::one_of_each())["invocations"][0];
  EXPECT_EQ(invocation["executionSuccessful"], false);
  EXPECT_EQ(
      invocation["toolExecutionNotifications"][0]["message"]["text"],
      "parol6.alive: no sign of life after parol6.estop.release (expected an answer to a good "
      "message; got silence)");
}

TEST(Sarif, OfAnEmptyReportSaysThatNothingRan) {
  const auto run = run_of(Report{});
  EXPECT_TRUE(run["results"].empty());
  EXPECT_EQ(run["invocations"][0]["exitCode"], 4);
}

}  // namespace
}  // namespace armjig
