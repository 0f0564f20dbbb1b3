// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/campaign.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "cli/device.hpp"
#include "cli/devices/devices.hpp"
#include "cli/fuzz_material.hpp"
#include "emulators/campaign/folder.hpp"
#include "tests/unit/emulators/campaign/live_material.hpp"
#include "tests/unit/emulators/campaign/stages.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

struct Asked {
  std::string device;
  std::string fault;
  std::uint64_t cases = 60;
  std::uint64_t seed = 1;
  Known known{};
  bool stops_at_first = true;
};

RigOptions emulated(const std::string& options) {
  RigOptions rig;
  rig.target = parse_target("emulated:" + options).value();
  return rig;
}

/// Of a target beside a sound one, both emulated.
std::unique_ptr<Stage> stage_of(const cli::Device& device, const RigOptions& target) {
  return cli::stage_of(device, target, device, emulated(""), Hand{}, 20ms);
}

/// A campaign against an emulated device with that fault, in virtual time.
CampaignState run(const Asked& asked) {
  const auto& device = **cli::find_device(cli::shipped_devices(), asked.device);
  const auto target = emulated(asked.fault.empty() ? "" : "?fault=" + asked.fault);
  const auto model = emulated("");
  const auto material = cli::material_of(device, target, model, 20s).value();
  const auto stage = stage_of(device, target);
  CampaignState state;
  const CampaignOptions options{.seed = asked.seed,
                                .most_cases = asked.cases,
                                .judging = {device.make_dissector, {}, 20ms},
                                .known = asked.known,
                                .most_shrinking = 1h,
                                .stops_at_first = asked.stops_at_first};
  EXPECT_TRUE(run_campaign(*stage, material, options, state, {}));
  return state;
}

/// As far as the first finding, which is made as short as can be.
CampaignOptions until_first(const cli::Device& device) {
  return {.most_cases = 40,
          .judging = {device.make_dissector, {}, 20ms},
          .most_shrinking = 1h,
          .stops_at_first = true};
}

/// Shows soon, in counters.
constexpr auto kFaulty = "?fault=quirk:counters-reset-by-clear";

TEST(Campaign, FindsNothingInASoundDevice) {
  for (const auto& device : cli::shipped_devices()) {
    const auto state = run({std::string{device.name}, "", 30});
    EXPECT_TRUE(state.findings.empty()) << device.name << ": " << state.findings.front().sentence;
    EXPECT_EQ(state.cases, 30U) << device.name;
    EXPECT_EQ(state.unsettled, 0U) << device.name;
    EXPECT_GT(state.shown.answers(), 0U) << device.name;
  }
}

TEST(Campaign, FindsADefectOnAStreamAndMakesItShort) {
  const auto state = run({"parol6", "quirk:counters-reset-by-clear"});
  ASSERT_EQ(state.findings.size(), 1U);
  EXPECT_LE(state.findings.front().size, 3U);
  EXPECT_NE(state.findings.front().sentence.find("clear_error"), std::string::npos);
}

TEST(Campaign, FindsADefectOfAServer) {
  const auto state = run({"kinovazed", "missing:Rejected"});
  ASSERT_EQ(state.findings.size(), 1U);
  EXPECT_EQ(state.findings.front().symptom.answer, "Rejected");
}

TEST(Campaign, FindsADefectOnABus) {
  const auto state = run({"morap", "quirk:checksum-ignored", 300, 2});
  ASSERT_EQ(state.findings.size(), 1U);
  EXPECT_LE(state.findings.front().size, 5U);
}

TEST(Campaign, NeedsNoSessionsOfTheDevice) {
  const auto state = run({"demo", "missing", 2'000});
  ASSERT_EQ(state.findings.size(), 1U);
}

TEST(Campaign, PlaysTheSameCasesForTheSameSeed) {
  const auto one = run({"parol6", "quirk:steps-lost", 20, 7});
  const auto other = run({"parol6", "quirk:steps-lost", 20, 7});
  ASSERT_EQ(one.findings.size(), 1U);
  ASSERT_EQ(other.findings.size(), 1U);
  EXPECT_EQ(one.findings.front().script, other.findings.front().script);
  EXPECT_EQ(one.shown.answers(), other.shown.answers());
}

std::vector<Script> played_with(WhenSurvey when, std::uint64_t cases) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "morap");
  const auto material = cli::material_of(device, emulated(""), emulated(""), 1s).value();
  KeepingStage stage{stage_of(device, emulated(""))};
  CampaignState state;
  const CampaignOptions options{
      .most_cases = cases, .judging = {device.make_dissector, {}, 20ms}, .when_survey = when};
  EXPECT_TRUE(run_campaign(stage, material, options, state, {}));
  return stage.played;
}

