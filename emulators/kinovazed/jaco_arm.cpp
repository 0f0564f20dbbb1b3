// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/jaco_arm.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace armjig::kinovazed::emulation {
namespace {

constexpr float kStandingCurrent = 0.3F;
constexpr float kMovingCurrent = 2.5F;

/// Times, speeds and poses of docs/spec/kinovazed.md, "The arm".
constexpr BenchOptions kBody{
    .initialise_s = 5.0,
    .unfold_s = 3.0,
    .retract_s = 3.1,
    .to_ready_s = 1.5,
    .linear_m_s = 0.20,
    .rotation_rad_s = 1.07,
    .position_noise = 0.00005,
    .ready = {0.212780F, -0.256650F, 0.506915F, 1.652673F, 1.116417F, 0.120561F},
    .folded = {0.027821F, -0.169285F, 0.297998F, 2.148731F, 0.075051F, -0.175268F},
    .stick_linear_m_s = 0.20,
    .stick_rotation_rad_s = 1.07,
    .stick_signs = {1, 1, 1, 1, 1, 1},
};

}  // namespace

JacoArm::JacoArm() : body_{kBody} { body_.take_control(); }

void JacoArm::advance_to(Instant time) noexcept {
  if (press_due_ && *press_due_ <= time) {
    body_.advance_to(*std::exchange(press_due_, std::nullopt));
    body_.press_home();
  }
  body_.advance_to(time);
  const double elapsed = std::chrono::duration<double>{time - now_}.count();
  now_ = time;
  if (control_ == Control::kAngular && stick_ != Stick{} && !is_held_) turn_joints(elapsed);
}

float JacoArm::current_sum() const noexcept {
  return current_.value_or(body_.is_moving() || stick_ != Stick{} ? kMovingCurrent
                                                                  : kStandingCurrent);
}

void JacoArm::release_control() noexcept {
  release_all();
  body_.erase();
  has_control_ = false;
}

void JacoArm::select(Control control) noexcept {
  if (control == Control::kAngular) joints_ = solve(body_.pose(), joints_).value_or(joints_);
  control_ = control;
}

void JacoArm::move_stick(const Stick& stick) noexcept {
  if (has_control_) push_stick(stick);
}

void JacoArm::push_stick(const Stick& stick) noexcept {
  stick_ = stick;
  const bool is_cartesian = control_ == Control::kCartesian;
  body_.move_stick(is_cartesian ? stick : Stick{});
  if (!is_cartesian && stick != Stick{} && body_.mode() == ArmMode::kReady) {
    body_.set_mode(ArmMode::kElsewhere);
  }
}

void JacoArm::press_home() noexcept {
  if (has_control_) press_due_ = now_ + kPressLatency;
}

void JacoArm::release_all() noexcept {
  press_due_.reset();
  stick_ = {};
  body_.release_all();
}

void JacoArm::go_to(const Pose& target) noexcept {
  if (!has_control_) return;
  const auto angles = solve(target, joints_);
  if (!angles) return body_.erase();
  joints_ = *angles;
  body_.go_to(target);
}

void JacoArm::turn_joints(double elapsed) noexcept {
  std::array<double, 6> speeds{};
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const double axis = i < 3 ? stick_.translation[i] : stick_.wrist[i - 3];
    speeds[i] = std::clamp(axis, -1.0, 1.0);
  }
  joints_ = turned(joints_, speeds, elapsed);
  body_.set_pose(forward(joints_));
}

}  // namespace armjig::kinovazed::emulation
