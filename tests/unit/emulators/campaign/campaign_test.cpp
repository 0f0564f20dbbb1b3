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

/// Keeps what is played.
class KeepingStage final : public Stage {
 public:
  explicit KeepingStage(std::unique_ptr<Stage> stage) : stage_{std::move(stage)} {}
  Outcome<void> reset() override { return stage_->reset(); }
  [[nodiscard]] bool can_reset() const override { return true; }
  Outcome<void> renew_models() override { return stage_->renew_models(); }
  Outcome<BothHeard> play(const Script& script) override {
    played.push_back(script);
    return stage_->play(script);
  }

  std::vector<Script> played;

 private:
  std::unique_ptr<Stage> stage_;
};

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

/// Somewhere where nobody is.
class NobodyThere final : public Stage {
 public:
  Outcome<void> reset() override { return {}; }
  [[nodiscard]] bool can_reset() const override { return false; }
  Outcome<void> renew_models() override { return {}; }
  Outcome<BothHeard> play(const Script& script) override {
    BothHeard heard;
    auto& model = heard.models.emplace_back();
    for (const auto& record : script) {
      if (record.direction == Direction::kFromDevice) model.said.push_back(record);
    }
    return heard;
  }
};

/// In virtual time, but that the guard ends what is played now and then.
class RefusingStage final : public Stage {
 public:
  RefusingStage(std::unique_ptr<Stage> stage, bool can_reset)
      : stage_{std::move(stage)}, can_reset_{can_reset} {}
  Outcome<void> reset() override { return stage_->reset(); }
  [[nodiscard]] bool can_reset() const override { return can_reset_; }
  Outcome<void> renew_models() override { return stage_->renew_models(); }
  Outcome<BothHeard> play(const Script& script) override {
    constexpr int kOften = 3;
    if (++times_ % kOften == 1) return problem(ErrorCode::kForbidden, "it", "was refused");
    return stage_->play(script);
  }

 private:
  std::unique_ptr<Stage> stage_;
  bool can_reset_;
  int times_ = 0;
};

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

/// With a device of its own in the place of the target.
class StandInStage final : public Stage {
 public:
  StandInStage(std::unique_ptr<Stage> stage, std::unique_ptr<Stage> stand_in)
      : stage_{std::move(stage)}, stand_in_{std::move(stand_in)} {}
  Outcome<void> reset() override { return stage_->reset(); }
  [[nodiscard]] bool can_reset() const override { return stage_->can_reset(); }
  Outcome<void> renew_models() override { return stage_->renew_models(); }
  Outcome<BothHeard> play(const Script& script) override { return stage_->play(script); }
  Outcome<BothHeard> play_to_stand_in(const Script& script, std::uint64_t /*seed*/) override {
    return stand_in_->reset().and_then([&] { return stand_in_->play(script); });
  }

 private:
  std::unique_ptr<Stage> stage_;
  std::unique_ptr<Stage> stand_in_;
};

TEST(Campaign, FindsNothingInWhatASoundDeviceShowsInTheSamePlace) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  const auto faulty = emulated("?fault=quirk:counters-reset-by-clear");
  const auto material = cli::material_of(device, faulty, emulated(""), 20s).value();
  for (const bool is_of_link : {true, false}) {
    StandInStage stage{stage_of(device, faulty),
                       stage_of(device, is_of_link ? faulty : emulated(""))};
    CampaignState state;
    const CampaignOptions options{.most_cases = 40,
                                  .judging = {device.make_dissector, {}, 20ms},
                                  .doubts = 1,
                                  .most_shrinking = 1h,
                                  .stops_at_first = true};
    ASSERT_TRUE(run_campaign(stage, material, options, state, {}));
    EXPECT_EQ(state.findings.empty(), is_of_link);
    EXPECT_EQ(state.unsettled > 0, is_of_link);
  }
}

/// What shows something shows it every other time, if it has no more records than that.
class RacingStage final : public Stage {
 public:
  RacingStage(std::unique_ptr<Stage> stage, std::unique_ptr<Stage> sound, std::size_t most)
      : stage_{std::move(stage)}, sound_{std::move(sound)}, most_{most} {}
  Outcome<void> reset() override {
    return stage_->reset().and_then([this] { return sound_->reset(); });
  }
  [[nodiscard]] bool can_reset() const override { return true; }
  Outcome<void> renew_models() override { return stage_->renew_models(); }
  Outcome<BothHeard> play(const Script& script) override {
    const bool is_lucky = script.size() <= most_ && ++plays_ % 2 == 0;
    return (is_lucky ? sound_ : stage_)->play(script);
  }

 private:
  std::unique_ptr<Stage> stage_;
  std::unique_ptr<Stage> sound_;
  std::size_t most_;
  int plays_ = 0;
};

