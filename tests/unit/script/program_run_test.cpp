// SPDX-License-Identifier: Apache-2.0
#include "harness/script/program_run.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "emulators/parol6/arm.hpp"
#include "harness/arm/arm.hpp"
#include "harness/arm/models.hpp"
#include "harness/drive/parol6/drive_loop.hpp"
#include "harness/link/impaired_stream.hpp"
#include "harness/link/memory_stream.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/rig/guarded_ports.hpp"
#include "harness/rig/parol6_judge.hpp"
#include "harness/script/check.hpp"
#include "harness/script/run_output.hpp"
#include "harness/script/schedule.hpp"
#include "tests/unit/report/validity.hpp"
#include "tests/unit/script/programs.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig::script {
namespace {

using namespace std::chrono_literals;
using parol6::JointSteps;
using parol6::drive::Activity;
using ::testing::HasSubstr;

/// A drive and an emulated arm on virtual time.
class Jig {
 public:
  std::optional<Activity::Ending> go_through(Activity& activity) {
    const auto end = port.now() + 10min;
    while (port.now() < end) {
      if (!loop.cycle()) return std::nullopt;
      if (drive.telemetry()) seen.push_back(drive.telemetry()->position);
      if (auto ending = activity.step(drive, port.now(), drive.take_events())) return ending;
    }
    return std::nullopt;
  }

  void home() {
    const auto homing = parol6::drive::begin_home(drive);
    ASSERT_TRUE(homing.has_value());
    const auto ending = go_through(**homing);
    ASSERT_TRUE(ending && ending->is_success);
    seen.clear();
  }

  MemoryStream<parol6::emulation::Arm> port{parol6::emulation::Arm{}};
  parol6::drive::Drive drive;
  parol6::drive::DriveLoop loop{port, drive};
  std::vector<JointSteps> seen;  ///< telemetry of each cycle
};

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream in{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

std::vector<std::string> examples() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator{source_dir() + "/harness/script/examples"}) {
    names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

class Example : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const auto path = fs::path{source_dir() + "/harness/script/examples"} / (GetParam() + ".rbt");
    auto parsed = parse(read(path), Dialect::kDocumented);
    ASSERT_TRUE(parsed.has_value()) << describe(parsed.error().front(), path.string());
    program_ = *std::move(parsed);
  }

  Program program_;
};

TEST_P(Example, BringsTheEmulatedArmToWhereThePlanEnds) {
  const auto plan = test::schedule_of(program_);
  ASSERT_FALSE(plan.stop.has_value()) << plan.stop->text;
  Jig jig;
  jig.home();
  ASSERT_EQ(jig.drive.telemetry()->position, test::kStandby);
  ProgramRun run{program_, {}};
  const auto ending = jig.go_through(run);
  ASSERT_TRUE(ending.has_value());
  ASSERT_TRUE(ending->is_success) << ending->text;
  ASSERT_EQ(run.moves().size(), plan.moves.size());
  for (const auto& move : run.moves()) {
    if (move.tracking == parol6::planning::Tracking::kSpeed) continue;
    for (const auto error : move.final_error) {
      EXPECT_LE(std::abs(error), 1) << "line " << program_.statements[move.statement].place.line;
    }
  }
  if (run.moves().empty() || run.moves().back().tracking == parol6::planning::Tracking::kSpeed)
    return;
  for (std::size_t j = 0; j < parol6::kJointCount; ++j) {
    EXPECT_NEAR(jig.drive.telemetry()->position[j].value, plan.positions.back()[j].value, 1) << j;
  }
}

INSTANTIATE_TEST_SUITE_P(Programs, Example, ::testing::ValuesIn(examples()),
                         [](const auto& example) { return example.param; });

/// How far a way of the tool is from the straight one between its ends.
struct Crookedness {
  double millimetres{};
  double degrees{};
};

