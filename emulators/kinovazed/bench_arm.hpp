// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "emulators/kinovazed/plant.hpp"
#include "harness/core/time.hpp"

namespace armjig::kinovazed::emulation {

/// What the header of a recording says about its arm; seconds, m/s, rad/s, m.
struct BenchOptions {
  ArmMode start_mode = ArmMode::kNeverHomed;
  double initialise_s = 2.0;
  double unfold_s = 1.6;
  double retract_s = 1.6;
  double to_ready_s = 1.2;
  double linear_m_s = 0.5;
  double rotation_rad_s = 2.0;
  double position_noise = 0.0001;
  Pose ready{0.21F, -0.26F, 0.50F, 1.65F, 1.10F, 0.13F};
  Pose folded{0.05F, -0.03F, 0.30F, 1.60F, 0.20F, 0.05F};
  double stick_linear_m_s = 0.2;  ///< at full deflection
  double stick_rotation_rad_s = 0.4;
  /// Where a positive axis leads: x, y, z, yaw, pitch, roll. x and y of the recordings go the other
  /// way than on a real arm.
  std::array<double, 6> stick_signs{-1, -1, 1, 1, 1, 1};
};

/// The simulated arm of the recordings (captures/kinovazed/README.md), which moves in straight
/// lines at constant speed. Times given never decrease.
class BenchArm {
 public:
  explicit BenchArm(const BenchOptions& options = {});

  void advance_to(Instant time) noexcept;

  // What the server reads. Noise is in the pose.
  [[nodiscard]] Pose read_pose() noexcept;
  [[nodiscard]] ArmMode mode() const noexcept { return mode_; }
  [[nodiscard]] float current_sum() const noexcept { return current_sum_; }

  // What the server does. Nothing moves without control.
  void take_control() noexcept { has_control_ = true; }
  void release_control() noexcept;
  void select(Control /*control*/) noexcept {}
  void erase() noexcept;
  void move_stick(const Stick& stick) noexcept;
  void press_home() noexcept;
  void release_all() noexcept;
  void go_to(const Pose& target) noexcept;

  // What happens to it.
  void set_mode(ArmMode mode) noexcept;
  void set_current_sum(float ampere) noexcept { current_sum_ = ampere; }

  void set_pose(const Pose& pose) noexcept { pose_ = pose; }
  /// While it is held it stays where it is or is put, and what moves it goes on afterwards.
  void hold(bool is_held) noexcept { is_held_ = is_held; }

  /// Where it is, without noise.
  [[nodiscard]] const Pose& pose() const noexcept { return pose_; }
  [[nodiscard]] bool is_moving() const noexcept {
    return has_control_ && (has_target_ || is_button_moving());
  }

 private:
  [[nodiscard]] double button_span(ArmMode mode) const noexcept;
  [[nodiscard]] const Pose& button_goal() const noexcept;
  [[nodiscard]] bool is_button_moving() const noexcept;
  void approach(const Pose& goal, double elapsed, double& remaining) noexcept;
  void finish_button() noexcept;
  void steer(double elapsed) noexcept;

  BenchOptions options_;
  Noise noise_{20'231'122};
  Instant now_{};
  ArmMode mode_;
  Pose pose_;
  float current_sum_ = 0.8F;
  bool has_control_ = false;
  bool is_held_ = false;
  bool is_home_held_ = false;
  double button_remaining_s_ = 0;
  bool has_target_ = false;
  Pose target_;
  double target_remaining_s_ = 0;
  Stick stick_;
};

}  // namespace armjig::kinovazed::emulation
