// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/kinovazed_matrix.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <string>

#include "tests/unit/support/source_dir.hpp"

namespace armjig::kinovazed::replay {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::string table_of(const std::string& cell) {
  return R"({"format": "state-command-matrix/1", "entries": [)" + cell + "]}";
}

constexpr auto kInitialize =
    R"({"state": "idle", "command": "Initialize", "order_may_swap": true, "next_state": "idle",
        "replies": ["Initialized", "Accepted"], "heartbeat_after": 21, "later": []})";

std::string changed(std::string text, std::string_view from, std::string_view to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(KinovaMatrix, OfTheRecordingsIsTheEmulatorsInEveryCell) {
  std::ifstream in{source_dir() + "/captures/kinovazed/state-command-matrix.json"};
  const auto verdict = verify_matrix(std::string{std::istreambuf_iterator<char>{in}, {}}, "table");
  ASSERT_TRUE(verdict);
  EXPECT_GT(verdict->cells, 80U);
  for (const auto& [cell, recorded, actual] : verdict->differences) {
    ADD_FAILURE() << cell << "\n  recorded " << recorded << "\n  emulated " << actual;
  }
}

TEST(KinovaMatrix, ShowsWhereACellDiffers) {
  EXPECT_THAT(verify_matrix(table_of(kInitialize), "table")->differences, IsEmpty());
  for (const auto& [from, to] :
       {std::pair{"\"Accepted\"", "\"Rejected\""},
        std::pair{"\"next_state\": \"idle\"", "\"next_state\": \"frozen\""},
        std::pair{": true", ": false"}, std::pair{"21", "5"},
        std::pair{": []", ": [\"Initialized\"]"}}) {
    const auto verdict = verify_matrix(table_of(changed(kInitialize, from, to)), "table");
    ASSERT_THAT(verdict->differences, SizeIs(1)) << to;
    EXPECT_EQ(verdict->differences.front().cell, "idle, Initialize");
  }
}

TEST(KinovaMatrix, IsRefusedIfItIsNone) {
  EXPECT_FALSE(verify_matrix("", "table"));
  EXPECT_FALSE(verify_matrix("[1]", "table"));
  EXPECT_FALSE(verify_matrix(R"({"format": "state-command-matrix/2", "entries": []})", "table"));
  for (const auto* cell :
       {"1", "{}", R"({"state": "idle"})", R"({"state": "up", "command": "EStop"})",
        R"({"state": "idle", "command": 1})"}) {
    const auto verdict = verify_matrix(table_of(cell), "table");
    ASSERT_FALSE(verdict) << cell;
    EXPECT_THAT(verdict.error().where, HasSubstr("table, entry 1"));
  }
}

}  // namespace
}  // namespace armjig::kinovazed::replay
