// SPDX-License-Identifier: Apache-2.0
#include "emulators/kinovazed/bench_arm.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace armjig::kinovazed::emulation {
namespace {

constexpr std::array kAngles{&Pose::pitch, &Pose::yaw, &Pose::roll};
constexpr std::array kPlaces{&Pose::x, &Pose::y, &Pose::z};

/// The same angle, between half a turn and half a turn. What is there already stays, which the
/// library takes long to find out.
double within_a_turn(double angle) noexcept {
  return std::abs(angle) <= std::numbers::pi ? angle : std::remainder(angle, 2 * std::numbers::pi);
}

double short_way(double from, double to) noexcept { return within_a_turn(to - from); }

/// Moves a fraction of the way; angles go the short way round and stay within a turn.
Pose between(const Pose& from, const Pose& to, double fraction) noexcept {
  Pose pose;
  for (const auto place : kPlaces) {
    pose.*place =
        static_cast<float>(from.*place + fraction * (double{to.*place} - double{from.*place}));
  }
  for (const auto angle : kAngles) {
    const double turned = from.*angle + fraction * short_way(from.*angle, to.*angle);
    pose.*angle = static_cast<float>(within_a_turn(turned));
  }
  return pose;
}

}  // namespace

BenchArm::BenchArm(const BenchOptions& options)
    : options_{options},
      mode_{options.start_mode},
      pose_{options_.folded},
      button_remaining_s_{button_span(mode_)} {}

void BenchArm::advance_to(Instant time) noexcept {
  const double elapsed = std::chrono::duration<double>{time - now_}.count();
  now_ = time;
  if (!has_control_ || is_held_ || elapsed <= 0) return;
  if (has_target_) {
    approach(target_, elapsed, target_remaining_s_);
    has_target_ = target_remaining_s_ > 0;
  } else if (is_button_moving()) {
    approach(button_goal(), elapsed, button_remaining_s_);
    if (button_remaining_s_ <= 0) finish_button();
  } else if (stick_ != Stick{}) {
    steer(elapsed);
  }
}

Pose BenchArm::read_pose() noexcept {
  auto read = pose_;
  const auto amplitude = static_cast<float>(options_.position_noise);
  for (const auto place : kPlaces) read.*place += amplitude * noise_.next();
  for (const auto angle : kAngles) read.*angle += amplitude * noise_.next();
  return read;
}

void BenchArm::release_control() noexcept {
  release_all();
  has_target_ = false;
  has_control_ = false;
}

void BenchArm::erase() noexcept { has_target_ = false; }

void BenchArm::move_stick(const Stick& stick) noexcept {
  stick_ = stick;
  const bool leaves_ready = mode_ == ArmMode::kToReady || mode_ == ArmMode::kReady;
  if (has_control_ && leaves_ready && stick != Stick{}) mode_ = ArmMode::kElsewhere;
}

void BenchArm::press_home() noexcept {
  if (is_home_held_ || !has_control_) return;
  has_target_ = false;
  is_home_held_ = true;
  switch (mode_) {
    case ArmMode::kReady:
      mode_ = ArmMode::kReadyToFolded;
      break;
    case ArmMode::kFolded:
      mode_ = ArmMode::kFoldedToReady;
      break;
    case ArmMode::kElsewhere:
      mode_ = ArmMode::kToReady;
      break;
    case ArmMode::kReadyToFolded:
      mode_ = ArmMode::kFoldedToReady;
      // Turning round: what was covered is what there is to go.
      button_remaining_s_ = options_.retract_s - button_remaining_s_;
      return;
    case ArmMode::kFoldedToReady:
      mode_ = ArmMode::kReadyToFolded;
      button_remaining_s_ = options_.unfold_s - button_remaining_s_;
      return;
    default:
      return;
  }
  button_remaining_s_ = button_span(mode_);
}

void BenchArm::release_all() noexcept {
  is_home_held_ = false;
  stick_ = {};
}

void BenchArm::go_to(const Pose& target) noexcept {
  if (!has_control_) return;
  double square = 0;
  double largest = 0;
  for (const auto place : kPlaces) {
    const double way = double{target.*place} - double{pose_.*place};
    square += way * way;
  }
  for (const auto angle : kAngles) {
    largest = std::max(largest, std::abs(short_way(pose_.*angle, target.*angle)));
  }
  target_ = target;
  target_remaining_s_ =
      std::max(std::sqrt(square) / options_.linear_m_s, largest / options_.rotation_rad_s);
  has_target_ = target_remaining_s_ > 0;
  is_home_held_ = false;
  mode_ = ArmMode::kElsewhere;
}

void BenchArm::set_mode(ArmMode mode) noexcept {
  mode_ = mode;
  is_home_held_ = false;
  button_remaining_s_ = button_span(mode);
}

double BenchArm::button_span(ArmMode mode) const noexcept {
  switch (mode) {
    case ArmMode::kNeverHomed:
      return options_.initialise_s;
    case ArmMode::kReadyToFolded:
      return options_.retract_s;
    case ArmMode::kFoldedToReady:
      return options_.unfold_s;
    default:
      return options_.to_ready_s;
  }
}

const Pose& BenchArm::button_goal() const noexcept {
  return mode_ == ArmMode::kReadyToFolded ? options_.folded : options_.ready;
}

bool BenchArm::is_button_moving() const noexcept {
  return is_home_held_ && (mode_ == ArmMode::kNeverHomed || mode_ == ArmMode::kToReady ||
                           mode_ == ArmMode::kReadyToFolded || mode_ == ArmMode::kFoldedToReady);
}

void BenchArm::approach(const Pose& goal, double elapsed, double& remaining) noexcept {
  if (elapsed >= remaining) {
    pose_ = goal;
    remaining = 0;
    return;
  }
  pose_ = between(pose_, goal, elapsed / remaining);
  remaining -= elapsed;
}

void BenchArm::finish_button() noexcept {
  mode_ = mode_ == ArmMode::kReadyToFolded ? ArmMode::kFolded : ArmMode::kReady;
  is_home_held_ = false;
}

void BenchArm::steer(double elapsed) noexcept {
  const auto move = [&](float Pose::* component, float axis, double speed, double sign) {
    const double rate = sign * speed * std::clamp(double{axis}, -1.0, 1.0);
    pose_.*component = static_cast<float>(pose_.*component + rate * elapsed);
  };
  const auto& [translation, wrist] = stick_;
  const auto& signs = options_.stick_signs;
  move(&Pose::x, translation[0], options_.stick_linear_m_s, signs[0]);
  move(&Pose::y, translation[1], options_.stick_linear_m_s, signs[1]);
  move(&Pose::z, translation[2], options_.stick_linear_m_s, signs[2]);
  move(&Pose::yaw, wrist[0], options_.stick_rotation_rad_s, signs[3]);
  move(&Pose::pitch, wrist[1], options_.stick_rotation_rad_s, signs[4]);
  move(&Pose::roll, wrist[2], options_.stick_rotation_rad_s, signs[5]);
  pose_.x = std::clamp(pose_.x, -0.79F, 0.79F);
  pose_.y = std::clamp(pose_.y, -0.84F, 0.84F);
  pose_.z = std::clamp(pose_.z, 0.F, 1.14F);
  for (const auto angle : kAngles) {
    pose_.*angle = static_cast<float>(within_a_turn(pose_.*angle));
  }
}

}  // namespace armjig::kinovazed::emulation
