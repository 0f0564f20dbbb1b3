// SPDX-License-Identifier: Apache-2.0
// Properties of the board in sessions drawn at random: above all that passes computed in closed
// form are the passes of the plain loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "emulators/parol6/board.hpp"
#include "harness/core/hex.hpp"
#include "tests/unit/emulators/parol6/session.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig::parol6::emulation {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t kSessions = 40;
constexpr Duration kLength = 90s;

std::string text(const Emission& emission) {
  std::ostringstream out;
  out << microseconds(emission.time) << " us ";
  if (const auto* frame = std::get_if<CanFrame>(&emission.what)) {
    out << "can " << std::hex << frame->id << " " << to_hex_dump(frame->payload());
  } else {
    out << to_hex_dump(std::get<TelemetryBytes>(emission.what));
  }
  return out.str();
}

/// Where two boards differ, in what they sent since the last time and in what they are.
std::string difference(Board& expected, Board& actual) {
  const auto sent = expected.sent();
  const auto also_sent = actual.sent();
  for (std::size_t i = 0; i < std::max(sent.size(), also_sent.size()); ++i) {
    const auto wanted = i < sent.size() ? text(sent[i]) : "nothing";
    const auto got = i < also_sent.size() ? text(also_sent[i]) : "nothing";
    if (wanted != got) return "sent\n  expected " + wanted + "\n  actual   " + got;
  }
  expected.clear_sent();
  actual.clear_sent();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& wanted = expected.joints()[j];
    const auto& got = actual.joints()[j];
    if (wanted == got) continue;
    std::ostringstream out;
    out << "J" << j + 1 << ": expected counter " << wanted.stepper.position().value << " speed "
        << wanted.stepper.speed().value << " axis " << wanted.axis.position.value << ", actual "
        << got.stepper.position().value << " speed " << got.stepper.speed().value << " axis "
        << got.axis.position.value;
    return out.str();
  }
  if (expected.homing() != actual.homing()) return "homing";
  if (expected.is_enabled() != actual.is_enabled()) return "enabled";
  if (expected.next_event() != actual.next_event()) return "next event";
  return {};
}

/// Does the actions to two boards and compares after each. `between` may do more to the second.
template <class Between>
void expect_same(const Session& session, Board& expected, Board& actual, std::uint64_t seed,
                 Between between) {
  for (std::size_t i = 0; i <= session.actions.size(); ++i) {
    const bool is_end = i == session.actions.size();
    const auto time = is_end ? session.end : session.actions[i].time;
    between(actual, time);
    if (is_end) {
      expected.advance_to(time);
      actual.advance_to(time);
    } else {
      session.actions[i].act(expected);
      session.actions[i].act(actual);
    }
    const auto found = difference(expected, actual);
    ASSERT_EQ(found, "") << "seed " << seed << ", action " << i << " ("
                         << (is_end ? "end" : session.actions[i].what) << ") at "
                         << microseconds(time) << " us, pass " << session.timing.pass_period.count()
                         << " us";
  }
}

void nothing(Board& /*board*/, Instant /*time*/) {}

class BoardSession : public testing::TestWithParam<std::uint64_t> {
 protected:
  Session session_ = random_session(GetParam(), kLength);
};

TEST_P(BoardSession, IsTheSameInClosedFormAndInAPlainLoop) {
  Board plain{session_.plant, session_.timing};
  plain.use_plain_loop();
  Board closed{session_.plant, session_.timing};
  expect_same(session_, plain, closed, GetParam(), nothing);
}

TEST_P(BoardSession, IsTheSameHoweverTimeIsCut) {
  Board whole{session_.plant, session_.timing};
  auto cut = whole;
  test::Dice dice{GetParam()};
  auto now = at(0s);
  expect_same(session_, whole, cut, GetParam(), [&](Board& board, Instant until) {
    const auto longest = std::max<std::int64_t>((until - now).count() / 20, 1);
    while (now < until) {
      now = std::min(now + Duration{dice.between(1, longest)}, until);
      // What happens at `until` itself has not happened yet.
      board.advance_to(std::min(now, until - Duration{1}));
    }
  });
}

TEST_P(BoardSession, GoesOnFromASnapshotAsFromTheBoardItself) {
  Board board{session_.plant, session_.timing};
  test::Dice dice{GetParam()};
  auto rest = session_;
  const auto half = rest.actions.begin() + dice.between(0, std::ssize(rest.actions));
  for (auto action = rest.actions.begin(); action != half; ++action) action->act(board);
  rest.actions.erase(rest.actions.begin(), half);
  auto snapshot = board;
  expect_same(rest, board, snapshot, GetParam(), nothing);
}

INSTANTIATE_TEST_SUITE_P(Random, BoardSession, testing::Range<std::uint64_t>(0, kSessions));

/// What is worth reaching in a session, and how often all of them do.
TEST(RandomSessions, GetEverywhere) {
  int homed_base = 0;
  int homed_all = 0;
  int demos = 0;
  int moved = 0;
  int answers = 0;
  int many_motions = 0;
  for (std::uint64_t seed = 0; seed < kSessions; ++seed) {
    const auto session = random_session(seed, kLength);
    Board board{session.plant, session.timing};
    std::uint8_t last_homed = 0;
    for (const auto& action : session.actions) {
      action.act(board);
      const auto homed = board.homing().homed();
      if (homed == 0xE0 && last_homed != homed) ++homed_base;
      if (homed == 0xFC && last_homed != homed) ++homed_all;
      last_homed = homed;
      for (const auto& joint : board.joints()) {
        if (joint.motion == Motion::kSeveral) ++many_motions;
        if (joint.motion == Motion::kRamp && last_homed == 0) ++demos;
        if (joint.position() != Steps{0}) ++moved;
      }
      answers += static_cast<int>(board.sent().size());
      board.clear_sent();
    }
  }
  RecordProperty("homed_base", homed_base);
  RecordProperty("homed_all", homed_all);
  EXPECT_GT(homed_base, 10);
  EXPECT_GT(homed_all, 3);
  EXPECT_GT(demos, 10);
  EXPECT_GT(moved, 1000);
  EXPECT_GT(answers, 1000);
  EXPECT_GT(many_motions, 0);
}

}  // namespace
}  // namespace armjig::parol6::emulation
