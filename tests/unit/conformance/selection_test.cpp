// SPDX-License-Identifier: Apache-2.0
#include "conformance/selection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/kinovazed/suite.hpp"
#include "conformance/morap/suite.hpp"
#include "conformance/parol6/suite.hpp"

namespace armjig {
namespace {

void looks(Bench&) {}

constexpr Requirement kMixedRequirements[] = {
    {"s.moves", Level::kMust, "It moves.", "here"},
    {"s.pass", Level::kMust, "It passes.", "here"},
    {"s.too", Level::kMust, "It passes too.", "here"},
    {"s.quiet", Level::kMust, "It answers.", "here"},
    {"s.beyond", Level::kMust, "It can be reached.", "here"},
    {"s.documented", Level::kMust, "It is documented.", "here", Profiles::kDocumented},
};
/// Of three start states, and with one that takes long and one of the other profile.
constexpr Case kMixedCases[] = {
    {.requirement = "s.moves", .rule = "r", .run = looks, .hazard = Hazard::kMove, .start = 1},
    {.requirement = "s.pass", .rule = "r", .run = looks},
    {.requirement = "s.too", .rule = "r", .run = looks, .start = 1},
    {.requirement = "s.quiet", .rule = "r", .run = looks, .tier = Tier::kFull},
    {.requirement = "s.beyond", .variant = "a", .rule = "r", .run = looks, .start = 2},
    {.requirement = "s.beyond", .variant = "b", .rule = "r", .run = looks, .start = 2},
    {.requirement = "s.documented", .rule = "r", .run = looks},
};
constexpr StartState kMixedStarts[] = {
    {"zero", Hazard::kObserve}, {"one", Hazard::kObserve}, {"two", Hazard::kObserve}};
const Chapter kMixedChapters[] = {{"Mixed",
                                   {std::begin(kMixedRequirements), std::end(kMixedRequirements)},
                                   {std::begin(kMixedCases), std::end(kMixedCases)}}};
const Suite kMixed{"s", "7", kMixedChapters, kMixedStarts};

std::set<std::string> names(const std::vector<const Case*>& cases) {
  std::set<std::string> names;
  for (const auto* one : cases) names.insert(name_of(*one));
  return names;
}

TEST(ConformanceSelection, ShardsHaveEveryCaseOnce) {
  const auto all = select(kMixed, Profile::kFirmware, {});
  for (const std::size_t count : {1U, 2U, 3U, 5U, 40U}) {
    std::size_t total = 0;
    std::set<std::string> seen;
    for (std::size_t index = 1; index <= count; ++index) {
      const auto part = select(kMixed, Profile::kFirmware, {.shard = {index, count}});
      total += part.size();
      seen.merge(names(part));
    }
    EXPECT_EQ(total, all.size()) << count;
    EXPECT_EQ(seen, names(all)) << count;
  }
}

TEST(ConformanceSelection, LeavesOutWhatTakesLongInTheQuickTier) {
  const auto quick = names(select(kMixed, Profile::kFirmware, {.tier = Tier::kQuick}));
  EXPECT_FALSE(quick.contains("s.quiet"));
  EXPECT_TRUE(quick.contains("s.pass"));
}

TEST(ConformanceSelection, TakesWhatSafetyRestsOnFirstAndInEveryTier) {
  constexpr std::array<std::string_view, 2> kVital{"s.beyond.b", ".quiet"};
  const Suite suite{"s", "7", kMixedChapters, kMixedStarts, {}, {}, kVital};
  const auto place = [](const auto& cases, std::string_view name) {
    return std::ranges::find(cases, name, [](const Case* one) { return name_of(*one); }) -
           cases.begin();
  };
  for (const auto tier : {Tier::kQuick, Tier::kFull}) {
    const auto cases = select(suite, Profile::kFirmware, {.tier = tier});
    EXPECT_EQ(place(cases, "s.quiet"), 0);
    EXPECT_LT(place(cases, "s.beyond.b"), place(cases, "s.beyond.a"));
    EXPECT_LT(place(cases, "s.too"), place(cases, "s.beyond.b"));
  }
}

/// A piece of a name that no case has any longer would be no way to stop.
TEST(ConformanceSelection, EveryVitalPieceNamesACase) {
  for (const auto& suite : {parol6::conformance::suite(), morap::conformance::suite(),
                            kinovazed::conformance::suite()}) {
    const auto quick = names(select(suite, Profile::kFirmware, {.tier = Tier::kQuick}));
    for (const auto piece : suite.vital) {
      EXPECT_TRUE(std::ranges::any_of(
          quick, [&](const std::string& name) { return name.find(piece) != name.npos; }))
          << suite.device << " " << piece;
    }
  }
}

TEST(ConformanceSelection, ReadsShards) {
  EXPECT_EQ(parse_shard("2/4")->index, 2U);
  EXPECT_EQ(parse_shard("2/4")->count, 4U);
  for (const auto* text : {"", "2", "/", "0/4", "5/4", "1/0", "1/4x", "a/b", "-1/4", "1/4/2"}) {
    EXPECT_FALSE(parse_shard(text)) << text;
  }
}

}  // namespace
}  // namespace armjig