TEST(Campaign, MakesAFindingAsShortAsItIsSure) {
  constexpr std::size_t kMost = 6;
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  const auto faulty = emulated("?fault=quirk:counters-reset-by-clear");
  const auto material = cli::material_of(device, faulty, emulated(""), 20s).value();
  RacingStage stage{stage_of(device, faulty), stage_of(device, emulated("")), kMost};
  CampaignState state;
  const CampaignOptions options{.most_cases = 40,
                                .judging = {device.make_dissector, {}, 20ms},
                                .confirmations = 3,
                                .most_shrinking = 1h,
                                .stops_at_first = true};
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
  const auto faulty = emulated("?fault=quirk:counters-reset-by-clear");
  for (const bool is_nothing_permitted : {true, false}) {
    auto material = cli::material_of(device, faulty, emulated(""), 20s).value();
    if (is_nothing_permitted) material.permit_case = [](Script& script) { script.clear(); };
    const auto stage = stage_of(device, faulty);
    CampaignState state;
    const CampaignOptions options{.most_cases = 40,
                                  .judging = {device.make_dissector, {}, 20ms},
                                  .most_shrinking = 1h,
                                  .stops_at_first = true};
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

/// A sound device that becomes another one for good, and that nobody can start again.
class ChangingStage final : public Stage {
 public:
  ChangingStage(std::unique_ptr<Stage> before, std::unique_ptr<Stage> after)
      : before_{std::move(before)}, after_{std::move(after)} {}
  Outcome<void> reset() override {
    if (std::exchange(was_begun_, true)) return {};
    return before_->reset().and_then([this] { return after_->reset(); });
  }
  [[nodiscard]] bool can_reset() const override { return false; }
  Outcome<void> renew_models() override { return {}; }
  Outcome<BothHeard> play(const Script& script) override {
    constexpr int kSound = 4;
    return (++times_ > kSound ? after_ : before_)->play(script);
  }

 private:
  std::unique_ptr<Stage> before_;
  std::unique_ptr<Stage> after_;
  bool was_begun_ = false;
  int times_ = 0;
};

/// Of a sound device that nobody can start again it loses an answer, once. Notes how long the
/// scripts are.
class OnceSilentStage final : public Stage {
 public:
  explicit OnceSilentStage(std::unique_ptr<Stage> stage) : stage_{std::move(stage)} {}
  Outcome<void> reset() override { return was_begun_++ > 0 ? Outcome<void>{} : stage_->reset(); }
  [[nodiscard]] bool can_reset() const override { return false; }
  Outcome<void> renew_models() override { return {}; }
  Outcome<BothHeard> play(const Script& script) override {
    auto heard = stage_->play(script);
    lengths.push_back(length_of(script));
    if (heard && lengths.size() == kSilent) heard->target.said.clear();
    return heard;
  }

  static constexpr std::size_t kSilent = 40;
  std::vector<Duration> lengths;

 private:
  std::unique_ptr<Stage> stage_;
  int was_begun_ = 0;
};

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

/// A device that nobody can start again.
class OnceBegunStage final : public Stage {
 public:
  explicit OnceBegunStage(std::unique_ptr<Stage> stage) : stage_{std::move(stage)} {}
  Outcome<void> reset() override {
    return std::exchange(was_begun_, true) ? Outcome<void>{} : stage_->reset();
  }
  [[nodiscard]] bool can_reset() const override { return false; }
  Outcome<void> renew_models() override { return {}; }
  Outcome<BothHeard> play(const Script& script) override { return stage_->play(script); }

 private:
  std::unique_ptr<Stage> stage_;
  bool was_begun_ = false;
};

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

/// Notes of each script how long it is, and whether the device is as new.
class NotingStage final : public Stage {
 public:
  explicit NotingStage(std::unique_ptr<Stage> stage) : stage_{std::move(stage)} {}
  Outcome<void> reset() override {
    is_new_ = true;
    return stage_->reset();
  }
  [[nodiscard]] bool can_reset() const override { return true; }
  Outcome<void> renew_models() override { return stage_->renew_models(); }
  Outcome<BothHeard> play(const Script& script) override {
    played.emplace_back(length_of(script), std::exchange(is_new_, false));
    return stage_->play(script);
  }

  std::vector<std::pair<Duration, bool>> played;

 private:
  std::unique_ptr<Stage> stage_;
  bool is_new_ = false;
};

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

/// Its target never answers.
class SilentStage final : public Stage {
 public:
  explicit SilentStage(std::unique_ptr<Stage> stage) : stage_{std::move(stage)} {}
  Outcome<void> reset() override { return stage_->reset(); }
  [[nodiscard]] bool can_reset() const override { return stage_->can_reset(); }
  Outcome<void> renew_models() override { return stage_->renew_models(); }
  Outcome<BothHeard> play(const Script& script) override {
    auto heard = stage_->play(script);
    if (heard) heard->target.said.clear();
    return heard;
  }

 private:
  std::unique_ptr<Stage> stage_;
};

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
