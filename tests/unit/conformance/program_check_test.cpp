// SPDX-License-Identifier: Apache-2.0
#include "conformance/program_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "conformance/morap/host/check.hpp"
#include "conformance/parol6/host/check.hpp"
#include "emulators/morap/options.hpp"
#include "emulators/parol6/arm.hpp"
#include "harness/capture/trace.hpp"
#include "harness/link/emulated_bus_port.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

ProgramCheckEntry parol6_entry() { return parol6::programs::program_check(); }

std::unique_ptr<HostedStream> watched_arm(ProgramCheck& check) {
  return check.watch(make_hosted(parol6::emulation::Arm{}));
}

parol6::CommandFrame idle_with_gripper(std::uint8_t id) {
  parol6::CommandFrame frame;
  frame.command = parol6::Command::kIdle;
  frame.gripper.id = id;
  return frame;
}

TEST(ProgramCheck, TellsOfEachOffenceAndSumsThemUp) {
  std::vector<std::string> told;
  ProgramCheck check{parol6_entry(), {}, [&told](const Offence& offence) {
                       told.emplace_back(offence.requirement);
                     }};
  const auto device = watched_arm(check);
  for (int i = 0; i < 4; ++i) {
    device->receive(at(i * 10ms), encode(idle_with_gripper(i == 0 ? 0 : 20)));
    device->advance_to(at(i * 10ms + 5ms));
    EXPECT_EQ(device->sent().size(), 1U) << "the device itself works as ever";
    device->clear_sent();
  }
  EXPECT_THAT(told, testing::ElementsAre("parol6.host.gripper-id", "parol6.host.gripper-id",
                                         "parol6.host.gripper-id"));
  const auto report = check.finish();
  EXPECT_EQ(report.count(Verdict::kFail), 1U);
  EXPECT_EQ(report.rows.size(), parol6_entry().requirements().size());
  EXPECT_EQ(conclusion_of(report), Conclusion::kFindings);
  const auto row = std::ranges::find(report.rows, Verdict::kFail, &ReportRow::verdict);
  EXPECT_EQ(row->actual, "3 times, first at 0.010 s: gripper.id was 20");
}

TEST(ProgramCheck, SeesWhatAHandBesideTheDeviceDoes) {
  ProgramCheck check{parol6_entry(), {}, [](const Offence&) {}};
  const auto device = watched_arm(check);
  parol6::CommandFrame jog{.command = parol6::Command::kJog};
  jog.speed[0] = StepsPerSecond{100};
  for (auto now = 10ms; now < 2s; now += 10ms) {
    if (now == 1s) {
      EXPECT_EQ(check.count("parol6.host.estop-disables"), 0U);
      ASSERT_TRUE(device->set_input(at(now), "estop", 0));
    }
    device->receive(at(now), encode(jog));
    device->advance_to(at(now + 5ms));
    device->clear_sent();
  }
  EXPECT_GT(check.count("parol6.host.estop-disables"), 0U);
}

const ReportRow& row_of(const Report& report, std::string_view name) {
  return *std::ranges::find(report.rows, name, &ReportRow::name);
}

TEST(ProgramCheck, PassesNothingThatHadNoOccasion) {
  ProgramCheck check{parol6_entry(), {}, [](const Offence&) {}};
  const auto device = watched_arm(check);
  device->receive(at(0ms), encode(idle_with_gripper(0)));
  const auto report = check.finish();
  EXPECT_EQ(row_of(report, "parol6.host.frame-length").verdict, Verdict::kPass);
  const auto& go_to = row_of(report, "parol6.host.go-to-unhomed");
  EXPECT_EQ(go_to.verdict, Verdict::kSkipped);
  EXPECT_EQ(go_to.actual, "no occasion without a go-to");
  EXPECT_EQ(conclusion_of(report), Conclusion::kPassed);
}

TEST(ProgramCheck, SaysWhatItCouldNotJudgeBecauseItsHostWasLate) {
  ProgramCheck check{parol6_entry(), {}, [](const Offence&) {}};
  const auto device = watched_arm(check);
  parol6::CommandFrame jog{.command = parol6::Command::kJog};
  jog.speed[0] = StepsPerSecond{100};
  const auto send = [&](Duration time) {
    device->receive(at(time), encode(time < 100ms ? idle_with_gripper(0) : jog));
    device->advance_to(at(time + 5ms));
    device->clear_sent();
  };
  for (auto now = 0ms; now <= 390ms; now += 10ms) send(now);
  device->overlook(at(400ms), at(1s));
  device->advance_to(at(1s));
  for (auto now = 1000ms; now <= 3000ms; now += 10ms) send(now);
  const auto report = check.finish();
  EXPECT_EQ(report.count(Verdict::kFail), 0U);
  EXPECT_EQ(row_of(report, "parol6.host.gap-in-motion").verdict, Verdict::kInconclusive);
  EXPECT_THAT(report.facts, testing::Contains(std::pair<std::string, std::string>{
                                "overlooked", "0.600 s (20.0 %): armjig was late itself then"}));
}

