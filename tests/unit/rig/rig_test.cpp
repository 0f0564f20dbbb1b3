// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/rig.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "emulators/host/pseudo_terminal.hpp"
#include "emulators/parol6/arm.hpp"
#include "harness/capture/trace.hpp"
#include "harness/link/memory_stream.hpp"
#include "harness/rig/parol6_judge.hpp"
#include "harness/rig/real_target.hpp"
#include "harness/wire/parol6/dissector.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using parol6::Command;
using parol6::CommandFrame;

Outcome<std::unique_ptr<StreamPort>> open_arm(const Target& /*target*/) {
  return std::make_unique<MemoryStream<parol6::emulation::Arm>>(parol6::emulation::Arm{});
}

Wiring<StreamPort> wiring(SerialLine line = {}) {
  return {.device = "parol6",
          .make_dissector = parol6::make_dissector,
          .make_judge = parol6::rig::make_judge,
          .open_emulated = open_arm,
          .open_real = open_target<StreamPort>,
          .line = line};
}

Outcome<Rig<StreamPort>> open(const std::string& target, RigOptions options = {}) {
  options.target = parse_target(target).value();
  return Rig<StreamPort>::open(wiring(), options);
}

const auto kIdle = encode(CommandFrame{.command = Command::kIdle});
const auto kJog = encode(CommandFrame{.command = Command::kJog});

TEST(Rig, AnEmulatedDeviceIsNotGuarded) {
  auto rig = open("emulated:");
  ASSERT_TRUE(rig);
  EXPECT_TRUE(rig->port().write(kJog));
  EXPECT_FALSE(rig->last_refusal());
}

TEST(Rig, EveryOtherDeviceIs) {
  const auto terminal = PseudoTerminal::open().value();
  auto rig = open("pty:" + terminal.path());
  ASSERT_TRUE(rig);
  EXPECT_TRUE(rig->port().write(kIdle));
  EXPECT_EQ(rig->port().write(kJog).error().code, ErrorCode::kForbidden);
  EXPECT_EQ(rig->last_refusal()->hazard, Hazard::kMove);
}

TEST(Rig, AnEmulatedDeviceIsMadeByWhoKnowsEmulators) {
  auto unknown = wiring();
  unknown.open_emulated = [](const Target& target) -> Outcome<std::unique_ptr<StreamPort>> {
    return problem(ErrorCode::kUnsupported, target.text, "asked for an emulator");
  };
  RigOptions options;
  options.target = parse_target("emulated:").value();
  EXPECT_EQ(Rig<StreamPort>::open(unknown, options).error().hint, "asked for an emulator");
}

TEST(Rig, AProgramWithoutRealLinksSaysSo) {
  auto embedded = wiring();
  embedded.open_real = nullptr;
  RigOptions options;
  options.target = parse_target("pty:/dev/pts/99999").value();
  const auto rig = Rig<StreamPort>::open(embedded, options);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(rig.error().where, "pty:/dev/pts/99999");
}

TEST(Rig, SetsATerminalToTheLineOfTheDevice) {
  const auto terminal = PseudoTerminal::open().value();
  for (const auto& [baud, name] :
       {std::pair{1'200U, B1200}, {9'600U, B9600}, {3'000'000U, B3000000}}) {
    RigOptions options;
    options.target = parse_target("pty:" + terminal.path()).value();
    const auto rig = Rig<StreamPort>::open(wiring({.baud = baud, .stop_bits = 2}), options);
    ASSERT_TRUE(rig);
    termios mode{};
    ASSERT_EQ(::tcgetattr(terminal.master().value(), &mode), 0);
    EXPECT_EQ(::cfgetospeed(&mode), name);
    EXPECT_NE(mode.c_cflag & CSTOPB, 0U);
  }
}

TEST(Rig, AnArmThatMayMoveIsNotReopened) {
  RigOptions options;
  options.when_gone = WhenGone::kReopen;
  options.permissions = Permissions::all();
  const auto rig = open("pty:/dev/pts/99999", options);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().code, ErrorCode::kBadValue);
}

TEST(Rig, ImpairmentsAreOutsideTheGuardSoAFlippedBitCannotMakeAMotion) {
  const auto terminal = PseudoTerminal::open().value();
  RigOptions options;
  options.impairment = parse_impairment("loss=100%").value();
  auto rig = open("pty:" + terminal.path(), options);
  ASSERT_TRUE(rig);
  EXPECT_TRUE(rig->port().write(kJog)) << "lost before the guard could see it";
  EXPECT_FALSE(rig->last_refusal());
  EXPECT_TRUE(rig->impairments());
}

TEST(Rig, TheWireLogHasWhatTheDeviceGotAndNotWhatWasRefused) {
  const auto terminal = PseudoTerminal::open().value();
  const std::string path =
      fs::temp_directory_path() / ("armjig-rig-log-" + std::to_string(::getpid()));
  RigOptions options;
  options.capture.file = OutputFile::open(path, OutputFile::Kind::kGrowing).value();
  {
    auto rig = open("pty:" + terminal.path(), options);
    ASSERT_TRUE(rig);
    ASSERT_TRUE(rig->port().write(kIdle));
    ASSERT_FALSE(rig->port().write(kJog));
  }
  const auto events = read_trace(path)->events;
  fs::remove(path);
  ASSERT_EQ(events.size(), 2U) << "the guard's opening, and idle";
  EXPECT_TRUE(test::same_bytes(events.back().bytes, kIdle));
}

TEST(Rig, AWireLogThatCannotBeWrittenIsAProblem) {
  RigOptions options;
  options.capture.file = OutputFile::open("/dev/full", OutputFile::Kind::kGrowing).value();
  const auto rig = open("emulated:", options);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().code, ErrorCode::kCannotWrite);
}

TEST(Rig, WaitingEndsWhenSomebodyWantsAnEnd) {
  const auto terminal = PseudoTerminal::open().value();
  RigOptions options;
  int asked = 0;
  bool is_running = true;
  options.must_stop = [&] { return is_running && ++asked > 2; };
  auto rig = open("pty:" + terminal.path(), options);
  ASSERT_TRUE(rig);
  std::array<std::byte, 8> buffer;
  EXPECT_EQ(rig->port().read(buffer, rig->port().now() + 1h).error().code, ErrorCode::kForbidden);
  EXPECT_EQ(rig->port().write(kIdle).error().code, ErrorCode::kForbidden);
  is_running = false;
  EXPECT_TRUE(rig->port().write(kIdle)) << "the link is still there for putting things in order";
}

TEST(Rig, ATargetThatIsNotThereIsAProblem) {
  EXPECT_EQ(open("pty:/dev/pts/99999").error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace armjig