Crookedness crookedness_of(const std::vector<JointSteps>& way) {
  const auto arm = arm::parol6_commander();
  const auto pose_of = [&](const JointSteps& steps) {
    return arm::forward(arm, parol6::planning::radians_of(steps));
  };
  const auto first = pose_of(way.front());
  const auto last = pose_of(way.back());
  const auto along = last.position - first.position;
  const auto turn = arm::rotation_vector(last.rotation * inverse(first.rotation));
  Crookedness most;
  for (const auto& steps : way) {
    const auto pose = pose_of(steps);
    const auto gone = pose.position - first.position;
    const auto turned = arm::rotation_vector(pose.rotation * inverse(first.rotation));
    // Of what moves only by roundings, no share can be told.
    const bool is_turn = norm(along) < 1e-3;
    const double share =
        is_turn ? dot(turned, turn) / dot(turn, turn) : dot(gone, along) / dot(along, along);
    most.millimetres = std::max(most.millimetres, 1000 * norm(gone - share * along));
    const double angle = share * norm(turn);
    const auto straight =
        norm(turn) == 0 ? first.rotation
                        : arm::rotation_about((1 / norm(turn)) * turn, angle) * first.rotation;
    most.degrees = std::max(
        most.degrees, parol6::planning::to_degrees(arm::angle_between(pose.rotation, straight)));
  }
  return most;
}

/// One line from a posture at rest.
class StraightLine : public ::testing::TestWithParam<std::string_view> {};

TEST_P(StraightLine, IsStraightByTheTelemetry) {
  const auto start = test::program_of("MoveJoint(90, -85, 170, 0, 30, 180, t=3)\nDelay(0.2)",
                                      Dialect::kDocumented);
  const auto line = test::program_of(GetParam(), Dialect::kDocumented);
  Jig jig;
  jig.home();
  ProgramRun to_start{start, {}};
  ASSERT_TRUE(jig.go_through(to_start)->is_success);
  jig.seen.clear();
  ProgramRun run{line, {}};
  const auto ending = jig.go_through(run);
  ASSERT_TRUE(ending && ending->is_success) << ending->text;
  const auto [millimetres, degrees] = crookedness_of(jig.seen);
  EXPECT_LT(millimetres, 0.1);
  EXPECT_LT(degrees, 0.1);
  EXPECT_NE(jig.seen.front(), jig.seen.back());
}

INSTANTIATE_TEST_SUITE_P(Lines, StraightLine,
                         ::testing::Values("MoveCart(-30, 280, 230, -90, 0, -75, t=3)",
                                           "MoveCart(40, 270, 240, -80, 5, -70, t=4, trap)",
                                           "MoveCartRelTRF(-60, 20, 10, 0, 0, 0, t=3, poly)",
                                           "MoveCartRelTRF(0, 0, 0, 20, 0, 0, t=2)",
                                           "MoveCartRelTRF(-20, 0, 0, 10, -10, 5)"));

/// A port on a busy machine: one write in 37 comes that much later than it was asked for.
class Stalling final : public StreamPort {
 public:
  Stalling(StreamPort& port, Duration time) : port_{port}, time_{time} {}

  Result<void> write(Bytes bytes) override {
    constexpr int kOneIn = 37;
    const auto end = now() + (++count_ % kOneIn == 0 ? time_ : Duration{});
    while (now() < end) {
      std::array<std::byte, 4096> buffer;
      const auto size = port_.read(buffer, end);
      if (!size) return tl::unexpected{size.error()};
      unread_.insert(unread_.end(), buffer.begin(),
                     buffer.begin() + static_cast<std::ptrdiff_t>(*size));
    }
    return port_.write(bytes);
  }

  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    if (unread_.empty()) return port_.read(into, deadline);
    const auto size = std::min(into.size(), unread_.size());
    std::copy_n(unread_.begin(), size, into.begin());
    unread_.erase(unread_.begin(), unread_.begin() + static_cast<std::ptrdiff_t>(size));
    return size;
  }

  [[nodiscard]] Instant now() const override { return port_.now(); }

 private:
  StreamPort& port_;
  Duration time_;
  int count_ = 0;
  std::vector<std::byte> unread_;
};