TEST(Campaign, TakesCasesOfTheSurveyInTurnWithThoseOfChance) {
  const auto surveyed = played_with(WhenSurvey::kFirst, 3);
  const auto by_chance = played_with(WhenSurvey::kNever, 1);
  const auto in_turn = played_with(WhenSurvey::kInTurn, 6);
  ASSERT_EQ(in_turn.size(), 6U);
  EXPECT_EQ(in_turn[0], by_chance[0]);
  for (std::size_t i = 0; i < surveyed.size(); ++i) EXPECT_EQ(in_turn[2 * i + 1], surveyed[i]);
}

TEST(Campaign, TellsWhatIsKnown) {
  const auto known = Known::parse("[[known]]\nsymptom = \"*\"\nwhy = \"all of it\"\n", "test");
  const auto state = run({"parol6", "quirk:steps-lost", 5, 1, *known});
  ASSERT_FALSE(state.findings.empty());
  EXPECT_EQ(state.findings.front().known, "all of it");
}

/// One that shows in each joint, whatever is done.
TEST(Campaign, CountsADefectOnceInHoweverManyWaysItShows) {
  const auto state = run({"parol6", "quirk:steps-lost", 60, 1, {}, false});
  EXPECT_GT(state.findings.size(), 1U);
  EXPECT_EQ(state.causes, 1U);
}

TEST(Campaign, DoesNotMakeOneOfTwoDefects) {
  const auto state = run({"parol6", "quirk:steps-lost,zero:gripper.object", 40, 1, {}, false});
  EXPECT_EQ(state.causes, 2U);
}

/// A faulty node differs from a sound one in its fault alone, so that a campaign finds no other.
TEST(Campaign, FindsNothingInANodeWhoseFaultChangesNothing) {
  const auto state = run({"morap", "out:stuck:own_address.own_address", 40});
  EXPECT_TRUE(state.findings.empty()) << state.findings.front().sentence;
}

TEST(Campaign, GoesOnAfterTheGuardEndedACase) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  for (const bool can_reset : {true, false}) {
    const auto faulty = emulated("?fault=quirk:steps-lost");
    auto material = cli::material_of(device, faulty, emulated(""), 20s).value();
    RefusingStage stage{stage_of(device, faulty), can_reset};
    CampaignState state;
    const CampaignOptions options{.most_cases = 30, .judging = {device.make_dissector, {}, 20ms}};
    const auto done = run_campaign(stage, material, options, state, {});
    ASSERT_TRUE(done) << done.error().hint;
    EXPECT_EQ(state.cases, 30U);
    EXPECT_GT(state.refused, 2U);
    EXPECT_EQ(state.last_refusal, "was refused");
  }
}

TEST(Campaign, LeavesANodeTheTicksThatItNeedsForParameters) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "morap");
  auto material = cli::material_of(device, emulated(""), emulated(""), 6s).value();
  material.spacing.works_on = device.fuzz.works_on;
  Author author{material};
  std::size_t followed = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto script = author.draw(seed, {});
    for (std::size_t i = 1; i < script.size(); ++i) {
      const auto& before = script[i - 1];
      if (!is_sent(before) || device.fuzz.works_on(before.bytes) == Duration{}) continue;
      ++followed;
      EXPECT_GE(script[i].time - before.time, 20ms);
    }
  }
  EXPECT_GT(followed, 100U);
}

TEST(Campaign, LeavesAServerTheTimeToAnswerBeforeAClientLeaves) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "kinovazed");
  auto material = cli::material_of(device, emulated(""), emulated(""), 6s).value();
  material.spacing.around_ends = 100ms;
  const Author author{material};
  std::size_t ends = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto script = spaced(with_ends(author.draw(seed, {})), material.spacing);
    Instant said{};
    for (const auto& record : script) {
      if (is_sent(record)) said = record.time;
      if (!is_end(record)) continue;
      ++ends;
      EXPECT_GE(record.time - said, 100ms);
    }
  }
  EXPECT_GT(ends, 50U);
}

TEST(Campaign, KeepsTheTimeBeforeAnEndWhenItMakesAFindingShort) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "kinovazed");
  const auto faulty = emulated("?fault=missing:Accepted");
  auto material = cli::material_of(device, faulty, emulated(""), 20s).value();
  material.spacing.around_ends = 100ms;
  const auto stage = stage_of(device, faulty);
  CampaignState state;
  const CampaignOptions options{
      .most_cases = 10, .judging = {device.make_dissector, {}, 20ms}, .most_shrinking = 1h};
  ASSERT_TRUE(run_campaign(*stage, material, options, state, {}));
  ASSERT_FALSE(state.findings.empty());
  bool is_any_shorter = false;
  for (const auto& finding : state.findings) {
    is_any_shorter |= finding.size < finding.found_size;
    const auto own = finding.script.size() - material.harmless.size();
    for (std::size_t i = 1; i < own; ++i) {
      if (!is_end(finding.script[i])) continue;
      EXPECT_GE(finding.script[i].time - finding.script[i - 1].time, 100ms);
    }
  }
  EXPECT_TRUE(is_any_shorter);
}

