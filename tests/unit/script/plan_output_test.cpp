// SPDX-License-Identifier: Apache-2.0
#include "harness/script/plan_output.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "tests/unit/report/validity.hpp"
#include "tests/unit/script/programs.hpp"

namespace armjig::script {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

Program program() {
  return test::program_of("MoveJoint(70, -90, 180, 0, 0, 180, t=1, trap)\nDelay(0.02)",
                          Dialect::kDocumented);
}

TEST(PlanOutput, TheTableSaysWhoLeadsAndWhoIsBusiest) {
  const auto table = moves_table(program(), test::schedule_of(program()));
  ASSERT_THAT(table.rows, SizeIs(1));
  // 2276 steps in 1 s at 1.5 times the mean: 3414 steps/s of 6500
  EXPECT_THAT(table.rows.front(),
              ElementsAre("2", "MoveJoint(70, -90, 180, 0, 0, 180, t=1, trap)", "trapezoid",
                          "0.00 s", "1.00 s", "j1", "-20.00 deg", "j1", "3413 steps/s", "53 %"));
}

TEST(PlanOutput, CsvHasALineForEachFrame) {
  const auto schedule = test::schedule_of(program());
  std::istringstream csv{to_csv(program(), schedule)};
  std::string header;
  std::getline(csv, header);
  const auto columns = std::ranges::count(header, ',');
  EXPECT_EQ(columns + 1, 4 + 18 + 6);
  std::string line;
  std::size_t lines = 0;
  for (; std::getline(csv, line); ++lines) EXPECT_EQ(std::ranges::count(line, ','), columns);
  EXPECT_EQ(lines, schedule.frames.size());
  EXPECT_THAT(to_csv(program(), schedule),
              HasSubstr("\n0,0.00,2,156,10240,-32000,57905,0,0,32000,"));
}

TEST(PlanOutput, JsonKeepsToItsSchema) {
  const auto json = to_json(program(), test::schedule_of(program()), "a \xFF.rbt");
  EXPECT_TRUE(armjig::test::is_valid_json(json, "docs/schemas/plan.schema.json"));
  EXPECT_THAT(json, HasSubstr("\"duration_s\":1.03"));
}

TEST(PlanOutput, ThePageHasCurvesAndTheArm) {
  const auto report = to_report(program(), test::schedule_of(program()), "a.rbt");
  const auto html = to_html(report);
  for (const auto* part :
       {"Position of each joint", "Speed of each joint", "Acceleration of each joint",
        "Path of the tool from above", "The arm in motion", "MoveJoint(70, -90"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
}

}  // namespace
}  // namespace armjig::script