/// What ends a program on a guarded arm whose telemetry comes late, and some writes as well; empty
/// if nothing does.
std::string guarded_end(std::string_view lines, std::string_view impairment, Duration stall = {}) {
  using parol6::emulation::Arm;
  auto link = std::make_unique<ImpairedStream>(std::make_unique<MemoryStream<Arm>>(Arm{}),
                                               parse_impairment(impairment).value());
  auto guarded =
      GuardedStream::guard(std::move(link), parol6::rig::make_judge(), Permissions::all());
  auto& judged = **guarded;
  Stalling port{judged, stall};
  parol6::drive::Drive drive;
  parol6::drive::DriveLoop loop{port, drive};
  const auto go_through = [&](Activity& activity) -> std::string {
    for (const auto end = port.now() + 5min; port.now() < end;) {
      if (!loop.cycle()) return judged.last_refusal().value_or(Refusal{}).reason;
      if (!drive.telemetry()) continue;
      const auto ending = activity.step(drive, port.now(), drive.take_events());
      if (ending) return ending->is_success ? "" : ending->text;
    }
    return "it takes too long";
  };
  const auto homing = parol6::drive::begin_home(drive);
  if (auto end = go_through(**homing); !end.empty()) return end;
  const auto program = test::program_of(lines, Dialect::kDocumented);
  ProgramRun run{program, {}};
  return go_through(run);
}

constexpr auto* kAtTopSpeed =
    "MoveJoint(0, -90, 180, 0, 0, 180, t=4)\n"
    "MoveJoint(90, -90, 180, 60, 0, 180, v=100, a=100)\nMoveJoint(0, -90, 180, 0, 0, 20, t=5)";

TEST(ProgramRun, AtTopSpeedPassesTheGuardHoweverOldTelemetryIs) {
  for (const auto* late : {"in.delay=1ms", "in.delay=12ms", "in.delay=35ms", "in.delay=60ms",
                           "in.delay=uniform(0ms,25ms)"}) {
    EXPECT_EQ(guarded_end(kAtTopSpeed, late), "") << late;
  }
}

TEST(ProgramRun, AtTopSpeedPassesTheGuardWhereFramesAreSentLate) {
  for (const auto late : {4ms, 9ms, 12ms, 17ms, 25ms}) {
    EXPECT_EQ(guarded_end(kAtTopSpeed, "in.delay=1ms", late), "") << late.count();
  }
}

/// What the guard says to a program before anything of it is sent.
std::string guard_says(std::string_view lines, Dialect dialect, std::uint8_t homed = 0xFF) {
  const auto program = test::program_of(lines, dialect);
  const auto found = check_guarded(program, test::schedule_of(program), test::kStandby, homed);
  return found ? fmt::format("{}: {}", found->place.line, found->text) : "";
}

TEST(ProgramRun, IsRefusedBeforeItBeginsIfTheGuardWouldEndIt) {
  constexpr auto kDocumented = Dialect::kDocumented;
  EXPECT_EQ(guard_says("MoveJoint(0, -90, 180, 0, 0, 180, v=100, a=100)", kDocumented), "");
  EXPECT_THAT(guard_says("MoveJoint(0, -90, 180, 0, 0, 180, t=4)", kDocumented, 0),
              HasSubstr("2: the guard would not let it through: go-to needs a homed arm"));
  EXPECT_THAT(guard_says("Delay(1)\nMoveJoint(0, -90, 180, 0, 0, 180, t=4, speed)", kDocumented),
              HasSubstr("3: the guard would not let it through: j1 may jog at most"));
  EXPECT_THAT(guard_says("MoveJoint(0,-90,180,0,0,180,t=0.6)", Dialect::kCommander),
              HasSubstr("smaller pieces"));
}

