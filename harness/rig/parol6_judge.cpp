// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/parol6_judge.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <utility>
#include <variant>

#include "harness/wire/parol6/firmware_receiver.hpp"
#include "harness/wire/parol6/splitter.hpp"

namespace armjig::parol6 {
namespace {

constexpr std::uint8_t kAllHomed = 0xFC;
constexpr std::uint8_t kOutputs = io_flag::kOut1 | io_flag::kOut2;

bool is_outside(const JointBounds& bounds, Steps position) noexcept {
  return position < bounds.lower || position > bounds.upper;
}

/// Whether `speed` drives a joint that stands at or beyond a bound further out.
bool leads_out(const JointBounds& bounds, Steps position, StepsPerSecond speed) noexcept {
  return (position >= bounds.upper && speed.value > 0) ||
         (position <= bounds.lower && speed.value < 0);
}

class BoardJudge final : public Judge {
 public:
  std::optional<Refusal> judge(Bytes bytes, const Permissions& permissions) override {
    auto receiver = receiver_;
    auto latched = latched_;
    while (!bytes.empty()) {
      const auto step = receiver.step(bytes);
      bytes = bytes.subspan(step.used);
      if (!step.accepted) continue;
      const auto frame = decode_command(receiver.body());
      if (auto refusal = judge_frame(frame, latched, permissions)) return refusal;
      latched = frame;
    }
    receiver_ = receiver;
    latched_ = latched;
    if (latched_.command == Command::kHome) may_be_homing_ = true;
    const bool ends_homing =
        latched_.command == Command::kEnable || latched_.command == Command::kDisable ||
        latched_.command == Command::kClearError || latched_.command == Command::kJog ||
        latched_.command == Command::kGoTo;
    if (ends_homing) may_be_homing_ = false;
    return std::nullopt;
  }

  void observe(Bytes bytes) override {
    while (!bytes.empty()) {
      const auto step = splitter_.step(bytes);
      bytes = bytes.subspan(step.used);
      const auto* frame = std::get_if<Splitter::Frame>(&step.found);
      if (frame == nullptr) continue;
      telemetry_ = decode_telemetry(body_of(frame->bytes.first<kTelemetryFrameSize>()));
      if (is_homed()) may_be_homing_ = may_be_homing_ && latched_.command == Command::kHome;
    }
    if (may_be_moving() && !stop_reason_) stop_reason_ = reason_to_stop();
  }

  std::optional<std::string> must_stop() override {
    auto reason = std::exchange(stop_reason_, std::nullopt);
    if (reason) {
      latched_.command = Command::kDisable;
      may_be_homing_ = false;
    }
    return reason;
  }

  [[nodiscard]] bool may_be_moving() const override {
    return latched_.command == Command::kJog || latched_.command == Command::kGoTo ||
           may_be_homing_;
  }

  [[nodiscard]] std::vector<std::byte> stop_bytes() const override {
    auto frame = latched_;
    frame.command = Command::kDisable;
    frame.speed = {};
    frame.check = kCheckHost;
    frame.gripper.mode = 0;
    const auto bytes = encode(frame);
    return {bytes.begin(), bytes.end()};
  }

 private:
  [[nodiscard]] bool is_homed() const noexcept {
    return telemetry_ && (telemetry_->homed & kAllHomed) == kAllHomed;
  }
  [[nodiscard]] bool is_estop_pressed() const noexcept {
    return telemetry_ && (telemetry_->io & io_flag::kEstopReleased) == 0;
  }

