// SPDX-License-Identifier: Apache-2.0
#include "harness/console/generic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "harness/console/watch.hpp"
#include "harness/wire/demo/demo.hpp"
#include "harness/wire/morap/dissector.hpp"
#include "tests/unit/console/transcript.hpp"
#include "tests/unit/support/devices.hpp"

namespace armjig::generic {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

StreamLink demo_link() { return StreamLink{test::emulated<cli::OnStream>("demo")}; }
StreamLink bus_link() {
  return StreamLink{test::emulated<cli::OnBus>("morap", "emulated:?nodes=1")};
}

TEST(GenericConsole, SendsBytesAndShowsWhatTheyMean) {
  Transcript transcript;
  const auto console = open(demo_link(), demo::make_dissector(), "emulated:", transcript.say());
  EXPECT_EQ(transcript.run(*console, "status"), "! nothing has come yet\n");
  EXPECT_THAT(transcript.run(*console, "send A5 718E"), HasSubstr("113 (query)"));
  EXPECT_THAT(transcript.run(*console, "wait 0.1"), HasSubstr("* reply  state 0 (ready)"));
  EXPECT_THAT(transcript.run(*console, "status"), HasSubstr("0 (ready)"));
  EXPECT_THAT(transcript.run(*console, "send A"), HasSubstr("? "));
  EXPECT_EQ(transcript.run(*console, "send"), "? usage: send HEX ...\n");
}

TEST(GenericConsole, TakesSingleTransactionsOnABus) {
  Transcript transcript;
  const auto console = open(bus_link(), morap::make_dissector(), "emulated:", transcript.say());
  EXPECT_EQ(transcript.run(*console, "send 22 83"), "sent\n");
  EXPECT_THAT(transcript.run(*console, "wait 0.1"), HasSubstr("command 131 (read_motor_status)"));
  EXPECT_EQ(transcript.run(*console, "send 23 01"), "sent\n");
  EXPECT_THAT(transcript.run(*console, "wait 0.1"), HasSubstr("needs_calibration"));
  EXPECT_THAT(transcript.run(*console, "send 24 83"), HasSubstr("! ")) << "nobody is there";
}

TEST(GenericWatched, ShowsWhatAnswersAHarmlessRequest) {
  const auto query = demo::encode(demo::Operation::kQuery);
  const auto watched = watch(demo_link(), demo::make_dissector(), {{query.begin(), query.end()}});
  Watch looking{*watched, {.period = 100ms, .count = 3}};
  int json_lines = 0;
  const auto heard = [&] { json_lines += static_cast<int>(watched->json_lines().size()); };
  EXPECT_THAT(watched->lines(), ElementsAre());
  while (!looking.is_over()) ASSERT_TRUE(looking.cycle(heard));
  ASSERT_TRUE(looking.end(heard));
  EXPECT_EQ(watched->answers(), 3);
  EXPECT_EQ(json_lines, 3);
  EXPECT_THAT(watched->lines(), ElementsAre(HasSubstr("state 0 (ready)")));
  EXPECT_EQ(watched->link(), "link       3 sent, 3 answered\n");
}

TEST(GenericWatched, AsksInTransactionsOnABus) {
  const std::vector<std::vector<std::byte>> requests{{std::byte{0x22}, std::byte{0x83}},  // choose
                                                     {std::byte{0x23}, std::byte{1}},     // read
                                                     {std::byte{0x25}, std::byte{1}}};    // nobody
  const auto watched = watch(bus_link(), morap::make_dissector(), requests);
  Watch looking{*watched, {.period = 100ms, .time = 3s}};
  int json_lines = 0;
  const auto heard = [&] { json_lines += static_cast<int>(watched->json_lines().size()); };
  while (!looking.is_over()) ASSERT_TRUE(looking.cycle(heard));
  ASSERT_TRUE(looking.end(heard));
  EXPECT_EQ(json_lines, 20);
  EXPECT_THAT(watched->lines(), ElementsAre(HasSubstr("needs_calibration")));
  EXPECT_EQ(watched->link(), "link       30 sent, 20 answered\n");
}

}  // namespace
}  // namespace armjig::generic