TEST(ProgramRun, SaysHowFarItIs) {
  const auto program = test::program_of("Delay(0.1)\nDummy()", Dialect::kDocumented);
  Jig jig;
  ProgramRun run{program, {}};
  std::string news;
  for (int cycle = 0; cycle < 40; ++cycle) {
    ASSERT_TRUE(jig.loop.cycle().has_value());
    (void)run.step(jig.drive, jig.port.now(), jig.drive.take_events());
    news += run.take_news() + ';';
  }
  EXPECT_THAT(news, HasSubstr("line 2: Delay(0.1);"));
  EXPECT_THAT(news, HasSubstr("line 3: Dummy();"));
}

TEST(ProgramRun, EndsWithTheEmergencyStop) {
  const auto program = test::program_of("Delay(2)", Dialect::kDocumented);
  Jig jig;
  ASSERT_TRUE(jig.loop.cycle().has_value());
  jig.port.device().touch(jig.port.now() + 200ms, [](parol6::emulation::Plant& plant) {
    plant.inputs.estop = parol6::emulation::Level::kLow;
  });
  ProgramRun run{program, {}};
  const auto ending = jig.go_through(run);
  ASSERT_TRUE(ending.has_value());
  EXPECT_FALSE(ending->is_success);
  EXPECT_THAT(ending->text, HasSubstr("emergency stop"));
}

/// That the next frame asks for.
int gripper_position(Jig& jig) {
  const auto frame = jig.drive.tick(jig.port.now());
  return parol6::decode_command(parol6::body_of(frame)).gripper.position;
}

TEST(ProgramRun, LeavesTheGripperAloneUntilItIsNamed) {
  const auto program =
      test::program_of("Delay(0.05)\nGripper(200, 90, 400)\nDelay(0.2)", Dialect::kDocumented);
  Jig jig;
  ProgramRun run{program, {}};
  ASSERT_TRUE(jig.go_through(run)->is_success);
  EXPECT_EQ(gripper_position(jig), 200);
  for (const auto dialect : {Dialect::kDocumented, Dialect::kCommander}) {
    const auto quiet = test::program_of("Delay(0.05)", dialect);
    Jig other;
    ProgramRun quiet_run{quiet, {}};
    ASSERT_TRUE(other.go_through(quiet_run)->is_success);
    EXPECT_EQ(gripper_position(other), 0);
  }
}

TEST(ProgramRun, ResultsKeepToTheirSchemaAndPlotsToWhatMoved) {
  const auto program =
      test::program_of("MoveJoint(10, 0, 0, 0, 0, 0, t=1)\nMoveJoint(0, 0, 0, 0, 0, 0, t=1, speed)",
                       Dialect::kDocumented);
  Jig jig;
  ProgramRun run{program, {.planner = {.limits = parol6::planning::LimitCheck::kIgnored}}};
  run.keep_samples(1000);
  ASSERT_TRUE(jig.go_through(run)->is_success);
  const auto json = to_json(program, run,
                            {.file = "a.rbt",
                             .target = "emulated:",
                             .ran_to_end = true,
                             .position = jig.drive.telemetry()->position,
                             .link = jig.drive.statistics()});
  EXPECT_TRUE(armjig::test::is_valid_json(json, "docs/schemas/run.schema.json"));
  EXPECT_EQ(results_table(program, run).rows.size(), 2U);
  const auto plots = run_plots(run);
  ASSERT_EQ(plots.position.series.size(), 1U);
  EXPECT_EQ(plots.error.series.front().name, "j1");
  EXPECT_NEAR(plots.position.series.front().points[99].y, 10, 0.1);
}

TEST(ProgramRun, NamesWhatItNeedsLeaveFor) {
  EXPECT_THAT(hazards_of(test::program_of("Delay(1)", Dialect::kDocumented)), ::testing::IsEmpty());
  EXPECT_THAT(hazards_of(test::program_of(
                  "Output(1, LOW)\nGripper_cal()\nMoveJoint(0, -90, 180, 0, 0, 180)",
                  Dialect::kDocumented)),
              ::testing::UnorderedElementsAre(Hazard::kState, Hazard::kGrip, Hazard::kMove));
}

}  // namespace
}  // namespace armjig::script
