// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/drive.hpp"

#include <fmt/core.h>

#include <string_view>
#include <utility>
#include <variant>

#include "harness/wire/parol6/fields.hpp"
#include "harness/wire/steps.hpp"

namespace armjig::parol6::drive {
namespace {

using namespace std::chrono_literals;

constexpr Duration kSilence = 500ms;
constexpr Duration kEchoTime = 500ms;  ///< for the echo of a command that is sent once
constexpr int kPeriodsUntilLost = 20;
constexpr std::uint8_t kAllHomed = 0xFC;

std::string_view name_of(DriveEvent::Kind kind) noexcept {
  constexpr std::array<std::string_view, 9> kNames{
      "emergency stop pressed, latched until it is released and the arm enabled again",
      "emergency stop released, still latched until the arm is enabled again",
      "no telemetry for half a second",
      "telemetry is back",
      "took effect",
      "had no effect",
      "accepted, but nothing moved",
      "the arm still moves",
      "homed"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace

std::string describe(const DriveEvent& event) {
  const auto& field = *find_field(command_fields(), "command");
  auto text = fmt::format("{}: {}", field_text(field, static_cast<std::int64_t>(event.command)),
                          name_of(event.kind));
  if (event.joint) text += fmt::format(" (j{})", *event.joint + 1);
  return text;
}

void Drive::request(Command command) noexcept {
  frame_.command = command;
  one_shot_.reset();
  homing_ = Homing::kNo;
}

void Drive::request_once(Command command) noexcept {
  request(Command::kIdle);
  frame_.speed = {};
  one_shot_ = OneShot{command, std::nullopt};
}

void Drive::idle() noexcept {
  request(Command::kIdle);
  frame_.speed = {};
}

Result<void> Drive::jog(const JointSpeeds& speeds) noexcept {
  if (is_latched_) return fail(ErrorCode::kRefused);
  if (frame_.command != Command::kJog || one_shot_) request(Command::kJog);
  frame_.speed = speeds;
  return {};
}

Result<void> Drive::go_to(const JointSteps& goal, const JointSpeeds& feed) noexcept {
  if (is_latched_) return fail(ErrorCode::kRefused);
  if (frame_.command != Command::kGoTo || one_shot_) request(Command::kGoTo);
  frame_.position = goal;
  frame_.speed = feed;
  return {};
}

Result<void> Drive::home() noexcept {
  if (is_latched_) return fail(ErrorCode::kRefused);
  request_once(Command::kHome);
  homing_ = Homing::kAsked;
  has_seen_unhomed_ = false;
  return {};
}

Result<void> Drive::clear_error() noexcept {
  if (is_latched_) return fail(ErrorCode::kRefused);
  request_once(Command::kClearError);
  return {};
}

void Drive::disable() noexcept { request_once(Command::kDisable); }

Result<void> Drive::enable() noexcept {
  if (is_estop_pressed_) return fail(ErrorCode::kRefused);
  is_latched_ = false;
  request_once(Command::kEnable);
  return {};
}

void Drive::set_outputs(std::uint8_t flags) noexcept { frame_.in_out = flags; }

void Drive::set_gripper(const GripperSetPoint& set_point) noexcept {
  frame_.gripper = set_point;
  gripper_mode_ = set_point.mode;
}

Command Drive::due_command(Instant now) {
  if (is_latched_) return Command::kDisable;
  if (!one_shot_) return frame_.command;
  if (!one_shot_->deadline) one_shot_->deadline = now + kEchoTime;
  if (now < *one_shot_->deadline) return one_shot_->command;
  add_event(DriveEvent::Kind::kNoEffect, now, one_shot_->command);
  idle();
  return frame_.command;
}

CommandBytes Drive::tick(Instant now) {
  count_lost(now);
  const bool is_silent = statistics_.sent > 0 && now - last_telemetry_ > kSilence;
  if (is_silent && !is_silent_) add_event(DriveEvent::Kind::kLinkSilent, now, frame_.command);
  is_silent_ = is_silent;
  auto frame = frame_;
  frame.command = due_command(now);
  frame.gripper.mode = std::exchange(gripper_mode_, std::uint8_t{0});
  ++statistics_.sent;
  outstanding_.push_back(now);
  return encode(frame);
}

void Drive::receive(Instant now, Bytes bytes) {
  for_each_step(splitter_, bytes, [&](const Splitter::Step& step) {
    if (std::holds_alternative<Splitter::Fault>(step.found)) ++statistics_.bad;
    if (const auto frame = telemetry_of(step)) take(now, *frame);
  });
}

void Drive::take(Instant now, const TelemetryFrame& frame) {
  match_answer(now);
  if (std::exchange(is_silent_, false)) {
    idle();  // the board may have been switched off, or somebody stands beside the arm
    add_event(DriveEvent::Kind::kLinkBack, now, frame.echo);
  }
  check_estop(now, frame);
  check_one_shot(now, frame);
  check_homing(now, frame);
  check_motion(now, frame);
  telemetry_ = frame;
  last_telemetry_ = now;
}

/// Telemetry does not say which frame it answers. The newest one that is waiting is the likeliest;
/// what then stays behind is matched by a late answer or counted as lost.
void Drive::match_answer(Instant now) noexcept {
  if (outstanding_.empty()) {
    ++statistics_.surplus;
    return;
  }
  const auto round_trip = now - outstanding_.back();
  outstanding_.pop_back();
  ++statistics_.answered;
  statistics_.round_trip.record(round_trip);
  if (round_trip > period_) ++statistics_.late;
}

void Drive::count_lost(Instant now) noexcept {
  while (!outstanding_.empty() && now - outstanding_.front() > kPeriodsUntilLost * period_) {
    outstanding_.pop_front();
    ++statistics_.lost;
  }
}

void Drive::give_up_outstanding() noexcept {
  statistics_.lost += outstanding_.size();
  outstanding_.clear();
}

void Drive::check_estop(Instant now, const TelemetryFrame& frame) {
  const bool is_pressed = (frame.io & io_flag::kEstopReleased) == 0;
  if (is_pressed == std::exchange(is_estop_pressed_, is_pressed)) return;
  if (is_pressed) {
    is_latched_ = true;
    idle();
    add_event(DriveEvent::Kind::kEstopPressed, now, Command::kDisable);
  } else {
    add_event(DriveEvent::Kind::kEstopReleased, now, Command::kDisable);
  }
}

void Drive::check_one_shot(Instant now, const TelemetryFrame& frame) {
  if (!one_shot_ || !one_shot_->deadline || frame.echo != one_shot_->command) return;
  const auto command = one_shot_->command;
  one_shot_.reset();
  if (command == Command::kHome) {
    homing_ = Homing::kRuns;  // it has to show motion before it counts
  } else {
    add_event(DriveEvent::Kind::kTookEffect, now, command);
  }
}

void Drive::check_homing(Instant now, const TelemetryFrame& frame) {
  if (homing_ != Homing::kRuns) return;
  const bool is_homed = (frame.homed & kAllHomed) == kAllHomed;
  if (!is_homed && !has_seen_unhomed_) {
    has_seen_unhomed_ = true;
    return;
  }
  if (!is_homed || !has_seen_unhomed_) return;
  homing_ = Homing::kNo;
  add_event(DriveEvent::Kind::kHomed, now, Command::kHome);
}

void Drive::check_motion(Instant now, const TelemetryFrame& frame) {
  auto acted_on = frame_;
  if (is_latched_) {
    acted_on.command = Command::kDisable;
  } else if (homing_ != Homing::kNo) {
    acted_on.command = Command::kHome;
  } else if (one_shot_) {
    acted_on.command = one_shot_->command;
  }
  if (monitored_ != acted_on.command) monitor_.begin(now);
  monitored_ = acted_on.command;
  const auto findings = monitor_.observe(now, acted_on, frame);
  using Kind = DriveEvent::Kind;
  if (findings.started) add_event(Kind::kTookEffect, now, acted_on.command, findings.started);
  if (findings.stalled) {
    add_event(Kind::kNothingMoved, now, acted_on.command, findings.stalled);
    if (acted_on.command == Command::kHome) homing_ = Homing::kNo;
  }
  if (findings.still_moves) {
    add_event(Kind::kStillMoves, now, acted_on.command, findings.still_moves);
  }
}

void Drive::add_event(DriveEvent::Kind kind, Instant now, Command command,
                      std::optional<std::size_t> joint) {
  events_.push_back({kind, now, command, joint});
}

std::vector<DriveEvent> Drive::take_events() { return std::exchange(events_, {}); }

}  // namespace armjig::parol6::drive
