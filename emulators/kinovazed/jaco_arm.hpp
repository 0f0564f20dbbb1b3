// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "emulators/kinovazed/bench_arm.hpp"
#include "emulators/kinovazed/jaco_kinematics.hpp"
#include "emulators/kinovazed/plant.hpp"
#include "harness/core/time.hpp"

namespace armjig::kinovazed::emulation {

/// A Jaco with the lengths, ranges, speeds and times of Kinova's material (docs/spec/kinovazed.md,
/// "The arm"): what a client may expect of a real one. Speeds are reached at once. Its angular
/// control is our model: translation axes turn joints 1 to 3, wrist axes joints 4 to 6.
///
/// Like a real arm it has a joystick of its own (`*_by_hand`), which needs nobody's control.
class JacoArm {
 public:
  JacoArm();

  void advance_to(Instant time) noexcept;

  // What the server reads. Noise is in the pose.
  [[nodiscard]] Pose read_pose() noexcept { return body_.read_pose(); }
  [[nodiscard]] ArmMode mode() const noexcept { return body_.mode(); }
  [[nodiscard]] float current_sum() const noexcept;

  // What the server does. Nothing moves without control.
  void take_control() noexcept { has_control_ = true; }
  void release_control() noexcept;
  void select(Control control) noexcept;
  void erase() noexcept { body_.erase(); }
  void move_stick(const Stick& stick) noexcept;
  void press_home() noexcept;
  void release_all() noexcept;
  /// A target that the arm cannot reach is not even approached; nobody is told.
  void go_to(const Pose& target) noexcept;

  // Somebody at the arm's own joystick.
  void move_by_hand(const Stick& stick) noexcept { push_stick(stick); }
  void press_home_by_hand() noexcept { press_due_ = now_ + kPressLatency; }
  void let_go_by_hand() noexcept { release_all(); }

  // What happens to it.
  void set_mode(ArmMode mode) noexcept { body_.set_mode(mode); }
  void set_current_sum(float ampere) noexcept { current_ = ampere; }
  /// In angular control its joints are those of the pose before until a control is selected.
  void set_pose(const Pose& pose) noexcept { body_.set_pose(pose); }
  void hold(bool is_held) noexcept {
    is_held_ = is_held;
    body_.hold(is_held);
  }

  /// Where it is, without noise.
  [[nodiscard]] const Pose& pose() const noexcept { return body_.pose(); }
  /// As of the last change of control or motion of joints.
  [[nodiscard]] const JointAngles& joints() const noexcept { return joints_; }

 private:
  static constexpr Duration kPressLatency = std::chrono::milliseconds{170};

  void push_stick(const Stick& stick) noexcept;
  void turn_joints(double elapsed) noexcept;

  BenchArm body_;
  Instant now_{};
  bool has_control_ = false;
  bool is_held_ = false;
  Control control_ = Control::kCartesian;
  JointAngles joints_ = kReadyAngles;
  Stick stick_;
  std::optional<Instant> press_due_;
  std::optional<float> current_;  ///< none: as it moves
};

}  // namespace armjig::kinovazed::emulation
