// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/questions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "cli/device.hpp"
#include "cli/devices/devices.hpp"
#include "cli/fuzz_material.hpp"
#include "harness/mealy/deviation.hpp"

namespace armjig::campaign {
namespace {

struct Lesson {
  mealy::Learned learned;
  mealy::Comparison comparison;
};

const Learnable& machine_of(const cli::Device& device, std::string_view name) {
  return *std::ranges::find(device.fuzz.machines, name, &Learnable::name);
}

Lesson learn(std::string_view name, std::string_view machine_name, const std::string& fault = {},
             std::uint64_t seed = 1) {
  const auto& device = **cli::find_device(cli::shipped_devices(), name);
  const auto& machine = machine_of(device, machine_name);
  RigOptions how;
  how.target = parse_target(fault.empty() ? "emulated:" : "emulated:?fault=" + fault).value();
  const auto stage = cli::stage_alone(device, how, Hand{}, 1);
  Questions questions{*stage, machine, device.make_dissector, {}};
  const auto letters = letters_of(machine);
  Lesson lesson{mealy::learn(questions, letters, {.seed = seed}).value(), {}};
  const auto documented = mealy::documented(machine.documented, letters, "test").value();
  lesson.comparison = mealy::compare(lesson.learned.machine, documented);
  return lesson;
}

std::vector<std::string> names_of(const Lesson& lesson) {
  std::vector<std::string> names;
  for (const auto& one : lesson.comparison.deviations) names.push_back(one.name);
  return names;
}

void expect_documented(std::string_view device, std::string_view machine, std::size_t states) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const auto lesson = learn(device, machine, {}, seed);
    EXPECT_TRUE(lesson.learned.is_settled) << machine;
    EXPECT_EQ(lesson.learned.machine.states.size(), states) << machine;
    EXPECT_EQ(names_of(lesson), std::vector<std::string>{}) << machine;
  }
}

TEST(Questions, ShippedServerIsTheDocumentedMachine) {
  expect_documented("kinovazed", "server", 11);
}
TEST(Questions, ShippedBoardIsTheDocumentedMachine) {
  expect_documented("parol6", "arm", 12);
  expect_documented("parol6", "gripper", 7);
}
TEST(Questions, ShippedNodeIsTheDocumentedMachine) { expect_documented("morap", "node", 12); }

TEST(Questions, NameAWrongStepOfAServer) {
  EXPECT_EQ(names_of(learn("kinovazed", "server", "row:frozen.Unfreeze.rejected")),
            std::vector<std::string>{"frozen.Unfreeze"});
  EXPECT_EQ(names_of(learn("kinovazed", "server", "end:retracting.ignored")),
            (std::vector<std::string>{"retracting.quiet", "not-met"}));
}

TEST(Questions, NameAWrongStepOfABoard) {
  const auto names = names_of(learn("parol6", "arm", "quirk:homed-lost-by-disable"));
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.front(), "homed + released.disable");
}

TEST(Questions, NameAWrongStepOfANode) {
  const auto names = names_of(learn("morap", "node", "row:enabled.calibrate_zero.disable"));
  EXPECT_EQ(names.size(), 3U);  // whatever the programming status is
  EXPECT_TRUE(std::ranges::all_of(names, [](const std::string& name) {
    return name.starts_with("enabled + ") && name.ends_with(".calibrate zero");
  }));
}

TEST(Questions, EveryEntryHasRowsForAllOfItsStates) {
  for (const auto& device : cli::shipped_devices()) {
    for (const auto& machine : device.fuzz.machines) {
      EXPECT_LE(machine.letters.size(), 15U) << device.name << " " << machine.name;
      EXPECT_TRUE(mealy::documented(machine.documented, letters_of(machine), "test"))
          << device.name << " " << machine.name;
    }
  }
}

/// Whom nobody can start again, and who plays nothing.
class FixedStage final : public Stage {
 public:
  Outcome<void> reset() override { return {}; }
  [[nodiscard]] bool can_reset() const override { return false; }
  Outcome<void> renew_models() override { return {}; }
  Outcome<BothHeard> play(const Script& script) override {
    played = script;
    ++times;
    if (times <= times_refused) return problem(ErrorCode::kForbidden, "it", "was refused");
    BothHeard heard;
    heard.target.said = said;
    if (times <= times_late) heard.lateness = std::chrono::seconds{1};
    return heard;
  }
  Script played;
  std::vector<KeptRecord> said;
  int times = 0;
  int times_late = 0;
  int times_refused = 0;
};

