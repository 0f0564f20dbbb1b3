// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/rig.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "emulators/host/pseudo_terminal.hpp"
#include "emulators/parol6/arm.hpp"
#include "harness/capture/trace.hpp"
#include "harness/link/memory_stream.hpp"
#include "harness/wire/dissector.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using parol6::Command;
using parol6::CommandFrame;

Outcome<std::unique_ptr<StreamPort>> open_arm(const Target& /*target*/) {
  return std::make_unique<MemoryStream<parol6::Arm>>(parol6::Arm{});
}

Outcome<Rig> open(const std::string& target, RigOptions options = {}) {
  options.target = parse_target(target).value();
  return Rig::open("parol6", options, open_arm);
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

TEST(Rig, AllDevicesThatItKnowsCanBeGuardedAndLogged) {
  for (const auto& judge : judges()) {
    EXPECT_NE(std::ranges::find(dissectors(), judge.device, &DissectorEntry::device),
              dissectors().end())
        << judge.device;
  }
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
  options.wire_log = path;
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
  options.wire_log = "/nonexistent/log";
  const auto rig = open("emulated:", options);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().code, ErrorCode::kCannotWrite);
}

TEST(Rig, ATargetThatIsNotThereIsAProblem) {
  EXPECT_EQ(open("pty:/dev/pts/99999").error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace armjig
