// SPDX-License-Identifier: Apache-2.0
// What the guard believes of a board, beside the emulated board itself: neither has code of the
// other.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "emulators/parol6/firmware_receiver.hpp"
#include "harness/rig/parol6_judge.hpp"
#include "harness/rig/parol6_receiver.hpp"
#include "tests/unit/emulators/parol6/desk.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::parol6::rig {
namespace {

using emulation::Desk;
using emulation::FirmwareReceiver;
using namespace std::chrono_literals;

/// Where frames ended, and what the board unpacks there.
using Accepted = std::vector<std::pair<std::size_t, test::ByteVector>>;

Accepted accepted_by_guard(Bytes stream) {
  ShippedReceiver receiver;
  Accepted accepted;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if (receiver.take(stream[i])) accepted.emplace_back(i + 1, test::as_vector(receiver.body()));
  }
  return accepted;
}

Accepted accepted_by_board(Bytes stream) {
  FirmwareReceiver receiver;
  Accepted accepted;
  for (std::size_t used = 0; used < stream.size();) {
    const auto step = receiver.step(stream.subspan(used));
    used += step.used;
    if (step.accepted) accepted.emplace_back(used, test::as_vector(receiver.body()));
  }
  return accepted;
}

/// Headers, ends and noise in any order, good frames among them.
test::ByteVector any_stream(test::Dice& dice) {
  test::ByteVector stream;
  for (auto pieces = dice.between(1, 40); pieces > 0; --pieces) {
    switch (dice.between(0, 4)) {
      case 0:
        stream = test::joined(std::move(stream), encode(CommandFrame{.command = Command::kIdle}));
        break;
      case 1:
        stream =
            test::joined(std::move(stream), test::hex("FF FF FF"), test::ByteVector{dice.byte()});
        break;
      case 2:
        stream = test::joined(std::move(stream),
                              test::hex(dice.one_in(2) ? "FF FF FF 00" : "FF FF FF 01"));
        break;
      case 3:
        stream = test::joined(std::move(stream), test::hex(dice.one_in(3) ? "FF" : "01 02"));
        break;
      default:
        for (auto size = dice.between(1, 300); size > 0; --size) stream.push_back(dice.byte());
        break;
    }
  }
  return stream;
}

TEST(LawsOfGuardAndBoard, TheSameFramesAreAccepted) {
  test::Dice dice{6};
  std::size_t frames = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto stream = any_stream(dice);
    const auto accepted = accepted_by_guard(stream);
    ASSERT_EQ(accepted, accepted_by_board(stream)) << to_hex_dump(stream);
    frames += accepted.size();
  }
  EXPECT_GT(frames, 3000U);
}

/// A guard with its own idea of a board, and the board.
struct Pair {
  std::unique_ptr<Judge> judge = make_judge();
  Desk desk{emulation::board_with_pass(20)};

  [[nodiscard]] bool allows(const CommandFrame& frame, const Permissions& permissions) const {
    const auto bytes = encode(frame);
    const Bytes message{bytes};
    return !judge->judge({&message, 1}, permissions);
  }
  void send(const CommandFrame& frame) { judge->observe(encode(desk.send(frame))); }
};

TEST(LawsOfGuardAndBoard, WhateverMovesIsBelievedToMove) {
  using enum Command;
  constexpr std::array kCodes{kIdle, kIdle, kHome, kJog, kEnable, kDisable, kClearError, Command{}};
  test::Dice dice{7};
  Pair pair;
  int moved = 0;
  int believed_still = 0;
  for (int i = 0; i < 20'000; ++i) {
    auto frame =
        emulation::command(kCodes[static_cast<std::size_t>(dice.between(0, kCodes.size() - 1))]);
    // Away from the switches, and not for long.
    for (auto& speed : frame.speed) speed = StepsPerSecond{dice.one_in(2) ? 400 : 0};
    if (pair.allows(frame, Permissions::all())) pair.send(frame);
    const auto before = emulation::counters(pair.desk.board);
    pair.desk.wait(std::chrono::milliseconds{dice.between(3, 30)});
    const bool has_moved = emulation::counters(pair.desk.board) != before;
    ASSERT_TRUE(!has_moved || pair.judge->may_be_moving()) << i;
    moved += has_moved ? 1 : 0;
    believed_still += pair.judge->may_be_moving() ? 0 : 1;
  }
  EXPECT_GT(moved, 2000);
  EXPECT_GT(believed_still, 2000);
}

TEST(LawsOfGuardAndBoard, TheGripperIsToldSomethingWhereAPermissionIsAskedFor) {
  Permissions without_grip;
  for (const auto hazard : {Hazard::kState, Hazard::kMove, Hazard::kHome}) without_grip.add(hazard);
  test::Dice dice{8};
  Pair pair;
  int asked = 0;
  for (int i = 0; i < 5000; ++i) {
    auto frame = emulation::command(Command::kIdle);
    frame.gripper = {.position = static_cast<std::int16_t>(dice.one_in(4) ? 1 : 0),
                     .command = static_cast<std::uint8_t>(dice.one_in(4) ? 0x80 : 0),
                     .mode = static_cast<std::uint8_t>(dice.one_in(4) ? dice.between(0, 4) : 0)};
    const bool is_asked = !pair.allows(frame, without_grip);
    if (is_asked) {
      ASSERT_TRUE(pair.allows(frame, Permissions::all()));
    }
    pair.send(frame);
    const auto& can = pair.desk.can.back();
    const bool is_poll =
        can.size == 0 && emulation::can_command(can.id) == emulation::GripperCan::kSetPoint;
    ASSERT_EQ(is_asked, !is_poll) << i;
    asked += is_asked ? 1 : 0;
  }
  EXPECT_GT(asked, 1000);
  EXPECT_LT(asked, 4000);
}

}  // namespace
}  // namespace armjig::parol6::rig
