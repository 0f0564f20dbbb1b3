// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/arm.hpp"

#include <algorithm>
#include <variant>

namespace armjig::parol6 {

Arm::Arm(const ArmOptions& options) : board_{options.plant, options.timing, options.profile} {
  if (options.gripper) gripper_.emplace(*options.gripper);
}

void Arm::receive(Instant time, Bytes bytes) {
  advance_before(time);
  board_.receive(time, bytes);
}

/// Goes from one exchange to the next: the board asks in a pass in which bytes wait, and must not
/// have gone beyond the moment at which the answer reaches it.
void Arm::advance_to(Instant time) {
  for (;;) {
    const auto request = board_.next_event();
    const auto stop = request ? std::min(*request, time) : time;
    const auto answer = gripper_ ? gripper_->next_event() : std::nullopt;
    if (answer && *answer <= stop) {
      gripper_->advance_to(*answer);
      for (const auto& emission : gripper_->sent()) {
        board_.receive_can(emission.time, emission.frame);
      }
      gripper_->clear_sent();
      continue;
    }
    board_.advance_to(stop);
    take_emissions();
    if (!request || *request > time) break;
  }
  if (gripper_) gripper_->advance_to(time);
}

void Arm::advance_before(Instant time) { advance_to(time - Duration{1}); }

void Arm::take_emissions() {
  for (const auto& emission : board_.sent()) {
    if (const auto* frame = std::get_if<CanFrame>(&emission.what)) {
      if (gripper_) gripper_->receive(emission.time, *frame);
    } else {
      const auto& telemetry = std::get<TelemetryBytes>(emission.what);
      sent_.push_back({emission.time, {telemetry.begin(), telemetry.end()}});
    }
  }
  board_.clear_sent();
}

void Arm::touch_gripper(Instant time, const GripperPlant& plant) {
  advance_before(time);
  if (gripper_) gripper_->touch(time, plant);
}

void Arm::reboot(Instant time) {
  advance_before(time);
  board_.reboot(time);
  if (gripper_) gripper_->reboot(time);
}

}  // namespace armjig::parol6
