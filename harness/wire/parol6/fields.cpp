// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/fields.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace armjig::parol6 {
namespace {

using enum Encoding;
using BitNames = std::array<std::string_view, 8>;

constexpr BitNames kJointBits{"j1", "j2", "j3", "j4", "j5", "j6", "", ""};
constexpr BitNames kInOutBits{"", "", "out1", "out2", "", "", "", ""};
constexpr BitNames kIoBits{"in1", "in2", "out1", "out2", "estop_released", "", "", ""};
constexpr BitNames kGripperCommandBits{"activate", "go_to", "estop", "release_direction",
                                       "",         "",      "",      ""};
constexpr BitNames kGripperStatusBits{"activated",  "go_to",         "object_bit0", "object_bit1",
                                      "temp_error", "timeout_error", "estop_error", "calibrated"};

consteval NamedValue named(Command command, std::string_view name) noexcept {
  return {static_cast<std::int64_t>(command), name};
}
constexpr std::array kCommands{named(Command::kDemo, "demo"),
                               named(Command::kHome, "home"),
                               named(Command::kEnable, "enable"),
                               named(Command::kDisable, "disable"),
                               named(Command::kClearError, "clear_error"),
                               named(Command::kJog, "jog"),
                               named(Command::kGoTo, "go_to"),
                               named(Command::kIdle, "idle")};
constexpr std::array kGripperModes{NamedValue{gripper_mode::kMove, "move"},
                                   NamedValue{gripper_mode::kCalibrate, "calibrate"},
                                   NamedValue{gripper_mode::kClearError, "clear_error"}};

consteval Field literal(std::string_view name, std::uint16_t offset, std::uint8_t width,
                        std::int64_t value) noexcept {
  return {name, offset, width, kLiteral, "", "the same in every frame", {}, {}, value};
}

constexpr std::array kCommandFields{
    literal("start", 0, 3, 0xFFFFFF),
    literal("length", 3, 1, kCommandPayloadSize),
    Field{"position.j1", 4, 3, kSigned, "steps", "commanded position, used by go_to"},
    Field{"position.j2", 7, 3, kSigned, "steps", "commanded position, used by go_to"},
    Field{"position.j3", 10, 3, kSigned, "steps", "commanded position, used by go_to"},
    Field{"position.j4", 13, 3, kSigned, "steps", "commanded position, used by go_to"},
    Field{"position.j5", 16, 3, kSigned, "steps", "commanded position, used by go_to"},
    Field{"position.j6", 19, 3, kSigned, "steps", "commanded position, used by go_to"},
    Field{"speed.j1", 22, 3, kSigned, "steps/s", "commanded speed, used by jog, go_to, idle"},
    Field{"speed.j2", 25, 3, kSigned, "steps/s", "commanded speed, used by jog, go_to, idle"},
    Field{"speed.j3", 28, 3, kSigned, "steps/s", "commanded speed, used by jog, go_to, idle"},
    Field{"speed.j4", 31, 3, kSigned, "steps/s", "commanded speed, used by jog, go_to, idle"},
    Field{"speed.j5", 34, 3, kSigned, "steps/s", "commanded speed, used by jog, go_to, idle"},
    Field{"speed.j6", 37, 3, kSigned, "steps/s", "commanded speed, used by jog, go_to, idle"},
    Field{"command", 40, 1, kCode, "", "what the board does from the next pass on", {}, kCommands},
    Field{"affected_joints", 41, 1, kBits, "", "joints meant by the command", kJointBits},
    Field{"in_out", 42, 1, kBits, "", "output levels", kInOutBits},
    Field{"timeout", 43, 1, kUnsigned, "ms", "longest allowed silence, 0 off"},
    Field{"gripper.position", 44, 2, kSigned, "", "0 open to 255 closed"},
    Field{"gripper.speed", 46, 2, kSigned, "", "0 to 255"},
    Field{"gripper.current", 48, 2, kSigned, "mA", "current limit"},
    Field{"gripper.command", 50, 1, kBits, "", "what the gripper does", kGripperCommandBits},
    Field{"gripper.mode", 51, 1, kCode, "", "which CAN message is sent", {}, kGripperModes},
    Field{"gripper.id", 52, 1, kUnsigned, "", "CAN node"},
    Field{"check", 53, 1, kUnsigned, "", "constant 212 or 228; no polynomial"},
    literal("end", 54, 2, 0x0102),
};

constexpr std::array kTelemetryFields{
    literal("start", 0, 3, 0xFFFFFF),
    literal("length", 3, 1, kTelemetryPayloadSize),
    Field{"position.j1", 4, 3, kSigned, "steps", "step counter"},
    Field{"position.j2", 7, 3, kSigned, "steps", "step counter"},
    Field{"position.j3", 10, 3, kSigned, "steps", "step counter"},
    Field{"position.j4", 13, 3, kSigned, "steps", "step counter"},
    Field{"position.j5", 16, 3, kSigned, "steps", "step counter"},
    Field{"position.j6", 19, 3, kSigned, "steps", "step counter"},
    Field{"speed.j1", 22, 3, kSigned, "steps/s", "set speed, not a measured one"},
    Field{"speed.j2", 25, 3, kSigned, "steps/s", "set speed, not a measured one"},
    Field{"speed.j3", 28, 3, kSigned, "steps/s", "set speed, not a measured one"},
    Field{"speed.j4", 31, 3, kSigned, "steps/s", "set speed, not a measured one"},
    Field{"speed.j5", 34, 3, kSigned, "steps/s", "set speed, not a measured one"},
    Field{"speed.j6", 37, 3, kSigned, "steps/s", "set speed, not a measured one"},
    Field{"homed", 40, 1, kBits, "", "joints that know their zero", kJointBits},
    Field{"io", 41, 1, kBits, "", "pin levels", kIoBits},
    Field{"temperature_error", 42, 1, kBits, "", "joints too hot", kJointBits},
    Field{"position_error", 43, 1, kBits, "", "joints outside their range", kJointBits},
    Field{"timing", 44, 2, kUnsigned, "ticks", "since the frame before, 703125 Hz, modulo 65536"},
    Field{"timeout_error", 46, 1, kUnsigned, "", "the shipped board sends 100"},
    Field{"echo", 47, 1, kCode, "", "command of the frame being answered", {}, kCommands},
    Field{"gripper.id", 48, 1, kUnsigned, "", "CAN node; the shipped board sends 0"},
    Field{"gripper.position", 49, 2, kSigned, "", "0 open to 255 closed"},
    Field{"gripper.speed", 51, 2, kSigned, "", "the shipped board sends 1"},
    Field{"gripper.current", 53, 2, kSigned, "mA", "motor current"},
    Field{"gripper.status", 55, 1, kBits, "", "status of the gripper", kGripperStatusBits},
    Field{"gripper.object", 56, 1, kUnsigned, "", "the shipped board sends 1"},
    Field{"check", 57, 1, kUnsigned, "", "constant 212"},
    literal("end", 58, 2, 0x0102),
};

}  // namespace

std::span<const Field> command_fields() noexcept { return kCommandFields; }
std::span<const Field> telemetry_fields() noexcept { return kTelemetryFields; }

std::string name_of(Command command) {
  const auto code = static_cast<std::int64_t>(command);
  const auto* const found = std::ranges::find(kCommands, code, &NamedValue::value);
  return found == std::end(kCommands) ? std::to_string(code) : std::string{found->name};
}

}  // namespace armjig::parol6
