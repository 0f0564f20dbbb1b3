// SPDX-License-Identifier: Apache-2.0
#include "conformance/program_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "conformance/parol6/host/check.hpp"
#include "emulators/parol6/arm.hpp"
#include "harness/capture/trace.hpp"
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
