// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/morap/message.hpp"

#include <algorithm>
#include <optional>

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

/// Called as it is chosen, without the word in front.
consteval ReadInfo reading(CommandId selector, std::string_view name, ReadKind kind,
                           std::string_view unit, std::string_view meaning,
                           bool is_documented = true) {
  return {selector, name, name.substr(name.find('_') + 1), kind, unit, meaning, is_documented};
}

constexpr std::array kReadings{
    reading(kReadAngle, "read_angle", ReadKind::kFloat, "rad", "of the output shaft"),
    reading(kReadPositionReference, "read_position_reference", ReadKind::kFloat, "rad",
            "as last written"),
    reading(kReadSpeedReference, "read_speed_reference", ReadKind::kFloat, "rad/s",
            "as last written"),
    reading(kReadMotorStatus, "read_motor_status", ReadKind::kByte, "", ""),
    reading(kReadProgrammingStatus, "read_programming_status", ReadKind::kByte, "", ""),
    reading(kReadVoltage, "read_applied_voltage", ReadKind::kFloat, "V", "after all limits"),
    reading(kReadCurrent, "read_current", ReadKind::kFloat, "A", "magnitude"),
    reading(kReadAddress, "read_own_address", ReadKind::kByte, "", "seven bits"),
    reading(kReadPositionSet, "read_position_set", ReadKind::kControllerSet, "", "active", false),
    reading(kReadSpeedSet, "read_speed_set", ReadKind::kControllerSet, "", "active", false),
};

constexpr std::uint8_t kNowhere = 0xFF;

/// Where in a table the row of each identifier is.
template <class Table>
consteval auto places_in(const Table& table, auto key) {
  std::array<std::uint8_t, 256> places{};
  places.fill(kNowhere);
  for (std::uint8_t i = 0; i < table.size(); ++i) {
    places[static_cast<std::uint8_t>(table[i].*key)] = i;
  }
  return places;
}
constexpr auto kCommandPlaces = places_in(kCommands, &CommandInfo::id);
constexpr auto kReadingPlaces = places_in(kReadings, &ReadInfo::selector);

/// Each of these reads what follows the identifier of `data`; nullopt if there is no fault.
std::optional<CommandFault> take_float(Bytes data, DecodedCommand& out) noexcept {
  if (data.size() < kFloatCommandSize) return CommandFault{CommandFault::Kind::kTooShort};
  out.command.payload = load_f32_le(slice<4>(data, 1));
  out.size = kFloatCommandSize;
  return std::nullopt;
}

std::optional<CommandFault> take_set(Bytes data, DecodedCommand& out) noexcept {
  auto& set = out.command.payload.emplace<ControllerSet>();
  const auto fault = decode_into(set, data.subspan(1));
  out.size = 1 + wire_size(set);
  if (!fault) return std::nullopt;
  const bool is_short = fault->kind == SetFault::Kind::kTooShort;
  return CommandFault{is_short ? CommandFault::Kind::kTooShort : CommandFault::Kind::kBadSet,
                      *fault};
}

std::optional<CommandFault> take_tuning(Bytes data, DecodedCommand& out) noexcept {
  if (data.size() < kTuneCommandSize) return CommandFault{CommandFault::Kind::kTooShort};
  out.command.payload = TuneRequest{TuneKind{std::to_integer<std::uint8_t>(data[1])},
                                    load_f32_le(slice<4>(data, 2)), load_f32_le(slice<4>(data, 6))};
  out.size = kTuneCommandSize;
  return std::nullopt;
}

std::optional<CommandFault> take_command(Bytes data, DecodedCommand& out) noexcept {
  if (data.empty()) return CommandFault{CommandFault::Kind::kEmpty};
  out.command.id = CommandId{std::to_integer<std::uint8_t>(data[0])};
  out.size = 1;
  const auto* info = find_command(out.command.id);
  if (info == nullptr) {
    if (find_reading(out.command.id) != nullptr) return std::nullopt;
    return CommandFault{CommandFault::Kind::kUnknownId};
  }
  switch (info->payload) {
    case Payload::kFloat:
      return take_float(data, out);
    case Payload::kControllerSet:
      return take_set(data, out);
    case Payload::kTuneRequest:
      return take_tuning(data, out);
    case Payload::kNone:
      break;
  }
  return std::nullopt;
}

/// Appends what follows the identifier.
struct PayloadWriter {
  WriteBytes& out;

  void operator()(std::monostate /*none*/) const noexcept {}
  void operator()(float value) const noexcept { store_f32_le(out.extend<4>(), value); }
  void operator()(const ControllerSet& set) const noexcept {
    encode_into(out.extend(wire_size(set)), set);
  }
  void operator()(const TuneRequest& request) const noexcept {
    out.push_back(static_cast<std::byte>(request.kind));
    store_f32_le(out.extend<4>(), request.inertia);
    store_f32_le(out.extend<4>(), request.pole);
  }
};

}  // namespace

constinit const std::array<NamedValue, kIdentifierCount> kIdentifierNames = [] {
  std::array<NamedValue, kIdentifierCount> names{};
  auto out = names.begin();
  for (const auto& info : kCommands) *out++ = {static_cast<std::int64_t>(info.id), info.name};
  for (const auto& info : kReadings) {
    *out++ = {static_cast<std::int64_t>(info.selector), info.selector_name};
  }
  std::ranges::sort(names, {}, &NamedValue::value);
  return names;
}();

std::span<const CommandInfo> commands() noexcept { return kCommands; }
std::span<const ReadInfo> readings() noexcept { return kReadings; }

const CommandInfo* find_command(CommandId id) noexcept {
  const auto place = kCommandPlaces[static_cast<std::uint8_t>(id)];
  return place == kNowhere ? nullptr : &kCommands[place];
}
const ReadInfo* find_reading(CommandId selector) noexcept {
  const auto place = kReadingPlaces[static_cast<std::uint8_t>(selector)];
  return place == kNowhere ? nullptr : &kReadings[place];
}

WriteBytes encode(const Command& command) noexcept {
  WriteBytes out;
  out.push_back(static_cast<std::byte>(command.id));
  std::visit(PayloadWriter{out}, command.payload);
  return out;
}

std::variant<DecodedCommand, CommandFault> decode_command(Bytes data) noexcept {
  std::variant<DecodedCommand, CommandFault> result;
  const auto fault = take_command(data, *std::get_if<DecodedCommand>(&result));
  if (fault) result = *fault;
  return result;
}

FloatBytes encode(float value) noexcept {
  FloatBytes bytes{};
  store_f32_le(bytes, value);
  return bytes;
}

}  // namespace armjig::morap