KeptRecord line_at(Duration time, std::string_view text) {
  const auto bytes = std::as_bytes(std::span{text});
  return {.time = Instant{time},
          .kind = LinkKind::kSession,
          .direction = Direction::kFromDevice,
          .id = 1,
          .bytes = {bytes.begin(), bytes.end()}};
}

/// Letters of 60 ms, whose first begins after EStop, what the hand does, and holding the arm.
TEST(Questions, GiveALateReplyToTheLetterItIsFor) {
  using namespace std::chrono_literals;
  const auto& device = **cli::find_device(cli::shipped_devices(), "kinovazed");
  FixedStage stage;
  Questions questions{stage, machine_of(device, "server"), device.make_dissector, {}};
  (void)questions.ask({1, 5});
  std::vector<Instant> sent;
  for (const auto& record : stage.played) {
    if (is_sent(record)) sent.push_back(record.time);
  }
  const auto first = sent.at(1).time_since_epoch();
  stage.said = {line_at(first + 65ms, "Accepted\r\n"), line_at(first + 66ms, "Freezed\r\n"),
                line_at(first + 100ms, "Rejected\r\n")};
  EXPECT_EQ(questions.ask({1, 5}).value(), (mealy::Said{"Accepted, Freezed", "Rejected"}));
  stage.said.back().time += 200ms;  // later than the word
  EXPECT_EQ(questions.ask({1, 5}).value(), (mealy::Said{"Accepted, Freezed", "Rejected"}));
  stage.said.pop_back();  // now it is not known which of them is without a reply
  EXPECT_EQ(questions.ask({1, 5}).value(), (mealy::Said{"", "Accepted, Freezed"}));
}

TEST(Questions, AskAgainWhatWasAskedLate) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "kinovazed");
  FixedStage stage;
  stage.times_late = 2;
  Questions questions{stage, machine_of(device, "server"), device.make_dissector, {}};
  constexpr mealy::Letter kQuiet = 11;  // nothing is sent, so no reply is missing
  EXPECT_EQ(questions.ask({kQuiet}).value(), mealy::Said{""});
  EXPECT_EQ(stage.times, 3);
  stage.times_late = 1'000;  // somebody who is always late is heard all the same
  EXPECT_EQ(questions.ask({kQuiet}).value(), mealy::Said{""});
}

TEST(Questions, AskAgainWhereAReplyIsMissing) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "kinovazed");
  FixedStage stage;
  Questions questions{stage, machine_of(device, "server"), device.make_dissector, {}};
  EXPECT_EQ(questions.ask({1}).value(), mealy::Said{""});  // one that never comes is missing
  EXPECT_GT(stage.times, 1);
  stage.times = 0;
  for (const auto& record : stage.played) {
    if (is_sent(record)) stage.said = {line_at(record.time.time_since_epoch(), "Accepted\r\n")};
  }
  EXPECT_EQ(questions.ask({1}).value(), mealy::Said{"Accepted"});
  EXPECT_EQ(stage.times, 1);
}

TEST(Questions, AskAgainWhatTheGuardEnded) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "kinovazed");
  FixedStage stage;
  stage.times_refused = 2;
  Questions questions{stage, machine_of(device, "server"), device.make_dissector, {}};
  EXPECT_EQ(questions.ask({1}).value(), mealy::Said{""});
  stage.times_refused = 1'000;
  EXPECT_EQ(questions.ask({1}).error().code, ErrorCode::kForbidden);
}

TEST(Questions, BeginWithWhatLeadsBackIfNobodyCanStartTheDeviceAgain) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "kinovazed");
  FixedStage stage;
  Questions questions{stage, machine_of(device, "server"), device.make_dissector, {}};
  EXPECT_EQ(questions.ask({1}).value(), mealy::Said{""});
  EXPECT_EQ(words_of(stage.played.front(), device.make_dissector), "EStop");
}

TEST(Questions, SayWhatIsNeededToBeginAgain) {
  const auto& device = **cli::find_device(cli::shipped_devices(), "parol6");
  FixedStage stage;
  Questions questions{stage, machine_of(device, "gripper"), device.make_dissector, {}};
  const auto said = questions.ask({1});
  ASSERT_FALSE(said);
  EXPECT_NE(said.error().hint.find("--restart"), std::string::npos);
}

}  // namespace
}  // namespace armjig::campaign
