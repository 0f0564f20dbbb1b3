// SPDX-License-Identifier: Apache-2.0
#include "emulators/parol6/arm.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <variant>

namespace armjig::parol6::emulation {
namespace {

constexpr std::array kInputs{
    DeviceInput{"estop", "0 pressed, 1 released: the level of its input"},
    DeviceInput{"in1", "0 or 1: the level of input 1"},
    DeviceInput{"in2", "0 or 1: the level of input 2"},
    DeviceInput{"position.jN", "steps: puts the axis there, behind the board's back"},
    DeviceInput{"switch.jN", "its limit switch: 0 works, 1 stuck closed, 2 stuck open"},
    DeviceInput{"between-fingers", "where closing fingers meet something, 0 to 255; -1: nothing"},
    DeviceInput{"can.data",
                "eight bytes, the first one highest: the data of what `can.frame` sends"},
    DeviceInput{"can.frame", "16 times an identifier plus a count of bytes: the board gets it"},
    DeviceInput{"power", "any: off and on, board and gripper"},
};

constexpr std::string_view kPosition = "position.j";
constexpr std::string_view kSwitch = "switch.j";

/// The joint that a name like `switch.j1` ends with; none if it does not.
std::optional<std::size_t> joint_of(std::string_view name, std::string_view prefix) noexcept {
  if (!name.starts_with(prefix) || name.size() != prefix.size() + 1) return std::nullopt;
  const auto joint = static_cast<std::size_t>(name.back() - '1');
  return joint < kJointCount ? std::optional{joint} : std::nullopt;
}

/// What `can.frame` and `can.data` mean; none: there is no such frame.
std::optional<CanFrame> frame_of(std::int64_t value, std::uint64_t data) noexcept {
  constexpr std::int64_t kSizes = 16;
  constexpr std::int64_t kIdentifiers = 0x800;
  CanFrame frame;
  if (value < 0 || value >= kIdentifiers * kSizes) return std::nullopt;
  if (std::cmp_greater(value % kSizes, frame.data.size())) return std::nullopt;
  frame.id = static_cast<std::uint16_t>(value / kSizes);
  frame.size = static_cast<std::uint8_t>(value % kSizes);
  for (std::size_t i = 0; i < frame.size; ++i) {
    frame.data[i] = static_cast<std::byte>(data >> (56 - 8 * i) & 0xFFU);
  }
  return frame;
}

bool set_in_plant(Plant& plant, std::string_view name, std::int64_t value) noexcept {
  struct NamedInput {
    std::string_view name;
    Level Inputs::* level;
  };
  for (const auto& [input, level] :
       {NamedInput{"estop", &Inputs::estop}, {"in1", &Inputs::in1}, {"in2", &Inputs::in2}}) {
    if (name != input) continue;
    plant.inputs.*level = value != 0 ? Level::kHigh : Level::kLow;
    return true;
  }
  if (const auto joint = joint_of(name, kPosition)) {
    if (!std::in_range<std::int32_t>(value)) return false;
    plant.axes[*joint].position = Steps{static_cast<std::int32_t>(value)};
    return true;
  }
  if (const auto joint = joint_of(name, kSwitch)) {
    if (value < 0 || value > 2) return false;
    plant.axes[*joint].switch_state = Axis::SwitchState{static_cast<std::uint8_t>(value)};
    return true;
  }
  return false;
}

}  // namespace

std::span<const DeviceInput> arm_inputs() noexcept { return kInputs; }

Arm::Arm(const ArmOptions& options)
    : board_{options.plant, options.timing, options.profile, options.figures} {
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

bool Arm::set_input(Instant time, std::string_view name, std::int64_t value) {
  if (name == "power") {
    reboot(time);
    return true;
  }
  if (name == "between-fingers") {
    if (!gripper_ || value < -1 || value > UINT8_MAX) return false;
    auto fingers = gripper_->plant();
    fingers.stop_closing.reset();
    if (value >= 0) fingers.stop_closing = static_cast<std::uint8_t>(value);
    touch_gripper(time, fingers);
    return true;
  }
  if (name == "can.data") {
    can_data_ = static_cast<std::uint64_t>(value);
    return true;
  }
  if (name == "can.frame") {
    const auto frame = frame_of(value, can_data_);
    if (frame) receive_can(time, *frame);
    return frame.has_value();
  }
  auto plant = board_.plant();
  if (!set_in_plant(plant, name, value)) return false;
  touch(time, [&](Plant& touched) { (void)set_in_plant(touched, name, value); });
  return true;
}

void Arm::receive_can(Instant time, const CanFrame& frame) {
  advance_before(time);
  board_.receive_can(time, frame);
}

void Arm::reboot(Instant time) {
  advance_before(time);
  board_.reboot(time);
  if (gripper_) gripper_->reboot(time);
}

}  // namespace armjig::parol6::emulation
