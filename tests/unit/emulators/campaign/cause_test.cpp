// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/cause.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace armjig::campaign {
namespace {

struct Seen {
  std::string asked;
  std::string answer;
  std::string part;
  std::size_t size = 1;
  std::vector<std::string> also{};  ///< what its script shows besides
};

Finding finding_of(const Seen& seen) {
  Finding finding;
  finding.symptom.asked = seen.asked;
  finding.symptom.answer = seen.answer;
  finding.symptom.parts = {seen.part};
  finding.size = seen.size;
  finding.shows = finding.symptom.ways();
  finding.shows.insert(finding.shows.end(), seen.also.begin(), seen.also.end());
  std::ranges::sort(finding.shows);
  return finding;
}

std::size_t causes_in(const std::vector<Seen>& seen) {
  std::vector<Finding> findings;
  for (const auto& one : seen) findings.push_back(finding_of(one));
  return causes_of(findings).size();
}

TEST(Cause, IsOneWhereTheShortestScriptOfOneShowsTheOther) {
  EXPECT_EQ(causes_in({{"jog", "telemetry", "speed.j1"},
                       {"idle", "telemetry", "missing", 4, {"telemetry: speed.j1"}}}),
            1U);
}

TEST(Cause, IsAnotherWhereNothingIsShared) {
  EXPECT_EQ(causes_in({{"jog", "telemetry", "speed.j1"}, {"home", "telemetry", "homed"}}), 2U);
}

TEST(Cause, OfTheSameFieldIsOneWhateverWasAsked) {
  EXPECT_EQ(causes_in({{"jog", "telemetry", "speed.j1"}, {"home", "telemetry", "speed.j1"}}), 1U);
}

TEST(Cause, OfWholeMessagesDependsOnWhatWasAsked) {
  EXPECT_EQ(causes_in({{"Freeze", "Rejected", "missing"}, {"Retract", "Rejected", "missing"}}), 2U);
  EXPECT_EQ(causes_in({{"Freeze", "Rejected", "missing"},
                       {"3 messages at once, the last Freeze", "Rejected", "missing"}}),
            1U);
}

TEST(Cause, IsNotWhatShowsAnyway) {
  EXPECT_EQ(causes_in({{"idle", "telemetry", "gripper.speed", 0},
                       {"home", "telemetry", "homed", 2, {"telemetry: gripper.speed"}}}),
            2U);
}

TEST(Cause, DoesNotJoinTwoThatShareAWay) {
  const auto causes = causes_in({{"Freeze", "Rejected", "missing", 2, {"Heartbeat: state"}},
                                 {"Retract", "Rejected", "missing", 2, {"Heartbeat: state"}},
                                 {"Initialize", "Heartbeat", "state", 5}});
  EXPECT_EQ(causes, 2U);
}

TEST(Cause, HasItsShortestFindingInFront) {
  const std::vector<Finding> findings{finding_of({"home", "telemetry", "speed.j1", 4}),
                                      finding_of({"jog", "telemetry", "speed.j1", 1})};
  const auto causes = causes_of(findings);
  ASSERT_EQ(causes.size(), 1U);
  EXPECT_EQ(causes.front().finding, &findings[1]);
  ASSERT_EQ(causes.front().further.size(), 1U);
  EXPECT_EQ(causes.front().further.front(), &findings[0]);
}

TEST(Cause, KeepsNewsFromWhatIsKnown) {
  std::vector<Finding> findings{finding_of({"home", "telemetry", "speed.j1"}),
                                finding_of({"jog", "telemetry", "speed.j1"})};
  findings[0].known = "issue 12";
  EXPECT_EQ(causes_of(findings).size(), 2U);
}

}  // namespace
}  // namespace armjig::campaign
