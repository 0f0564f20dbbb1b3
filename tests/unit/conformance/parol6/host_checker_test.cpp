// SPDX-License-Identifier: Apache-2.0
// For each requirement of a host a program that breaks just that one; and programs that are good.
#include "conformance/parol6/host/check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "emulators/parol6/arm.hpp"
#include "harness/drive/parol6/drive.hpp"
#include "harness/wire/parol6/readings.hpp"
#include "tests/unit/script/programs.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::parol6::programs {
namespace {

using drive::Drive;
using namespace emulation;
using namespace std::chrono_literals;
using test::as_vector;
using test::ByteVector;
using test::hex;
using test::joined;

/// A program with an arm, and the checker between them.
class Program {
 public:
  explicit Program(const ArmOptions& options = {}) : arm_{options} {}

  void write(Bytes bytes) {
    checker_->to_device(at(now_), bytes);
    arm_.receive(at(now_), bytes);
  }

  void wait(Duration duration) {
    now_ += duration;
    arm_.advance_to(at(now_ - Duration{1}));
    for (const auto& sent : arm_.sent()) {
      checker_->from_device(sent.time, sent.bytes);
      telemetry = decode_telemetry(body_of(Bytes{sent.bytes}.first<kTelemetryFrameSize>()));
      if (drive != nullptr) drive->receive(sent.time, sent.bytes);
    }
    arm_.clear_sent();
    checker_->wait_until(at(now_ - Duration{1}));
  }

  /// One period of the ordinary loop.
  void cycle(const CommandFrame& frame, Duration period = 10ms) {
    write(encode(frame));
    wait(period);
  }
  void hold(const CommandFrame& frame, Duration duration) {
    for (const auto end = now_ + duration; now_ < end;) cycle(frame);
  }
  /// As above, with our own driver.
  void run(Drive& with, Duration duration) {
    drive = &with;
    for (const auto end = now_ + duration; now_ < end;) {
      write(with.tick(at(now_)));
      wait(10ms);
    }
    drive = nullptr;
  }

  void press_estop(Level level) {
    arm_.touch(at(now_), [level](Plant& plant) { plant.inputs.estop = level; });
  }

  void overlook(Duration from) { checker_->overlook(at(from), at(now_)); }
  [[nodiscard]] Duration now() const noexcept { return now_; }
  [[nodiscard]] const ProgramChecker& checker() const noexcept { return *checker_; }

  /// Ids of what it broke until now.
  [[nodiscard]] std::set<std::string> broken_so_far() {
    std::set<std::string> ids;
    for (const auto& offence : checker_->take_offences()) {
      ids.emplace(offence.requirement);
      EXPECT_FALSE(offence.what.empty());
    }
    return ids;
  }

  /// Ids of what it broke; ends the session.
  std::set<std::string> broken() {
    checker_->finish(at(now_));
    return broken_so_far();
  }

  TelemetryFrame telemetry;
  Drive* drive = nullptr;

