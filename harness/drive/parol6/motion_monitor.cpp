// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/motion_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace armjig::parol6::drive {
namespace {

using namespace std::chrono_literals;

/// A joint is taken for stalled when it owes this many steps and has stood for this long.
constexpr double kOwedSteps = 5.0;
constexpr Duration kStallTime = 300ms;
/// A command that ends motion needs some frames to reach the board and to show.
constexpr Duration kStopGrace = 100ms;
/// While homing, joints wait for each other; but some joint always moves.
constexpr Duration kHomingStall = 3s;

/// The speed at which the board should step, from the command and its own laws.
double due_speed(const CommandFrame& command, std::size_t j, std::int32_t position) noexcept {
  const double feed = command.speed[j].value;
  if (command.command == Command::kJog) return feed;
  if (command.command != Command::kGoTo) return 0.0;
  const double distance = command.position[j].value - position;
  const double speed = (feed + 100.0 * distance) / 2.0;
  // On its target a joint stands, or dithers by a step.
  return std::abs(distance) <= 1.0 ? 0.0 : speed;
}

bool should_stand(Command command) noexcept {
  return command == Command::kIdle || command == Command::kDisable || command == Command::kEnable ||
         command == Command::kClearError;
}

}  // namespace

void MotionMonitor::begin(Instant now) noexcept {
  began_ = now;
  has_started_ = false;
  has_stalled_ = false;
  has_moved_on_ = false;
  for (auto& joint : joints_) {
    joint.due_steps = 0;
    joint.moved = now;
  }
}

MotionMonitor::Findings MotionMonitor::observe(Instant now, const CommandFrame& command,
                                               const TelemetryFrame& telemetry) noexcept {
  Findings findings;
  const auto elapsed = std::chrono::duration<double>(last_ ? now - *last_ : Duration{}).count();
  const bool is_first = !last_;
  last_ = now;
  Instant any_moved{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    auto& joint = joints_[j];
    const auto position = telemetry.position[j].value;
    const bool has_moved = !is_first && position != joint.position;
    const auto speed = due_speed(command, j, position);
    joint.position = position;
    if (has_moved) {
      joint.moved = now;
      joint.due_steps = 0;
      if (speed != 0.0 && !has_started_) findings.started = j;
      const bool is_too_late = should_stand(command.command) && now - began_ > kStopGrace;
      if (is_too_late && !has_moved_on_) findings.still_moves = j;
    } else {
      // One that stood for long because nobody led it owes from now on.
      if (joint.due_steps == 0.0 && speed != 0.0) joint.moved = now;
      joint.due_steps = speed == 0.0 ? 0.0 : joint.due_steps + std::abs(speed) * elapsed;
      const bool is_stalled = joint.due_steps > kOwedSteps && now - joint.moved > kStallTime;
      if (is_stalled && !has_stalled_) findings.stalled = j;
    }
    any_moved = std::max(any_moved, joint.moved);
  }
  if (command.command == Command::kHome && now - any_moved > kHomingStall && !has_stalled_) {
    findings.stalled = 0;
  }
  has_started_ = has_started_ || findings.started.has_value();
  has_stalled_ = has_stalled_ || findings.stalled.has_value();
  has_moved_on_ = has_moved_on_ || findings.still_moves.has_value();
  return findings;
}

}  // namespace armjig::parol6::drive