TEST(Campaign, FindsNothingInWhatASoundDeviceShowsInTheSamePlace) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  const auto faulty = emulated(kFaulty);
  const auto material = cli::material_of(device, faulty, emulated(""), 20s).value();
  for (const bool is_of_link : {true, false}) {
    StandInStage stage{stage_of(device, faulty),
                       stage_of(device, is_of_link ? faulty : emulated(""))};
    CampaignState state;
    auto options = until_first(device);
    options.doubts = 1;
    ASSERT_TRUE(run_campaign(stage, material, options, state, {}));
    EXPECT_EQ(state.findings.empty(), is_of_link);
    EXPECT_EQ(state.unsettled > 0, is_of_link);
  }
}

TEST(Campaign, MakesAFindingAsShortAsItIsSure) {
  constexpr std::size_t kMost = 6;
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  const auto faulty = emulated(kFaulty);
  const auto material = cli::material_of(device, faulty, emulated(""), 20s).value();
  RacingStage stage{stage_of(device, faulty), stage_of(device, emulated("")), kMost};
  CampaignState state;
  auto options = until_first(device);
  options.confirmations = 3;
  ASSERT_TRUE(run_campaign(stage, material, options, state, {}));
  ASSERT_FALSE(state.findings.empty());
  const auto& finding = state.findings.front();
  EXPECT_GT(finding.script.size(), kMost);
  EXPECT_LE(finding.script.size(), 2 * kMost);
  EXPECT_GT(finding.found_size, 4 * kMost) << "it was long";
  EXPECT_FALSE(finding.shows.empty());
}

TEST(Campaign, PlaysOfACaseNoMoreThanIsPermitted) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  const auto faulty = emulated(kFaulty);
  for (const bool is_nothing_permitted : {true, false}) {
    auto material = cli::material_of(device, faulty, emulated(""), 20s).value();
    if (is_nothing_permitted) material.permit_case = [](Script& script) { script.clear(); };
    const auto stage = stage_of(device, faulty);
    CampaignState state;
    const auto options = until_first(device);
    ASSERT_TRUE(run_campaign(*stage, material, options, state, {}));
    EXPECT_EQ(state.findings.empty(), is_nothing_permitted);
  }
}

/// The scripts of an interrupted campaign, as it goes on with them.
std::vector<Script> kept_in_a_folder(const std::string& device,
                                     const std::vector<Script>& scripts) {
  const auto path = std::filesystem::path{testing::TempDir()} / ("kept-" + device);
  std::filesystem::remove_all(path);
  const auto folder = Folder::open(path.string(), {.recording = {device, "emulated:", "a test"}});
  std::uint64_t number = 0;
  for (const auto& script : scripts) {
    EXPECT_TRUE(folder->keep_worthy(script, number++));
  }
  EXPECT_TRUE(folder->keep(CampaignState{}));
  auto state = folder->load();
  EXPECT_TRUE(state) << state.error().hint;
  std::filesystem::remove_all(path);
  return state->worthy;
}

TEST(Campaign, GoesOnWithTheVeryScriptsThatItKept) {
  for (const auto* const name : {"parol6", "kinovazed", "morap"}) {
    const auto& device = **cli::find_device(cli::shipped_devices(), name);
    const auto material = cli::material_of(device, emulated(""), emulated(""), 6s).value();
    const Author author{material};
    std::vector<Script> scripts;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      auto script = author.draw(seed, scripts);
      if (!script.empty()) scripts.push_back(std::move(script));
    }
    EXPECT_TRUE(kept_in_a_folder(name, scripts) == scripts) << name;
  }
}

TEST(Campaign, PlaysAgainNoMoreThanTheLastCases) {
  constexpr std::size_t kCases = 4;
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  auto material = cli::material_of(device, emulated(""), emulated(""), 1s).value();
  OnceSilentStage stage{stage_of(device, emulated(""))};
  CampaignState state;
  const CampaignOptions options{.most_cases = 60,
                                .judging = {device.make_dissector, {}, 20ms},
                                .cases_between_resets = kCases,
                                .confirmations = 3};
  EXPECT_TRUE(run_campaign(stage, material, options, state, {}));
  EXPECT_EQ(state.unsettled, 1U);
  const auto last_cases = [&](std::size_t count) {
    const auto end = stage.lengths.begin() + OnceSilentStage::kSilent;
    return std::accumulate(end - static_cast<std::ptrdiff_t>(count), end, Duration{});
  };
  const auto with_history = stage.lengths.at(OnceSilentStage::kSilent + 1);
  EXPECT_GT(with_history, last_cases(2));
  EXPECT_LT(with_history, last_cases(10));
}