 private:
  Arm arm_;
  std::unique_ptr<ProgramChecker> checker_ = program_check().make({});
  Duration now_{};
};

CommandFrame with(Command code, std::array<std::int32_t, kJointCount> speeds = {}) {
  CommandFrame frame;
  frame.command = code;
  frame.check = kCheckHost;
  for (std::size_t j = 0; j < kJointCount; ++j) frame.speed[j] = StepsPerSecond{speeds[j]};
  return frame;
}

CommandFrame idle() { return with(Command::kIdle); }

CommandFrame go_to(std::array<Steps, kJointCount> goal, std::int32_t speed_j1 = 0) {
  auto frame = with(Command::kGoTo, {speed_j1});
  frame.position = goal;
  return frame;
}

void home(Program& program) {
  program.hold(idle(), 100ms);
  program.hold(with(Command::kHome), 100ms);
  program.hold(idle(), 32s);
  ASSERT_TRUE(is_homed(program.telemetry));
}

/// Drives J1 forward from standby, J1 at 10240, to where `position` says, in small pieces.
void walk_j1(Program& program, std::int32_t position) {
  auto goal = program.telemetry.position;
  while (goal[0].value != position) {
    goal[0] = Steps{goal[0].value + std::clamp(position - goal[0].value, -50, 50)};
    program.cycle(go_to(goal));
  }
  program.hold(go_to(goal), 150ms);
}

template <class Change>
CommandFrame idle_with(Change change) {
  auto frame = idle();
  change(frame);
  return frame;
}

/// One bad frame among good ones.
template <class Change>
auto bad_frame(Change change) {
  return [change](Program& program) {
    program.hold(idle(), 50ms);
    program.cycle(idle_with(change));
    program.hold(idle(), 50ms);
  };
}

auto bad_bytes(ByteVector bytes) {
  return [bytes](Program& program) {
    program.hold(idle(), 50ms);
    program.write(bytes);
    program.wait(10ms);
    program.hold(idle(), 100ms);
  };
}

ByteVector idle_bytes() { return as_vector(encode(idle())); }

/// A set-point for a gripper that goes somewhere.
GripperSetPoint grip(std::int16_t position, std::uint8_t mode = 0) {
  return {.position = position,
          .speed = 50,
          .current = Milliamperes{500},
          .command = 0xD0,
          .mode = mode,
          .id = 0};
}

ArmOptions calibrated_arm() {
  ArmOptions options;
  options.gripper->is_calibrated = true;
  return options;
}

struct WrongProgram {
  std::string_view requirement;
  std::function<void(Program&)> run;
  ArmOptions options{};
};
void PrintTo(const WrongProgram& wrong, std::ostream* out) { *out << wrong.requirement; }

std::vector<WrongProgram> wrong_programs() {
  return {
      {"parol6.host.frame-length",
       bad_bytes(joined(hex("FF FF FF 36"), test::zeros(52), hex("01 02")))},
      {"parol6.host.frame-end",
       [](Program& program) {
         auto bytes = idle_bytes();
         bytes.back() = std::byte{3};
         bad_bytes(bytes)(program);
       }},
      {"parol6.host.frame-whole", bad_bytes(as_vector(Bytes{idle_bytes()}.first(30)))},
      {"parol6.host.stray-start", bad_bytes(joined(hex("FF"), idle_bytes()))},
      {"parol6.host.stray-bytes", bad_bytes(joined(hex("0D 0A"), idle_bytes()))},
      {"parol6.host.frame-check", bad_frame([](CommandFrame& frame) { frame.check = 0x42; })},
      {"parol6.host.frame-prompt",
       [](Program& program) {
         const auto bytes = idle_bytes();
         program.hold(idle(), 50ms);
         program.write(Bytes{bytes}.first(20));
         program.wait(15ms);
         program.write(Bytes{bytes}.subspan(20));
         program.wait(10ms);
       }},
      {"parol6.host.known-codes",
       bad_frame([](CommandFrame& frame) { frame.command = Command{200}; })},
      {"parol6.host.no-demo", bad_frame([](CommandFrame& frame) { frame.command = Command{69}; })},
      {"parol6.host.spare-outputs", bad_frame([](CommandFrame& frame) { frame.in_out = 0x28; })},
      {"parol6.host.timeout", bad_frame([](CommandFrame& frame) { frame.timeout = 10; })},
      {"parol6.host.gripper-id", bad_frame([](CommandFrame& frame) { frame.gripper.id = 16; })},
      {"parol6.host.gripper-position",
       [](Program& program) {
         program.hold(idle_with([](CommandFrame& frame) { frame.gripper = grip(300); }), 50ms);
       }},
      {"parol6.host.gripper-speed",
       bad_frame([](CommandFrame& frame) { frame.gripper.speed = -1; })},
      {"parol6.host.gripper-current",
       bad_frame([](CommandFrame& frame) { frame.gripper.current = Milliamperes{1301}; })},
      {"parol6.host.gripper-mode", bad_frame([](CommandFrame& frame) { frame.gripper.mode = 3; })},
      {"parol6.host.gripper-mode-once",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.hold(idle_with([](CommandFrame& frame) { frame.gripper.mode = 1; }), 20ms);
       }},
      {"parol6.host.gripper-forgotten",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.cycle(idle_with([](CommandFrame& frame) { frame.gripper = grip(20, 1); }));
         program.hold(idle_with([](CommandFrame& frame) { frame.gripper = grip(20); }), 50ms);
       },
       calibrated_arm()},
      {"parol6.host.gripper-clear-stopped",
       [](Program& program) {
         const auto stop = [](std::uint8_t mode) {
           return idle_with([mode](CommandFrame& frame) {
             frame.gripper.command = gripper_command::kEstop;
             frame.gripper.mode = mode;
           });
         };
         program.hold(stop(0), 50ms);
         program.cycle(stop(2));
         program.hold(stop(0), 50ms);
       }},
      {"parol6.host.gripper-calibrated",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.hold(idle_with([](CommandFrame& frame) { frame.gripper = grip(20); }), 50ms);
       }},
      {"parol6.host.gripper-activated",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.hold(idle_with([](CommandFrame& frame) {
                        frame.gripper = grip(20);
                        frame.gripper.command = gripper_command::kActivate;
                      }),
                      50ms);
       },
       calibrated_arm()},
      {"parol6.host.rate-fast",
       [](Program& program) {
         for (int i = 0; i < 300; ++i) program.cycle(idle(), 7ms);
       }},
      {"parol6.host.rate-slow",
       [](Program& program) {
         for (int i = 0; i < 50; ++i) program.cycle(idle(), 50ms);
       }},
      {"parol6.host.jitter",
       [](Program& program) {
         for (int i = 0; i < 100; ++i) {
           program.cycle(idle(), 17ms);
           program.cycle(idle(), 4ms);
         }
       }},
      {"parol6.host.gap-in-motion",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.hold(with(Command::kJog, {500}), 50ms);
         program.wait(150ms);
         program.hold(idle(), 50ms);
       }},
      {"parol6.host.silent-in-motion",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.hold(with(Command::kJog, {500}), 50ms);
         program.wait(1s);
       }},
      {"parol6.host.looks-first",
       [](Program& program) {
         program.cycle(with(Command::kJog, {500}));
         program.hold(idle(), 50ms);
       }},
      {"parol6.host.overwritten",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.write(joined(as_vector(encode(with(Command::kHome))), idle_bytes()));
         program.wait(10ms);
       }},
      {"parol6.host.move-disabled",
       [](Program& program) {
         program.hold(with(Command::kDisable), 50ms);
         program.hold(with(Command::kClearError), 50ms);
         program.hold(with(Command::kJog, {500}), 1s);
         program.hold(idle(), 50ms);
       }},
      {"parol6.host.go-to-unhomed",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.hold(go_to({Steps{50}}), 50ms);
         program.hold(idle(), 50ms);
       }},
      {"parol6.host.home-held",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.hold(with(Command::kHome), 2s);
         program.hold(idle(), 32s);
       }},
      {"parol6.host.home-disturbed",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.hold(with(Command::kHome), 50ms);
         program.hold(with(Command::kEnable), 50ms);
         program.hold(idle(), 50ms);
       }},
      {"parol6.host.estop-disables",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.press_estop(Level::kLow);
         program.hold(with(Command::kJog, {500}), 1s);
         program.hold(idle(), 50ms);
       }},
      {"parol6.host.estop-stays",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.press_estop(Level::kLow);
         program.hold(with(Command::kDisable), 50ms);
         program.hold(with(Command::kEnable), 50ms);
         program.hold(idle(), 50ms);
       }},
      {"parol6.host.go-to-range",
       [](Program& program) {
         home(program);
         walk_j1(program, 14'100);
       }},
      {"parol6.host.go-to-pace",
       [](Program& program) {
         home(program);
         auto goal = program.telemetry.position;
         goal[0] = Steps{0};
         program.hold(go_to(goal), 1s);
       }},
      {"parol6.host.go-to-rest",
       [](Program& program) {
         home(program);
         auto goal = program.telemetry.position;
         goal[0] = Steps{10'300};
         program.hold(go_to(goal, 1000), 1s);
         program.hold(idle(), 50ms);
       }},
      {"parol6.host.jog-pace",
       [](Program& program) {
         program.hold(idle(), 50ms);
         program.hold(with(Command::kJog, {15'001}), 50ms);
         program.hold(idle(), 50ms);
       }},
      {"parol6.host.jog-bound",
       [](Program& program) {
         home(program);
         program.hold(with(Command::kJog, {1500}), 3s);
         program.hold(idle(), 50ms);
       }},
      {"parol6.host.idle-speed",
       [](Program& program) { program.hold(with(Command::kIdle, {0, 500}), 50ms); }},
      {"parol6.host.no-effect",
       [](Program& program) {
         home(program);
         auto goal = program.telemetry.position;
         goal[0] = goal[0] + Steps{100};
         program.hold(go_to(goal, -10'000), 1s);
         program.hold(idle(), 50ms);
       }},
  };
}

class EachHostRequirement : public testing::TestWithParam<WrongProgram> {};

TEST_P(EachHostRequirement, IsBrokenByAProgramThatBreaksNoOther) {
  Program program{GetParam().options};
  GetParam().run(program);
  EXPECT_THAT(program.broken(), testing::ElementsAre(std::string{GetParam().requirement}));
  const auto broken =
      std::ranges::find(host_requirements(), GetParam().requirement, &Requirement::id);
  EXPECT_TRUE(program.checker().had_occasion(*broken)) << broken->occasion;
}

TEST(HostRequirements, AreNotTriedByAProgramThatIsIdle) {
  Program program;
  program.hold(idle(), 3s);
  ASSERT_THAT(program.broken(), testing::IsEmpty());
  const auto is_tried = [&](std::string_view id) {
    return program.checker().had_occasion(
        *std::ranges::find(host_requirements(), id, &Requirement::id));
  };
  EXPECT_TRUE(is_tried("parol6.host.frame-length"));
  EXPECT_TRUE(is_tried("parol6.host.rate-slow"));
  for (const auto* id :
       {"parol6.host.gap-in-motion", "parol6.host.estop-disables", "parol6.host.go-to-range",
        "parol6.host.jog-bound", "parol6.host.home-held", "parol6.host.gripper-mode-once"}) {
    EXPECT_FALSE(is_tried(id)) << id;
  }
}

TEST(HostChecker, TellsOfAHostThatDiesInMotionWhenItHappens) {
  Program program;
  program.hold(idle(), 50ms);
  program.hold(with(Command::kJog, {500}), 50ms);
  program.wait(900ms);
  EXPECT_THAT(program.broken_so_far(), testing::IsEmpty()) << "it may still come back";
  program.wait(200ms);
  EXPECT_THAT(program.broken_so_far(), testing::ElementsAre("parol6.host.silent-in-motion"));
  program.wait(10s);
  program.hold(idle(), 50ms);
  EXPECT_THAT(program.broken(), testing::IsEmpty()) << "it was said";
}

TEST(HostChecker, TellsNothingOfAHostThatStopsAndGoes) {
  Program program;
  program.hold(idle(), 50ms);
  program.hold(with(Command::kJog, {500}), 50ms);
  program.hold(idle(), 20ms);
  program.wait(10s);
  EXPECT_THAT(program.broken(), testing::IsEmpty());
}

/// Frames that wait while nobody looks, and then come together.
void send_unseen(Program& program, const CommandFrame& frame, Duration duration) {
  const auto from = program.now();
  program.wait(duration);
  program.overlook(from);
  for (auto left = duration; left > 0ms; left -= 10ms) program.write(encode(frame));
}

TEST(HostChecker, BlamesNobodyForTimesInWhichNobodyLooked) {
  Program program;
  program.hold(idle(), 50ms);
  program.hold(with(Command::kJog, {500}), 500ms);
  send_unseen(program, with(Command::kJog, {500}), 600ms);
  program.hold(with(Command::kJog, {500}), 2s);
  program.hold(idle(), 50ms);
  EXPECT_THAT(program.broken(), testing::IsEmpty());
  EXPECT_TRUE(program.checker().is_in_doubt("parol6.host.gap-in-motion"));
  EXPECT_TRUE(program.checker().is_in_doubt("parol6.host.rate-fast"));
  EXPECT_FALSE(program.checker().is_in_doubt("parol6.host.frame-length"));
  EXPECT_EQ(program.checker().overlooked(), 600ms);
}

TEST(HostChecker, BlamesAProgramForMoreThanWhatNobodySaw) {
  Program program;
  program.hold(idle(), 50ms);
  program.hold(with(Command::kJog, {500}), 500ms);
  const auto from = program.now();
  program.wait(30ms);
  program.overlook(from);
  program.wait(570ms);
  EXPECT_THAT(program.broken_so_far(), testing::IsEmpty());
  program.cycle(idle_with([](CommandFrame& frame) { frame.gripper.id = 16; }));
  EXPECT_THAT(program.broken(),
              testing::ElementsAre("parol6.host.gap-in-motion", "parol6.host.gripper-id"));
}

TEST(HostChecker, BlamesAProgramForItsBytesAtAnyTime) {
  Program program;
  program.hold(idle(), 50ms);
  send_unseen(program, idle_with([](CommandFrame& frame) { frame.gripper.id = 16; }), 600ms);
  EXPECT_THAT(program.broken(), testing::ElementsAre("parol6.host.gripper-id"));
}

TEST(HostChecker, FindsNothingWrongWithAReceiverThatIsReset) {
  const auto store = joined(hex("FF FF FF FF"), test::zeros(255));
  const ByteVector flush(300, std::byte{0x55});
  Program program;
  for (int i = 0; i < 2; ++i) {
    program.write(flush);
    program.write(store);
    program.hold(idle(), 100ms);
  }
  EXPECT_THAT(program.broken_so_far(), testing::IsEmpty());
  program.write(store);
  program.hold(idle(), 30ms);
  EXPECT_THAT(program.broken_so_far(), testing::ElementsAre("parol6.host.stray-bytes"));
  program.write(Bytes{flush}.first(255));
  program.hold(idle(), 30ms);
  EXPECT_THAT(program.broken(), testing::ElementsAre("parol6.host.stray-bytes"));
}

INSTANTIATE_TEST_SUITE_P(Parol6, EachHostRequirement, testing::ValuesIn(wrong_programs()));

TEST(HostRequirements, AreAllBrokenBySomeProgram) {
  std::set<std::string_view> tried;
  for (const auto& wrong : wrong_programs()) tried.insert(wrong.requirement);
  std::set<std::string_view> all;
  for (const auto& requirement : host_requirements()) all.insert(requirement.id);
  EXPECT_EQ(tried, all);
  EXPECT_GE(all.size(), 25U);
}

TEST(HostChecker, FindsNothingWrongWithOurOwnDriver) {
  Program program{calibrated_arm()};
  Drive drive;
  program.run(drive, 200ms);
  ASSERT_TRUE(drive.home());
  program.run(drive, 33s);
  ASSERT_TRUE(is_homed(program.telemetry));
  ASSERT_TRUE(drive.jog({StepsPerSecond{-1500}, StepsPerSecond{1000}}));
  program.run(drive, 500ms);
  drive.idle();
  program.run(drive, 100ms);
  auto goal = program.telemetry.position;
  for (int i = 0; i < 100; ++i) {
    goal[3] = goal[3] + Steps{20};
    ASSERT_TRUE(drive.go_to(
        goal, {StepsPerSecond{0}, StepsPerSecond{0}, StepsPerSecond{0}, StepsPerSecond{2000}}));
    program.run(drive, 10ms);
  }
  ASSERT_TRUE(drive.go_to(goal, {}));
  program.run(drive, 500ms);
  drive.set_gripper(grip(100));
  program.run(drive, 1s);
  drive.set_outputs(io_flag::kOut1);
  drive.disable();
  program.run(drive, 100ms);
  ASSERT_TRUE(drive.enable());
  program.run(drive, 100ms);
  EXPECT_THAT(program.broken(), testing::IsEmpty());
}

/// What a script breaks from standby on, as the vendor's program sends it: a frame each 10 ms.
std::set<std::string> broken_by_script(std::string_view lines) {
  const auto script = script::test::program_of(lines, script::Dialect::kCommander);
  Program program;
  home(program);
  script::Interpreter interpreter{script, {}};
  for (;;) {
    auto frame = interpreter.next(program.telemetry.position);
    if (!frame || !*frame) break;
    (*frame)->gripper = {};
    program.cycle(**frame);
  }
  program.hold(idle(), 50ms);
  return program.broken();
}

TEST(HostChecker, FindsNothingWrongWithTheVendorsScriptsPlayedOnTime) {
  for (const auto* lines : {"MoveJoint(0,-90,180,0,0,180,t=4)\nMoveJoint(90,-90,180,0,0,180,t=4)",
                            "MoveJoint(0,-90,180,60,60,100,v=100,a=100)\n"
                            "MoveJoint(90,-60,200,-60,-60,300,v=100,a=100)\n"
                            "MoveJoint(90,-90,180,0,0,20,v=100,a=100)",
                            "MoveJoint(-20,-90,180,0,0,180,t=3.3,trap)"}) {
    EXPECT_THAT(broken_by_script(lines), testing::IsEmpty()) << lines;
  }
}

TEST(HostChecker, FindsTheVendorsScriptsTooFastThatAre) {
  for (const auto* lines :
       {"MoveJoint(0,-90,180,0,0,180,t=0.6)", "MoveJoint(90,-90,180,0,0,20,t=1.2,trap)",
        "MoveJoint(90,-90,180,80,0,180,t=0.4)"}) {
    EXPECT_THAT(broken_by_script(lines), testing::Contains("parol6.host.go-to-pace")) << lines;
  }
}

TEST(HostChecker, LetsAnArmComeBackFromOutsideItsRange) {
  Program program;
  home(program);
  walk_j1(program, 14'000);
  program.hold(with(Command::kJog, {1500}), 80ms);
  program.hold(idle(), 50ms);
  ASSERT_GT(program.telemetry.position[0].value, 14'050);
  walk_j1(program, 13'900);
  EXPECT_THAT(program.broken(), testing::IsEmpty());
}

TEST(HostChecker, MissesNoSetPointThatTheGripperGotBefore) {
  Program program{calibrated_arm()};
  program.hold(idle(), 50ms);
  for (const auto& set_point : {grip(20), grip(30, 1), grip(20, 2), grip(20)}) {
    program.cycle(idle_with([&](CommandFrame& frame) { frame.gripper = set_point; }));
  }
  EXPECT_THAT(program.broken(), testing::IsEmpty());
}

TEST(HostChecker, NamesTheLimitOfAJog) {
  const auto checker = program_check().make({});
  checker->from_device(at(0ms), encode(TelemetryFrame{.homed = 0xFF, .io = 0xFF}));
  checker->to_device(at(1ms), encode(with(Command::kJog, {15'001})));
  const auto found = checker->take_offences();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what, "j1 was jogged at 15001 steps/s, 15000 is the most of known hosts");
}

TEST(HostChecker, FindsNothingWrongWithADriverThatObeysTheEmergencyStop) {
  Program program;
  Drive drive;
  program.run(drive, 200ms);
  ASSERT_TRUE(drive.jog({StepsPerSecond{500}}));
  program.run(drive, 500ms);
  program.press_estop(Level::kLow);
  program.run(drive, 2s);
  program.press_estop(Level::kHigh);
  program.run(drive, 100ms);
  ASSERT_TRUE(drive.enable());
  program.run(drive, 100ms);
  drive.idle();
  program.run(drive, 100ms);
  EXPECT_THAT(program.broken(), testing::IsEmpty());
}

TEST(HostChecker, FindsNothingWrongWithFramesInPieces) {  // the GUI writes each field by itself
  Program program;
  const auto bytes = idle_bytes();
  for (int i = 0; i < 200; ++i) {
    for (std::size_t at = 0; at < bytes.size(); at += 2) {
      program.write(Bytes{bytes}.subspan(at, 2));
      program.wait(100us);
    }
    program.wait(10ms - 28 * 100us);
  }
  EXPECT_THAT(program.broken(), testing::IsEmpty());
}

TEST(HostChecker, FindsNothingWrongWithTheFirstFrameOfTheGui) {
  // Section 12.1, F3: start values, code 0.
  Program program;
  program.write(
      hex("FF FF FF 34 00 00 01 00 00 0B 00 00 6F 00 04 57 00 2B 67 00 00 0A 00 00 02 00 00 15 00 "
          "00 16 00 00 17 00 00 18 00 00 19 00 FF 00 00 00 01 00 01 00 01 01 00 00 E4 01 02"));
  program.wait(10ms);
  auto frame = idle();
  frame.gripper = {.position = 1, .speed = 1, .current = Milliamperes{1}, .command = 0xD0};
  program.hold(frame, 2s);
  EXPECT_THAT(program.broken(), testing::IsEmpty());
}

TEST(HostChecker, DoesNotBlameAProgramForALateLink) {
  const auto checker = program_check().make({.most = 10ms});
  auto now = at(0ms);
  const auto send = [&](const CommandFrame& frame) { checker->to_device(now, encode(frame)); };
  for (int i = 0; i < 10; ++i, now += 10ms) send(idle());
  now += 10ms;  // one of them is late and comes with the next
  send(with(Command::kEnable));
  send(idle());
  EXPECT_TRUE(checker->take_offences().empty());
  now += 10ms;
  send(with(Command::kEnable));
  send(idle());
  EXPECT_EQ(checker->take_offences().size(), 1U);
}

}  // namespace
}  // namespace armjig::parol6::programs
