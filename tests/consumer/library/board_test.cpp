// SPDX-License-Identifier: Apache-2.0
// A board in a test: no port, no thread, no waiting.
#include <gtest/gtest.h>

#include <chrono>

#include <armjig/emulators/parol6/arm.hpp>
#include <armjig/harness/wire/parol6/joints.hpp>

using namespace armjig;
using namespace std::chrono_literals;

TEST(Board, JogsAsFastAsItIsTold) {
  parol6::emulation::Arm arm;  // switched on at time zero
  const auto begin = arm.board().plant().axes[0].position;
  const auto speed = parol6::kJoints[0].speed(DegreesPerSecond{10});
  arm.receive(at(1s),
              encode(parol6::CommandFrame{.speed = {speed}, .command = parol6::Command::kJog}));
  arm.advance_to(at(3s));
  const auto moved = arm.board().plant().axes[0].position - begin;
  EXPECT_NEAR(parol6::kJoints[0].angle(moved).value, 20, 0.1);
}

TEST(Board, TellsOfItsEmergencyStopAndGoesOn) {
  parol6::emulation::Arm arm;
  ASSERT_TRUE(arm.set_input(at(1s), "estop", 0));
  const auto snapshot = arm;  // a value: a copy is a snapshot
  arm.receive(at(2s), encode(parol6::CommandFrame{.command = parol6::Command::kIdle}));
  arm.advance_to(at(2s + 5ms));
  ASSERT_EQ(arm.sent().size(), 1U);
  EXPECT_EQ(arm.sent()[0].bytes[41], std::byte{0x07});  // io, as docs/spec/parol6.md has it
  EXPECT_TRUE(snapshot.sent().empty());
}