/// Of a board that nobody can start again, whose joints are elsewhere than anybody knows.
CampaignState run_elsewhere(const std::string& fault, bool knows_what_strays) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  const auto target = emulated("?to-switch=9000,5000,7000,4000,3000,8000" + fault);
  auto material = cli::material_of(device, target, emulated(""), 3s).value();
  if (!knows_what_strays) material.astray_fields = {};
  OnceBegunStage stage{stage_of(device, target)};
  CampaignState state;
  const CampaignOptions options{
      .most_cases = 60,
      .judging = {device.make_dissector, ComparisonRules::parse(device.live_rules, "live").value(),
                  20ms},
      .cases_between_resets = 4};
  const auto done = run_campaign(stage, material, options, state, {});
  EXPECT_TRUE(done) << done.error().hint;
  return state;
}

TEST(Campaign, DoesNotJudgeWhereATargetIsThatItLedAstray) {
  const auto is_accused = [](const CampaignState& state) {
    return !state.findings.empty() || !state.passed_over.empty();
  };
  EXPECT_FALSE(is_accused(run_elsewhere("", true)));
  EXPECT_TRUE(is_accused(run_elsewhere("", false)));
  EXPECT_TRUE(is_accused(run_elsewhere("&fault=stuck:echo", true)));
}

TEST(Campaign, PlaysWhatGoesThroughStatesToADeviceThatIsAsNew) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "kinovazed");
  const auto material = live_material("kinovazed", "tcp:127.0.0.1:1");
  const auto model = emulated("?profile=firmware");
  NotingStage stage{cli::stage_of(device, model, device, model, Hand{}, 220ms)};
  CampaignState state;
  const CampaignOptions options{.most_cases = 40,
                                .judging = {device.make_dissector, material.rules, 220ms},
                                .cases_between_resets = 1000,
                                .when_survey = WhenSurvey::kFirst};
  ASSERT_TRUE(run_campaign(stage, material, options, state, {}));
  EXPECT_GT(std::ranges::max(stage.played).first, 20s);
  for (std::size_t i = 1; i < stage.played.size(); ++i) {
    const auto [length, is_new] = stage.played[i];
    const bool is_near = length > 16s && length < 17s;
    EXPECT_TRUE(is_near || is_new == (length > 16s)) << i;
  }
}

CampaignState state_after_change(std::unique_ptr<Stage> (*make_changed)(const cli::Device&)) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  auto material = cli::material_of(device, emulated(""), emulated(""), 1s).value();
  ChangingStage stage{stage_of(device, emulated("")), make_changed(device)};
  CampaignState state;
  const CampaignOptions options{
      .most_cases = 10, .judging = {device.make_dissector, {}, 20ms}, .confirmations = 3};
  EXPECT_TRUE(run_campaign(stage, material, options, state, {}));
  return state;
}

TEST(Campaign, SaysNothingOfWhatStaysDifferentOnADeviceThatNobodyCanStartAgain) {
  const auto state = state_after_change([](const cli::Device& device) {
    return cli::stage_of(device, emulated("?fault=zero:gripper.object"), device, emulated(""),
                         Hand{}, 20ms);
  });
  EXPECT_TRUE(state.findings.empty());
  ASSERT_EQ(state.passed_over.size(), 1U);
  EXPECT_NE(state.passed_over.front().find("gripper.object 0"), std::string::npos);
  EXPECT_NE(state.passed_over.front().find(", since case "), std::string::npos);
}

TEST(Campaign, TellsOfADeviceThatIsSilentForGood) {
  const auto state = state_after_change([](const cli::Device& device) -> std::unique_ptr<Stage> {
    return std::make_unique<SilentStage>(stage_of(device, emulated("")));
  });
  EXPECT_FALSE(state.findings.empty());
  EXPECT_TRUE(state.passed_over.empty());
}

TEST(Campaign, DoesNotBeginWithATargetThatAnswersNothing) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "morap");
  auto material = cli::material_of(device, emulated(""), emulated(""), 20s).value();
  NobodyThere stage;
  CampaignState state;
  const CampaignOptions options{.most_cases = 3, .judging = {device.make_dissector, {}, 20ms}};
  const auto done = run_campaign(stage, material, options, state, {});
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kTimedOut);
  EXPECT_EQ(state.cases, 0U);
}

}  // namespace
}  // namespace armjig::campaign