  [[nodiscard]] std::optional<Refusal> judge_frame(const CommandFrame& frame,
                                                   const CommandFrame& before,
                                                   const Permissions& permissions) const {
    const auto needs = [&](Hazard hazard, std::string_view what) -> std::optional<Refusal> {
      if (permissions.allow(hazard)) return std::nullopt;
      return Refusal{hazard, fmt::format("{} needs --allow {}", what, to_string(hazard))};
    };
    if (((frame.in_out ^ before.in_out) & kOutputs) != 0) {
      if (auto refusal = needs(Hazard::kState, "switching an output")) return refusal;
    }
    if (frame.gripper != before.gripper) {
      if (auto refusal = needs(Hazard::kGrip, "a gripper set-point")) return refusal;
    }
    switch (frame.command) {
      case Command::kEnable:
        return needs(Hazard::kState, "enable");
      case Command::kClearError:
        return needs(Hazard::kState, "clear error");
      case Command::kHome:
        if (auto refusal = needs(Hazard::kHome, "home")) return refusal;
        return refuse_while_stopped(Hazard::kHome);
      case Command::kJog:
        if (auto refusal = needs(Hazard::kMove, "jog")) return refusal;
        if (auto refusal = refuse_while_stopped(Hazard::kMove)) return refusal;
        return judge_jog(frame);
      case Command::kGoTo:
        if (auto refusal = needs(Hazard::kMove, "go-to")) return refusal;
        if (auto refusal = refuse_while_stopped(Hazard::kMove)) return refusal;
        return judge_go_to(frame);
      case Command::kDemo:
        return Refusal{Hazard::kMove, "code 69 moves all joints and cannot be disabled"};
      case Command::kIdle:
      case Command::kDisable:
        break;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Refusal> refuse_while_stopped(Hazard hazard) const {
    if (!is_estop_pressed()) return std::nullopt;
    return Refusal{hazard, "the emergency stop is pressed"};
  }

  [[nodiscard]] std::optional<Refusal> judge_jog(const CommandFrame& frame) const {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto speed = frame.speed[j];
      if (std::abs(speed.value) > kJointBounds[j].max_jog.value) {
        return Refusal{Hazard::kMove, fmt::format("j{} may jog at most at {} steps/s", j + 1,
                                                  kJointBounds[j].max_jog.value)};
      }
      if (is_homed() && leads_out(kJointBounds[j], telemetry_->position[j], speed)) {
        return Refusal{Hazard::kMove, fmt::format("j{} is at its bound", j + 1)};
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Refusal> judge_go_to(const CommandFrame& frame) const {
    if (!is_homed()) return Refusal{Hazard::kMove, "go-to needs a homed arm"};
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto& bounds = kJointBounds[j];
      if (is_outside(bounds, frame.position[j])) {
        return Refusal{Hazard::kMove, fmt::format("j{} may go from {} to {} steps", j + 1,
                                                  bounds.lower.value, bounds.upper.value)};
      }
      // The board closes any distance within 10 ms if it can, so far targets are fast ones.
      const auto closing =
          50.0 * std::abs(frame.position[j].value - telemetry_->position[j].value) +
          std::abs(frame.speed[j].value) / 2.0;
      if (closing > bounds.max_speed.value) {
        return Refusal{Hazard::kMove,
                       fmt::format("j{} would go at {:.0f} steps/s, {} are allowed: send the way "
                                   "in smaller pieces",
                                   j + 1, closing, bounds.max_speed.value)};
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<std::string> reason_to_stop() const {
    if (is_estop_pressed()) return "the emergency stop was pressed";
    if (!is_homed() || latched_.command != Command::kJog) return std::nullopt;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (leads_out(kJointBounds[j], telemetry_->position[j], latched_.speed[j])) {
        return fmt::format("j{} reached its bound", j + 1);
      }
    }
    return std::nullopt;
  }

  FirmwareReceiver receiver_;  ///< what the board would make of the bytes
  CommandFrame latched_{};
  Splitter splitter_{kTelemetryPayloadSize};
  std::optional<TelemetryFrame> telemetry_;
  std::optional<std::string> stop_reason_;
  bool may_be_homing_ = false;
};

}  // namespace

std::unique_ptr<Judge> make_judge() { return std::make_unique<BoardJudge>(); }

}  // namespace armjig::parol6
