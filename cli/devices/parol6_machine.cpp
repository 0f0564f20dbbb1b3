// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>

#include "cli/devices/machines.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6 {
namespace {

using namespace std::chrono_literals;
using campaign::AbstractLetter;
using campaign::Acts;
using mealy::Row;

constexpr StepsPerSecond kSpeed{1000};

void send(Acts& acts, const CommandFrame& frame) {
  acts.send(encode(frame));
  acts.wait(kFramePeriod);
}

/// Homing goes on and all else stands when a letter ends, and its answers tell whether.
void idle_at_the_end(Acts& acts) {
  send(acts, {.command = Command::kIdle});
  send(acts, {.command = Command::kIdle});
}

template <Command command>
void hold(Acts& acts) {
  send(acts, {.command = command});
  send(acts, {.command = command});
  idle_at_the_end(acts);
}
template <Command command>
constexpr AbstractLetter letter(std::string_view name) {
  return {name, hold<command>};
}

/// There and back.
void jog(Acts& acts) {
  for (const auto speed : {kSpeed, StepsPerSecond{-kSpeed.value}}) {
    send(acts, {.speed = {speed}, .command = Command::kJog});
  }
  idle_at_the_end(acts);
}

template <int level>
void set_stop(Acts& acts) {
  acts.set("estop", level);
  idle_at_the_end(acts);
}

void wait_for_homing(Acts& acts) {
  send(acts, {.command = Command::kIdle});
  acts.wait_until_quiet();
  idle_at_the_end(acts);
}

std::optional<TelemetryFrame> telemetry_in(const Message& message) {
  if (!message.fault.empty() || message.raw.size() != kTelemetryFrameSize) return std::nullopt;
  return decode_telemetry(body_of(std::span<const std::byte, kTelemetryFrameSize>{message.raw}));
}

/// More than the step that a pass may still do.
bool has_moved(const TelemetryFrame& before, const TelemetryFrame& after) {
  constexpr std::int32_t kStanding = 3;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (std::abs(after.position[i].value - before.position[i].value) > kStanding) return true;
  }
  return false;
}

std::string said_of_arm(std::span<const Message> messages) {
  constexpr std::uint8_t kSpare = 0x03;
  std::optional<TelemetryFrame> last;
  bool moves = false;
  for (const auto& message : messages) {
    const auto telemetry = telemetry_in(message);
    if (!telemetry) return "noise";
    moves = moves || (last && has_moved(*last, *telemetry));
    last = telemetry;
  }
  if (!last) return "";
  std::string said = moves ? "moves" : "stands";
  if (last->homed == 0xFF) said += ", homed";
  if (last->homed != 0xFF && last->homed != kSpare) said += ", partly homed";
  return said + ((last->io & io_flag::kEstopReleased) != 0 ? ", released" : ", pressed");
}

constexpr std::array kArmLetters{letter<Command::kEnable>("enable"),
                                 letter<Command::kDisable>("disable"),
                                 letter<Command::kClearError>("clear error"),
                                 letter<Command::kHome>("home"),
                                 AbstractLetter{"jog", jog},
                                 letter<Command::kIdle>("idle"),
                                 letter<Command{42}>("unknown"),
                                 AbstractLetter{"press stop", set_stop<0>},
                                 AbstractLetter{"release stop", set_stop<1>},
                                 AbstractLetter{"quiet", wait_for_homing}};

/// docs/spec/parol6.md, "Commands". A jog ends homing and keeps its stages, and idle sets all
/// speeds to 0: what homes again then seeks at no speed.
constexpr std::array kArmRows{
    Row{"enabled", "home", "moves", "homing"},
    Row{"enabled", "jog", "moves", ""},
    Row{"enabled", "disable", "stands", "disabled"},
    Row{"enabled", "", "stands", ""},
    Row{"homing", "enable", "stands", "enabled"},
    Row{"homing", "clear error", "stands", "enabled"},
    Row{"homing", "disable", "stands", "disabled"},
    Row{"homing", "jog", "moves", "interrupted"},
    Row{"homing", "quiet", "moves, homed", "homed"},
    Row{"homing", "", "moves", ""},
    Row{"homed", "home", "moves", "homing"},
    Row{"homed", "jog", "moves, homed", ""},
    Row{"homed", "disable", "stands, homed", "disabled, homed"},
    Row{"homed", "", "stands, homed", ""},
    Row{"disabled", "enable", "stands", "enabled"},
    Row{"disabled", "", "stands", ""},
    Row{"disabled, homed", "enable", "stands, homed", "homed"},
    Row{"disabled, homed", "", "stands, homed", ""},
    Row{"interrupted", "enable", "stands", "enabled"},
    Row{"interrupted", "clear error", "stands", "enabled"},
    Row{"interrupted", "disable", "stands", "disabled"},
    Row{"interrupted", "jog", "moves", ""},
    Row{"interrupted", "", "stands", ""},
};
constexpr std::array kStopRows{
    Row{"", "press stop", "pressed", "pressed"},
    Row{"", "release stop", "released", "released"},
    Row{"released", "", "released", ""},
    Row{"pressed", "", "pressed", ""},
};
constexpr std::array kArmTables{mealy::Table{"enabled", kArmRows},
                                mealy::Table{"released", kStopRows}};

