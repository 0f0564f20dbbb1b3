// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/motion.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "conformance/parol6/laws.hpp"
#include "harness/wire/parol6/readings.hpp"

namespace armjig::parol6::conformance {
namespace {

double seconds(Duration time) { return std::chrono::duration<double>(time).count(); }

/// How long a pass of the board's loop may take. Recordings have 20 to 100 us; a board that
/// somebody hosts on a busy machine has as much more as its answers show, up to a bound that keeps
/// speeds worth judging.
Duration longest_loop(const BoardBench& board) {
  using namespace std::chrono_literals;
  return std::clamp<Duration>(board.noise(), 100us, 250us);
}

struct StepBounds {
  double least;
  double most;
};

/// Of a stretch that begins at one speed and ends at the other.
StepBounds possible_steps(const BoardBench& board, const Stretch& stretch, int one, int other) {
  const auto [slow, fast] = std::minmax({std::abs(one), std::abs(other)});
  const auto shortest = seconds(stretch.after.asked - stretch.before.received);
  const auto longest = seconds(stretch.after.received - stretch.before.asked);
  return {shortest * (1 - kClockError) / (step_interval(slow) + seconds(longest_loop(board))),
          longest * (1 + kClockError) / step_interval(fast)};
}

}  // namespace

std::string speed_field(std::size_t joint) { return fmt::format("speed.j{}", joint + 1); }
std::string position_field(std::size_t joint) { return fmt::format("position.j{}", joint + 1); }

std::int32_t steps(const Stretch& stretch, std::size_t joint) noexcept {
  return stretch.after.position[joint].value - stretch.before.position[joint].value;
}

Stretch run(BoardBench& board, const CommandFrame& frame, Duration time) {
  board.act(frame);
  auto before = board.ask(frame);
  return {before, board.keep_asking(frame, time)};
}

void expect_speed(BoardBench& board, const Stretch& stretch, std::size_t joint, int speed) {
  if (board.is_over()) return;
  const auto possible = possible_steps(board, stretch, speed, speed);
  const auto made = steps(stretch, joint) * (speed < 0 ? -1 : 1);
  const auto longest = seconds(stretch.after.received - stretch.before.asked);
  const double least = possible.least - 1.0;
  const double most = possible.most + 1.0;
  board.expect_in_time(
      {static_cast<double>(made), least, most, "steps"},
      fmt::format("j{} to make {:.0f} to {:.0f} steps {} at {} steps/s in {:.1f} ms", joint + 1,
                  std::ceil(least), most, speed < 0 ? "down" : "up", speed, longest * 1e3),
      fmt::format("{} steps", steps(stretch, joint)));
}

void expect_pace(BoardBench& board, std::span<const Answer> answers, std::size_t joint) {
  if (board.is_over() || answers.empty()) return;
  StepBounds total{-2.0, 2.0};
  for (std::size_t i = 1; i < answers.size(); ++i) {
    const auto slow = answers[i - 1].speed[joint].value;
    const auto fast = answers[i].speed[joint].value;
    const auto possible = possible_steps(board, {answers[i - 1], answers[i]}, slow, fast);
    total.least += possible.least;
    total.most += possible.most;
  }
  const auto made = steps({answers.front(), answers.back()}, joint);
  board.expect_in_time({static_cast<double>(std::abs(made)), total.least, total.most, "steps"},
                       fmt::format("j{} to make {:.0f} to {:.0f} steps at the speeds that it says",
                                   joint + 1, std::ceil(total.least), total.most),
                       fmt::format("{} steps", std::abs(made)));
}

void expect_seen(BoardBench& board, std::span<const Answer> answers, std::string_view what) {
  if (is_without_gap(answers)) return;
  board.leave_open(fmt::format("this machine did not look at {} for more than 100 ms", what));
}

void expect_still(BoardBench& board, const Stretch& stretch) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    board.expect_same(stretch.after, position_field(j), stretch.before);
  }
}

void expect_still(BoardBench& board, const CommandFrame& frame, Duration time) {
  expect_still(board, run(board, frame, time));
}

void expect_moved(BoardBench& board, const Stretch& stretch) {
  bool has_moved = false;
  for (std::size_t j = 0; j < kJointCount; ++j) has_moved |= steps(stretch, j) != 0;
  board.expect_true(has_moved, "motion", "all joints stand still");
}

void spoil_disabled(BoardBench& board) {
  board.spoil();
  board.act(with_code(Command::kDisable));
}

void expect_reported(BoardBench& board, const Answer& answer, const Speeds& speeds) {
  for (std::size_t j = 0; j < kJointCount; ++j) board.expect(answer, speed_field(j), speeds[j]);
}

void begin_homing(BoardBench& board, Duration time) {
  board.act(with_code(100));
  board.keep_asking(idle(), time);
}

Answer rest_in_homing(BoardBench& board) {
  constexpr int kPause = 42;  // means nothing (parol6.home.paused)
  board.act(with_code(kPause));
  board.act(with_code(kPause));
  return board.ask(with_code(kPause));
}

void home_by_idling(BoardBench& board) {
  constexpr Duration kWholeRun = std::chrono::seconds{90};
  board.act(with_code(Command::kHome));
  const auto is_done = [](const Answer& answer) { return is_homed(answer); };
  if (!board.ask_until(idle(), is_done, kWholeRun)) {
    board.fail("all joints homed", "not within 90 s");
  }
}

std::array<Steps, kJointCount> beside(const TelemetryFrame& answer, std::size_t joint, int steps) {
  auto positions = answer.position;
  positions[joint].value += steps;
  return positions;
}

}  // namespace armjig::parol6::conformance
