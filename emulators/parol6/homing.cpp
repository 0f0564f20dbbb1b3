// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/homing.hpp"

#include <algorithm>
#include <span>

namespace armjig::parol6::emulation {
namespace {

enum JointIndex : std::size_t { kJ1, kJ2, kJ3, kJ4, kJ5, kJ6 };
constexpr std::size_t kBaseJoints = 3;

/// What the firmware sets on the joint when its final move has arrived.
constexpr StepRate kSpeedAfterJ4{2050};
constexpr StepRate kSpeedAfterParkingJ6{1050};
constexpr StepRate kSpeedAfterJ5{1050};

bool all(std::span<const bool> flags) noexcept {
  return std::ranges::all_of(flags, [](bool flag) { return flag; });
}

void final_move(Joint& joint, StepsPerSecond2 acceleration, Steps target, Micros now) noexcept {
  joint.stepper.set_acceleration(acceleration);
  joint.stepper.move_to(target);
  joint.run(now);
}

void back_off(Joint& joint, const HomingParameters& homing, Micros now) noexcept {
  joint.stepper.move_to(homing.back_off_target);
  joint.stepper.set_speed(homing.back_off_speed);
  joint.run_to_position(now);
}

}  // namespace

Homing::Change Homing::pass(std::array<Joint, kJointCount>& joints, Micros now) noexcept {
  noticed_ = false;
  if (!stages_.has_begun) begin(joints);
  if (!stages_.base_done) {
    base_pass(joints, now);
  } else {
    wrist_pass(joints, now);
  }
  if (stages_.j5_done) {
    finish(joints);
    return Change::kFinished;
  }
  return noticed_ ? Change::kStage : Change::kNone;
}

void Homing::begin(std::array<Joint, kJointCount>& joints) noexcept {
  noticed_ = true;
  stages_.has_begun = true;
  homed_ = 0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    joints[j].stepper.set_speed(table_[j].seek_speed);
  }
}

/// Runs the joint at its speed until the switch reads pressed, there is its zero. Used for both
/// approaches; the switch is read before the step.
void Homing::seek(Joint& joint, bool& seen, Micros now) noexcept {
  if (joint.is_switch_pressed()) {
    seen = true;
    noticed_ = true;
    joint.stepper.set_speed(StepRate{});
    joint.stepper.set_position(Steps{0});
  }
  joint.seek(now);
}

void Homing::base_pass(std::array<Joint, kJointCount>& joints, Micros now) noexcept {
  const auto base = std::span{joints}.first<kBaseJoints>();
  const auto all_at = [&base, this](Steps HomingParameters::* target) {
    return std::ranges::all_of(base, [&, this](const Joint& joint) {
      return joint.position() == table_[static_cast<std::size_t>(&joint - base.data())].*target;
    });
  };
  if (all(std::span{seen_slow_}.first<kBaseJoints>())) {
    for (std::size_t j = 0; j < kBaseJoints; ++j) {
      final_move(base[j], table_[j].acceleration, table_[j].standby_from_switch, now);
    }
    if (all_at(&HomingParameters::standby_from_switch)) {
      for (const auto j : {kJ1, kJ2, kJ3}) mark_homed(j);
      stages_.base_done = true;
      noticed_ = true;
    }
  }
  if (stages_.base_slow_seek) {
    for (std::size_t j = 0; j < kBaseJoints; ++j) {
      if (!seen_slow_[j]) seek(base[j], seen_slow_[j], now);
    }
  }
  if (all(std::span{seen_}.first<kBaseJoints>()) && !stages_.base_slow_seek) {
    for (std::size_t j = 0; j < kBaseJoints; ++j) back_off(base[j], table_[j], now);
    if (all_at(&HomingParameters::back_off_target)) {
      stages_.base_slow_seek = true;
      noticed_ = true;
      for (std::size_t j = 0; j < kBaseJoints; ++j) {
        base[j].stepper.set_speed(table_[j].slow_seek_speed);
      }
    }
  }
  for (std::size_t j = 0; j < kBaseJoints; ++j) {
    if (!seen_[j]) seek(base[j], seen_[j], now);
  }
}

/// The blocks are not alternatives: a later one does not switch an earlier one off, and a joint
/// that is done can still be moved by the steps that do not look at "done".
void Homing::wrist_pass(std::array<Joint, kJointCount>& joints, Micros now) noexcept {
  auto& j4 = joints[kJ4];
  auto& j5 = joints[kJ5];
  auto& j6 = joints[kJ6];
  if (stages_.j6_parked) {
    if (seen_slow_[kJ5] && !stages_.j5_done) {
      final_move(j5, table_[kJ5].acceleration, table_[kJ5].standby_from_switch, now);
      final_move(j6, table_[kJ6].acceleration, table_[kJ6].standby_from_switch, now);
      if (j5.position() == table_[kJ5].standby_from_switch &&
          j6.position() == table_[kJ6].standby_from_switch) {
        for (const auto j : {kJ5, kJ6}) mark_homed(j);
        stages_.j5_done = true;
        noticed_ = true;
        j5.stepper.set_speed(kSpeedAfterJ5);
      }
    }
    single_pass(j5, kJ5, now);
  }
  if (stages_.j4_done) {
    if (seen_slow_[kJ6] && !stages_.j6_parked) {
      final_move(j6, kParkingAccelerationJ6, kParkingJ6, now);
      if (j6.position() == kParkingJ6) {
        stages_.j6_parked = true;
        noticed_ = true;
        j6.stepper.set_speed(kSpeedAfterParkingJ6);
      }
    }
    single_pass(j6, kJ6, now);
  }
  if (seen_slow_[kJ4] && !stages_.j4_done) {
    final_move(j4, table_[kJ4].acceleration, table_[kJ4].standby_from_switch, now);
    if (j4.position() == table_[kJ4].standby_from_switch) {
      mark_homed(kJ4);
      stages_.j4_done = true;
      noticed_ = true;
      j4.stepper.set_speed(kSpeedAfterJ4);
    }
  }
  single_pass(j4, kJ4, now);
}

/// Slow seek, back-off and seek of a joint that homes alone. None of them looks at "done".
void Homing::single_pass(Joint& joint, std::size_t j, Micros now) noexcept {
  const auto& homing = table_[j];
  auto& slow_seek = stages_.slow_seek[j];
  if (slow_seek && !seen_slow_[j]) seek(joint, seen_slow_[j], now);
  if (seen_[j] && !slow_seek) {
    back_off(joint, homing, now);
    if (joint.position() == homing.back_off_target) {
      slow_seek = true;
      noticed_ = true;
      joint.stepper.set_speed(homing.slow_seek_speed);
    }
  }
  if (!seen_[j]) seek(joint, seen_[j], now);
}

void Homing::finish(std::array<Joint, kJointCount>& joints) noexcept {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    joints[j].stepper.set_position(table_[j].standby);
  }
  forget();
}

}  // namespace armjig::parol6::emulation