TEST(ProgramCheck, HearsTheMessagesOfABusWhenTheyAreOver) {
  std::vector<std::string> told;
  ProgramCheck check{morap::programs::program_check(), {}, [&told](const Offence& offence) {
                       told.emplace_back(offence.requirement);
                     }};
  const BusAddress node{0x12};
  EmulatedBusPort<std::unique_ptr<HostedBus>> port{
      check.watch(make_hosted(*morap::emulation::make({}, "test")))};
  const std::array unknown{std::byte{6}};
  const std::array angle{std::byte{0x83}};
  std::array<std::byte, 5> answer{};
  ASSERT_EQ(port.transfer(std::array{write_to(node, unknown)}), Transfer::kDone);
  EXPECT_THAT(told, testing::ElementsAre("morap.host.known-ids"));
  ASSERT_EQ(port.transfer(std::array{write_to(node, angle), read_from(node, answer)}),
            Transfer::kDone);
  EXPECT_THAT(told, testing::ElementsAre("morap.host.known-ids", "morap.host.read-size"));
}

TEST(ProgramCheck, PassesNothingThatDidNotRun) {
  ProgramCheck check{parol6_entry(), {}, [](const Offence&) {}};
  const auto device = watched_arm(check);
  device->advance_to(at(10s));
  EXPECT_EQ(conclusion_of(check.finish()), Conclusion::kNothing);
}

/// What the recorded host broke.
std::vector<std::string> broken_in(const std::string& name) {
  const auto trace = read_trace(source_dir() + "/captures/parol6/" + name + ".jsonl");
  EXPECT_TRUE(trace.has_value()) << name;
  const auto checker = parol6_entry().make({});
  for (const auto& event : trace->events) {
    if (event.dir == "to_device") checker->to_device(event.time, event.bytes);
    if (event.dir == "from_device") checker->from_device(event.time, event.bytes);
  }
  checker->finish(trace->events.back().time);
  std::vector<std::string> ids;
  for (const auto& offence : checker->take_offences()) {
    if (std::ranges::find(ids, offence.requirement) == ids.end()) {
      ids.emplace_back(offence.requirement);
    }
  }
  return ids;
}

/// The host of the recordings is well-behaved in some, and in others wrong in ways that their
/// descriptions tell: it begins with a motion, samples slowly, or does what they are about.
struct Recorded {
  const char* name;
  std::vector<std::string> broken;
};
void PrintTo(const Recorded& recorded, std::ostream* out) { *out << recorded.name; }

class RecordedHost : public testing::TestWithParam<Recorded> {};

TEST_P(RecordedHost, IsBlamedForWhatItDid) {
  EXPECT_THAT(broken_in(GetParam().name), testing::UnorderedElementsAreArray(GetParam().broken));
}

INSTANTIATE_TEST_SUITE_P(
    Parol6, RecordedHost,
    testing::Values(
        Recorded{"powerup_dummy_100hz", {}}, Recorded{"powerup_link_up_late", {}},
        Recorded{"gripper_can_burst_a", {}},
        Recorded{"planner_quintic_speed_only_a", {"parol6.host.looks-first"}},
        Recorded{"planner_trap_speed_pos_a",
                 {"parol6.host.looks-first", "parol6.host.go-to-unhomed"}},
        Recorded{
            "planner_home_then_moves_a",
            {"parol6.host.looks-first", "parol6.host.rate-slow", "parol6.host.gripper-activated"}},
        Recorded{"jog_single_joints_a", {"parol6.host.looks-first"}},
        Recorded{"dummy_with_speeds_a", {"parol6.host.idle-speed"}},
        Recorded{"outputs_sweep_a", {"parol6.host.spare-outputs"}},
        Recorded{"gripper_ids_lengths_a", {"parol6.host.gripper-id"}},
        Recorded{"home_full_a", {"parol6.host.looks-first", "parol6.host.rate-slow"}},
        Recorded{"home_hold_command_a",
                 {"parol6.host.looks-first", "parol6.host.rate-slow", "parol6.host.home-held"}},
        Recorded{"home_while_disabled_a", {"parol6.host.move-disabled", "parol6.host.rate-slow"}},
        Recorded{"timing_gaps_a", {"parol6.host.jitter", "parol6.host.rate-slow"}}));

}  // namespace
}  // namespace armjig
