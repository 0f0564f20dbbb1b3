// SPDX-License-Identifier: Apache-2.0
#include "harness/console/watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/console/kinovazed/console.hpp"
#include "harness/console/morap/console.hpp"
#include "harness/console/parol6/console.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::unique_ptr<Watched> board() {
  return *parol6::console::watch(test::emulated<cli::OnStream>("parol6"), "emulated:", {10ms, {}});
}
std::unique_ptr<Watched> server() {
  return *kinovazed::console::watch(test::emulated<cli::OnServer>("kinovazed"),
                                    "emulated:", {100ms, {}});
}
std::unique_ptr<Watched> nodes() {
  return *morap::console::watch(test::emulated<cli::OnBus>("morap", "emulated:?nodes=1,2"),
                                "emulated:", {100ms, {}});
}

/// What came as JSON while the plan was carried out.
std::vector<std::string> look(Watched& watched, Watch& watch) {
  std::vector<std::string> all;
  const auto heard = [&] {
    for (auto& line : watched.json_lines()) all.push_back(std::move(line));
  };
  while (!watch.is_over()) EXPECT_TRUE(watch.cycle(heard));
  EXPECT_TRUE(watch.end(heard));
  return all;
}

TEST(Watch, AsksABoardForATime) {
  const auto watched = board();
  Watch watch{*watched, {.period = 10ms, .time = 1s}};
  EXPECT_THAT(look(*watched, watch), SizeIs(100));
  EXPECT_EQ(watched->answers(), 100);
  EXPECT_THAT(watched->lines(), ElementsAre(HasSubstr("sent 100 lost 0")));
  EXPECT_THAT(watch.summary(), AllOf(HasSubstr("100 sent, 100 answered, 0 lost"),
                                     HasSubstr("schedule   0 skipped, late by 0.000 / ")));
  EXPECT_THAT(watch.page("board"), AllOf(HasSubstr("board, 1.0 s\n"), HasSubstr("estop")));
  EXPECT_EQ(watch.seconds_since_start(), 1);
}

TEST(Watch, AsksSoManyTimes) {
  const auto watched = board();
  Watch watch{*watched, {.period = 10ms, .count = 3}};
  EXPECT_THAT(look(*watched, watch), SizeIs(3));
  EXPECT_THAT(watch.summary(), HasSubstr("3 sent"));
}

TEST(Watch, HasAPageBeforeAnythingCame) {
  const auto watched = board();
  const Watch watch{*watched, {.period = 10ms}};
  EXPECT_THAT(watch.page("board"), HasSubstr("no telemetry yet"));
  EXPECT_THAT(watched->lines(), IsEmpty());
  EXPECT_FALSE(watch.is_over());
}

TEST(Watch, CountsWhatAServerSaysByItself) {
  const auto watched = server();
  Watch watch{*watched, {.period = 100ms, .count = 3}};
  EXPECT_THAT(look(*watched, watch), SizeIs(3));
  EXPECT_EQ(watched->answers(), 3);
  EXPECT_THAT(watched->lines(), ElementsAre(HasSubstr("emergency stop")));
  EXPECT_THAT(watched->panel(), HasSubstr("state      emergency stop"));
  EXPECT_THAT(watch.summary(), HasSubstr("3 beats, 0 events"));
}

TEST(Watch, AsksEveryNodeOnABusOnceARound) {
  const auto watched = nodes();
  Watch watch{*watched, {.period = 100ms, .time = 1s}};
  const auto json = look(*watched, watch);
  ASSERT_THAT(json, SizeIs(20));
  EXPECT_THAT(json[2], AllOf(HasSubstr("\"time_s\":0.1,"), HasSubstr("\"node\":1")));
  EXPECT_THAT(json[3], HasSubstr("\"node\":2"));
  EXPECT_THAT(watched->lines(), SizeIs(2));
  EXPECT_THAT(watch.summary(), HasSubstr("20 asked, 20 answered"));
}

TEST(Watch, SaysThatNoNodeIsThere) {
  const RigOptions how{.target = *parse_target("emulated:"),
                       .impairment = *parse_impairment("loss=100%")};
  auto rig = cli::open_rig<cli::OnBus>(test::device("morap"), how);
  const auto opened = morap::console::watch(*std::move(rig), "emulated:", {100ms, {}});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::kTimedOut);
  EXPECT_THAT(opened.error().hint, HasSubstr("is the bus powered?"));
}

}  // namespace
}  // namespace armjig
