// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "harness/capture/trace.hpp"
#include "harness/motion/parol6/conversion.hpp"
#include "harness/motion/parol6/planner.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "tests/unit/support/bytes.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig::parol6::planning {
namespace {

/// The frames of each move in a recording: each stretch of one moving command.
std::vector<std::vector<Bytes>> moves_in(const Trace& trace) {
  constexpr std::size_t kCommandByte = 40;
  std::vector<std::vector<Bytes>> moves;
  bool is_moving = false;
  for (const auto& event : trace.events) {
    if (event.dir != "to_device") continue;
    const auto command = static_cast<Command>(event.bytes.at(kCommandByte));
    const bool moves_now = command == Command::kGoTo || command == Command::kJog;
    if (moves_now && !is_moving) moves.emplace_back();
    if (moves_now) moves.back().emplace_back(event.bytes);
    is_moving = moves_now;
  }
  return moves;
}

/// The frames that the recording host would have sent for a plan: all that a plan does not say is
/// as in its other frames.
std::vector<CommandBytes> frames_of(const Plan& plan) {
  std::vector<CommandBytes> frames;
  for (const auto& set_point : plan.set_points) {
    frames.push_back(encode(CommandFrame{
        .position = set_point.position,
        .speed = set_point.speed,
        .command = command_of(plan.tracking),
        .affected_joints = 0xFF,
        .gripper = {.position = 1, .speed = 1, .current = Milliamperes{1}, .command = 1},
        .check = kCheckHost}));
  }
  return frames;
}

struct RecordedMove {
  JointSteps from{};
  JointSteps to{};
  double duration{};
  Law law{};
  Tracking tracking{};
};

constexpr JointSteps steps(std::array<int, kJointCount> values) {
  JointSteps result;
  for (std::size_t j = 0; j < kJointCount; ++j) result[j] = Steps{values[j]};
  return result;
}

/// The recordings of boards that were not homed are beyond what angles allow.
Plan planned(const RecordedMove& recorded) {
  Move move{.kind = Move::Kind::kJoint,
            .timing = {.duration = recorded.duration, .law = recorded.law},
            .tracking = recorded.tracking};
  for (std::size_t j = 0; j < kJointCount; ++j) move.target[j] = degrees_of(j, recorded.to[j]);
  const auto result = plan(move, recorded.from, {.limits = LimitCheck::kIgnored});
  EXPECT_TRUE(result.has_value());
  return result.value_or(Plan{});
}

void expect_recorded(const std::string& name, const std::vector<RecordedMove>& moves) {
  const auto trace = read_trace(source_dir() + "/captures/parol6/" + name);
  ASSERT_TRUE(trace.has_value()) << describe(trace.error());
  const auto recorded = moves_in(*trace);
  ASSERT_EQ(recorded.size(), moves.size());
  for (std::size_t m = 0; m < moves.size(); ++m) {
    const auto frames = frames_of(planned(moves[m]));
    ASSERT_EQ(frames.size(), recorded[m].size()) << name << ", move " << m;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      ASSERT_TRUE(test::same_bytes(frames[k], recorded[m][k]))
          << name << ", move " << m << ", sample " << k;
    }
  }
}

constexpr auto kZero = steps({0, 0, 0, 0, 0, 0});
constexpr auto kStandby = steps({10240, -32000, 57905, 0, 0, 32000});

TEST(RecordedMoves, ATrapezoidWithPositionsIsTheRecordedBytes) {
  constexpr auto kFar = steps({2500, -6000, 7000, -3000, 3500, 12000});
  expect_recorded("planner_trap_speed_pos_a.jsonl",
                  {{kZero, kFar, 3, Law::kTrapezoid, Tracking::kSpeedAndPosition},
                   {kFar, kZero, 2, Law::kTrapezoid, Tracking::kSpeedAndPosition}});
}

TEST(RecordedMoves, APolynomialOfSpeedsIsTheRecordedBytes) {
  constexpr auto kFar = steps({2500, -6000, 7000, -3000, 3500, 12000});
  expect_recorded("planner_quintic_speed_only_a.jsonl",
                  {{kZero, kFar, 4, Law::kPolynomial, Tracking::kSpeed}});
}

TEST(RecordedMoves, MovesBehindAHomingAreTheRecordedBytes) {
  constexpr auto kFar = steps({13000, -41000, 46100, -3700, 2050, 23000});
  expect_recorded("planner_home_then_moves_a.jsonl",
                  {{kStandby, kFar, 4, Law::kTrapezoid, Tracking::kSpeed},
                   {kFar, kStandby, 4, Law::kPolynomial, Tracking::kSpeedAndPosition}});
}

}  // namespace
}  // namespace armjig::parol6::planning
