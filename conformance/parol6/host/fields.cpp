// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/host/fields.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "conformance/parol6/host/occasions.hpp"
#include "harness/wire/parol6/fields.hpp"

namespace armjig::parol6::programs {
namespace {

using gripper_mode::kClearError;
using gripper_mode::kMove;

constexpr bool is_byte(std::int16_t value) noexcept { return value >= 0 && value <= 255; }

constexpr bool is_known(Command command) noexcept {
  constexpr std::array kKnown{Command::kHome,       Command::kEnable, Command::kDisable,
                              Command::kClearError, Command::kJog,    Command::kGoTo,
                              Command::kIdle,       Command::kDemo};
  return std::ranges::find(kKnown, command) != kKnown.end();
}

/// A value that a field may not have.
struct FieldRule {
  std::string_view requirement;
  std::string_view field;
  bool (*is_fine)(const CommandFrame& frame);
};
constexpr std::array kRules{
    FieldRule{"parol6.host.frame-check", "check",
              [](const CommandFrame& frame) {
                return frame.check == kCheckBoard || frame.check == kCheckHost;
              }},
    FieldRule{"parol6.host.no-demo", "command",
              [](const CommandFrame& frame) { return frame.command != Command::kDemo; }},
    FieldRule{"parol6.host.spare-outputs", "in_out",
              [](const CommandFrame& frame) { return (frame.in_out & ~io_flag::kOutputs) == 0; }},
    FieldRule{"parol6.host.timeout", "timeout",
              [](const CommandFrame& frame) {
                return frame.timeout == 0 ||
                       std::chrono::milliseconds{frame.timeout} > kFramePeriod;
              }},
    FieldRule{"parol6.host.gripper-id", "gripper.id",
              [](const CommandFrame& frame) { return frame.gripper.id <= 15; }},
    FieldRule{"parol6.host.gripper-position", "gripper.position",
              [](const CommandFrame& frame) { return is_byte(frame.gripper.position); }},
    FieldRule{"parol6.host.gripper-speed", "gripper.speed",
              [](const CommandFrame& frame) { return is_byte(frame.gripper.speed); }},
    FieldRule{"parol6.host.gripper-current", "gripper.current",
              [](const CommandFrame& frame) {
                return frame.gripper.current >= Milliamperes{0} &&
                       frame.gripper.current <= kMaxGripperCurrent;
              }},
    FieldRule{"parol6.host.gripper-mode", "gripper.mode",
              [](const CommandFrame& frame) { return frame.gripper.mode <= kClearError; }},
};

std::string value_text(std::string_view field_name, const CommandFrame& frame) {
  const auto& field = *find_field(command_fields(), field_name);
  return fmt::format("{} was {}", field_name, field_text(field, field_value(field, encode(frame))));
}

GripperSetPoint without_mode(GripperSetPoint set_point) noexcept {
  set_point.mode = kMove;
  return set_point;
}

}  // namespace

void judge_fields(const CommandFrame& frame, bool is_first, const Complain& complain) {
  for (const auto& rule : kRules) {
    if (!rule.is_fine(frame)) complain(rule.requirement, value_text(rule.field, frame));
  }
  const bool is_start_value = is_first && frame.command == Command{};
  if (!is_known(frame.command) && !is_start_value) {
    complain("parol6.host.known-codes", value_text("command", frame));
  }
}

void GripperConduct::judge(const CommandFrame& frame, const std::optional<GripperReport>& report,
                           const Complain& complain) {
  const auto& wanted = frame.gripper;
  const auto set_point = without_mode(wanted);
  const bool is_one_shot = wanted.mode != kMove && wanted.mode <= kClearError;
  if (is_one_shot) complain.occasion(occasion::kGripperMode);
  if (wanted.mode == kClearError) complain.occasion(occasion::kGripperClear);
  if (is_one_shot && before_ && before_->mode == wanted.mode) {
    complain("parol6.host.gripper-mode-once",
             fmt::format("mode {} stood in one frame after the other", wanted.mode));
  }
  if (wanted.mode == kClearError && (wanted.command & gripper_command::kEstop) != 0) {
    complain("parol6.host.gripper-clear-stopped", "a clear-error came with the stop flag");
  }
  if (wanted.mode == kMove && forgotten_ == set_point) {
    complain(
        "parol6.host.gripper-forgotten",
        fmt::format("position {} came with a calibration or clear-error only", set_point.position));
  }
  const bool is_new = !before_ || without_mode(*before_) != set_point;
  if (!is_one_shot) {
    judge_move(wanted, report, complain);
    forgotten_.reset();
    if (is_new) sent_ = set_point;
  } else if (before_ && is_new && sent_ != set_point) {
    forgotten_ = set_point;
  }
  before_ = wanted;
}

/// The first frame of all tells where the gripper is, and does not send it anywhere.
void GripperConduct::judge_move(const GripperSetPoint& wanted,
                                const std::optional<GripperReport>& report,
                                const Complain& complain) const {
  if (!before_ || before_->position == wanted.position) return;
  complain.occasion(occasion::kGripperMove);
  constexpr auto kGo = gripper_command::kActivate | gripper_command::kGoTo;
  if ((wanted.command & kGo) != kGo) {
    complain("parol6.host.gripper-activated",
             fmt::format("position {} came with flags 0x{:02X}", wanted.position, wanted.command));
  } else if (report && (report->status & gripper_status::kCalibrated) == 0) {
    complain("parol6.host.gripper-calibrated",
             fmt::format("position {} was for a gripper with status 0x{:02X}", wanted.position,
                         report->status));
  }
}

}  // namespace armjig::parol6::programs
