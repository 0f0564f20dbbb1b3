// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/morap/message.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace armjig::morap {
namespace {

using enum CommandId;

constexpr std::array kCommands{
    CommandInfo{kDisable, "disable", Payload::kNone, "", "stop driving", true},
    CommandInfo{kPosition, "position", Payload::kFloat, "rad", "go to this angle", true},
    CommandInfo{kSpeed, "speed", Payload::kFloat, "rad/s", "turn at this speed", true},
    CommandInfo{kVoltage, "voltage", Payload::kFloat, "V", "drive, current limited", true},
    CommandInfo{kDirectVoltage, "direct_voltage", Payload::kFloat, "V", "drive, no current limit",
                false},
    CommandInfo{kTorque, "torque", Payload::kFloat, "N m", "at the output shaft", false},
    CommandInfo{kTrajectory, "trajectory", Payload::kNone, "", "does nothing", false},
    CommandInfo{kBrake14, "brake_14", Payload::kNone, "", "brake; the sources disagree", true},
    CommandInfo{kBrake15, "brake_15", Payload::kNone, "", "brake; the sources disagree", true},
    CommandInfo{kCalibrateZero, "calibrate_zero", Payload::kNone, "", "the shaft is at 0", true},
    CommandInfo{kCalibrateAngle, "calibrate_angle", Payload::kFloat, "rad", "the shaft is there",
                true},
    CommandInfo{kCalibrationUnknown, "calibration_unknown", Payload::kNone, "",
                "forget the calibration and disable", true},
    CommandInfo{kProgram, "program", Payload::kControllerSet, "", "parameters of a controller",
                true},
    CommandInfo{kDefaultControllers, "default_controllers", Payload::kNone, "",
                "load the stored parameters", true},
    CommandInfo{kTune, "tune", Payload::kTuneRequest, "", "compute parameters", true},
    CommandInfo{kLedOn, "led_on", Payload::kNone, "", "does nothing", false},
    CommandInfo{kLedOff, "led_off", Payload::kNone, "", "does nothing", false},
    CommandInfo{kLedToggle, "led_toggle", Payload::kNone, "", "does nothing", false},
};

constexpr std::array kReadings{
    ReadInfo{kReadAngle, "angle", ReadKind::kFloat, "rad", "of the output shaft", true},
    ReadInfo{kReadPositionReference, "position_reference", ReadKind::kFloat, "rad",
             "as last written", true},
    ReadInfo{kReadSpeedReference, "speed_reference", ReadKind::kFloat, "rad/s", "as last written",
             true},
    ReadInfo{kReadMotorStatus, "motor_status", ReadKind::kByte, "", "", true},
    ReadInfo{kReadProgrammingStatus, "programming_status", ReadKind::kByte, "", "", true},
    ReadInfo{kReadVoltage, "applied_voltage", ReadKind::kFloat, "V", "after all limits", true},
    ReadInfo{kReadCurrent, "current", ReadKind::kFloat, "A", "magnitude", true},
    ReadInfo{kReadAddress, "own_address", ReadKind::kByte, "", "seven bits", true},
    ReadInfo{kReadPositionSet, "position_set", ReadKind::kControllerSet, "", "active", false},
    ReadInfo{kReadSpeedSet, "speed_set", ReadKind::kControllerSet, "", "active", false},
};

template <auto key, class Table>
auto find_in(const Table& table, CommandId id) noexcept {
  const auto found = std::ranges::find(table, id, key);
  return found == table.end() ? nullptr : &*found;
}

/// A float command, or too few bytes for one.
std::variant<DecodedCommand, CommandFault> decode_float_command(Bytes data) noexcept {
  if (data.size() < kFloatCommandSize) return CommandFault{CommandFault::Kind::kTooShort};
  const CommandId id{std::to_integer<std::uint8_t>(data[0])};
  return DecodedCommand{{id, load_f32_le(slice<4>(data, 1))}, kFloatCommandSize};
}

std::variant<DecodedCommand, CommandFault> decode_program(Bytes data) noexcept {
  const auto decoded = decode_set(data.subspan(1));
  if (const auto* set = std::get_if<ControllerSet>(&decoded)) {
    return DecodedCommand{{kProgram, *set}, 1 + wire_size(*set)};
  }
  const auto fault = std::get<SetFault>(decoded);
  const bool is_short = fault.kind == SetFault::Kind::kTooShort;
  return CommandFault{is_short ? CommandFault::Kind::kTooShort : CommandFault::Kind::kBadSet,
                      fault};
}

std::variant<DecodedCommand, CommandFault> decode_tune(Bytes data) noexcept {
  if (data.size() < kTuneCommandSize) return CommandFault{CommandFault::Kind::kTooShort};
  const TuneRequest request{TuneKind{std::to_integer<std::uint8_t>(data[1])},
                            load_f32_le(slice<4>(data, 2)), load_f32_le(slice<4>(data, 6))};
  return DecodedCommand{{kTune, request}, kTuneCommandSize};
}

/// Appends what follows the identifier.
struct PayloadWriter {
  WriteBytes& out;

  void operator()(std::monostate /*none*/) const noexcept {}
  void operator()(float value) const noexcept { store_f32_le(out.extend<4>(), value); }
  void operator()(const ControllerSet& set) const noexcept {
    const auto bytes = encode(set);
    std::ranges::copy(bytes.view(), out.extend(bytes.size()).begin());
  }
  void operator()(const TuneRequest& request) const noexcept {
    out.push_back(static_cast<std::byte>(request.kind));
    store_f32_le(out.extend<4>(), request.inertia);
    store_f32_le(out.extend<4>(), request.pole);
  }
};

}  // namespace

std::span<const CommandInfo> commands() noexcept { return kCommands; }
std::span<const ReadInfo> readings() noexcept { return kReadings; }

const CommandInfo* find_command(CommandId id) noexcept {
  return find_in<&CommandInfo::id>(kCommands, id);
}
const ReadInfo* find_reading(CommandId selector) noexcept {
  return find_in<&ReadInfo::selector>(kReadings, selector);
}

WriteBytes encode(const Command& command) noexcept {
  WriteBytes out;
  out.push_back(static_cast<std::byte>(command.id));
  std::visit(PayloadWriter{out}, command.payload);
  return out;
}

std::variant<DecodedCommand, CommandFault> decode_command(Bytes data) noexcept {
  if (data.empty()) return CommandFault{CommandFault::Kind::kEmpty};
  const CommandId id{std::to_integer<std::uint8_t>(data[0])};
  if (find_reading(id) != nullptr) return DecodedCommand{{id, {}}, 1};
  const auto* info = find_command(id);
  if (info == nullptr) return CommandFault{CommandFault::Kind::kUnknownId};
  switch (info->payload) {
    case Payload::kFloat:
      return decode_float_command(data);
    case Payload::kControllerSet:
      return decode_program(data);
    case Payload::kTuneRequest:
      return decode_tune(data);
    case Payload::kNone:
      break;
  }
  return DecodedCommand{{id, {}}, 1};
}

FloatBytes encode(float value) noexcept {
  FloatBytes bytes{};
  store_f32_le(bytes, value);
  return bytes;
}

}  // namespace armjig::morap