// The gripper, through the board.

/// Set-points that are sent whatever was sent before.
constexpr std::uint8_t kAlwaysSent = 3;

constexpr CommandFrame gripper(std::uint8_t mode, std::uint8_t command, std::int16_t position) {
  return {.command = Command::kIdle,
          .gripper = {.position = position,
                      .speed = 100,
                      .current = Milliamperes{500},
                      .command = command,
                      .mode = mode}};
}

/// The polls that follow bring its status.
void ask(Acts& acts, CommandFrame frame) {
  send(acts, frame);
  frame.gripper.mode = gripper_mode::kMove;
  for (int i = 0; i < 2; ++i) send(acts, frame);
}

template <std::uint8_t command, std::int16_t position>
void set(Acts& acts) {
  ask(acts, gripper(kAlwaysSent, command, position));
}
template <std::uint8_t mode>
void order(Acts& acts) {
  ask(acts, gripper(mode, 0, 0));
}
void wait_for_gripper(Acts& acts) {
  acts.wait_until_quiet();
  set<gripper_command::kActivate, 0>(acts);
}

constexpr std::uint8_t kGo = gripper_command::kActivate | gripper_command::kGoTo;
constexpr std::int16_t kClosed = 255;

constexpr std::array kGripperLetters{
    AbstractLetter{"activate", set<gripper_command::kActivate, 0>},
    AbstractLetter{"open", set<kGo, 0>},
    AbstractLetter{"close", set<kGo, kClosed>},
    AbstractLetter{"stop", set<gripper_command::kActivate | gripper_command::kEstop, 0>},
    AbstractLetter{"calibrate", order<gripper_mode::kCalibrate>},
    AbstractLetter{"clear error", order<gripper_mode::kClearError>},
    AbstractLetter{"quiet", wait_for_gripper}};

std::string said_of_gripper(std::span<const Message> messages) {
  const auto last = messages.empty() ? std::nullopt : telemetry_in(messages.back());
  if (!last) return messages.empty() ? "" : "noise";
  std::string said =
      (last->gripper.status & gripper_status::kCalibrated) != 0 ? "calibrated" : "not calibrated";
  if ((last->gripper.status & gripper_status::kEstopError) != 0) said += ", error";
  return said;
}

/// docs/spec/parol6.md, "Gripper". After `quiet` the gripper is activated, so nothing asks for a
/// stop.
constexpr std::array kGripperRows{
    Row{"new", "calibrate", "not calibrated", "calibrating"},
    Row{"new", "stop", "not calibrated, error", "new, stopped"},
    Row{"new", "", "not calibrated", ""},
    Row{"calibrating", "clear error", "not calibrated", "new"},
    Row{"calibrating", "stop", "not calibrated, error", "new, stopped"},
    Row{"calibrating", "quiet", "calibrated", "ready"},
    Row{"calibrating", "", "not calibrated", ""},
    Row{"ready", "calibrate", "not calibrated", "calibrating"},
    Row{"ready", "stop", "calibrated, error", "ready, stopped"},
    Row{"ready", "", "calibrated", ""},
    Row{"new, stopped", "stop", "not calibrated, error", ""},
    Row{"new, stopped", "calibrate", "not calibrated, error", ""},
    Row{"new, stopped", "clear error", "not calibrated, error", ""},
    Row{"new, stopped", "", "not calibrated, error", "new, error"},
    Row{"new, error", "stop", "not calibrated, error", "new, stopped"},
    Row{"new, error", "clear error", "not calibrated", "new"},
    Row{"new, error", "", "not calibrated, error", ""},
    Row{"ready, stopped", "stop", "calibrated, error", ""},
    Row{"ready, stopped", "calibrate", "calibrated, error", ""},
    Row{"ready, stopped", "clear error", "calibrated, error", ""},
    Row{"ready, stopped", "", "calibrated, error", "ready, error"},
    Row{"ready, error", "stop", "calibrated, error", "ready, stopped"},
    Row{"ready, error", "clear error", "calibrated", "ready"},
    Row{"ready, error", "", "calibrated, error", ""},
};
constexpr std::array kGripperTables{mealy::Table{"new", kGripperRows}};

}  // namespace

std::span<const campaign::Learnable> machines() {
  static const std::array kMachines{
      campaign::Learnable{.name = "arm",
                          .letters = kArmLetters,
                          .said = said_of_arm,
                          .quiet = 45s,
                          .documented = kArmTables,
                          .source = "docs/spec/parol6.md, Commands, Homing, Inputs"},
      campaign::Learnable{.name = "gripper",
                          .letters = kGripperLetters,
                          .said = said_of_gripper,
                          .quiet = 10s,
                          .documented = kGripperTables,
                          .source = "docs/spec/parol6.md, Gripper"}};
  return kMachines;
}

}  // namespace armjig::parol6
