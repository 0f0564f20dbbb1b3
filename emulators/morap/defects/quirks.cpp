// SPDX-License-Identifier: Apache-2.0
#include "emulators/morap/defects/quirks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "emulators/morap/defects/quirk_words.hpp"

namespace armjig::morap::emulation {
namespace {

using namespace std::chrono_literals;
using enum CommandId;

// Commands that are taken for others.
template <CommandId id, CommandId other>
constexpr Change kTaken = [](Words& command, QuirkMemory&, const Node&) {
  if (is(command, id)) become(command, other);
};
template <CommandId other>
constexpr Change kUnknownTaken = [](Words& command, QuirkMemory&, const Node&) {
  if (!is_known(id_of(command))) become(command, other);
};
constexpr Change kSixBitIds = [](Words& command, QuirkMemory&, const Node&) {
  const auto id = std::to_integer<unsigned>(command[0]);
  if (id >= 64 && id < 128) command[0] = static_cast<std::byte>(id & 0x1FU);
};

// Calibration. A count of the usual motor is 5.3e-5 rad.
constexpr float kCount = 5.3078216e-5F;
constexpr Change kRounds = [](Words& command, QuirkMemory&, const Node&) {
  if (!is(command, kCalibrateAngle)) return;
  const auto angle = float_at(command, 1);
  set_float(command, 1, angle + std::copysign(kCount / 2, angle));
};
constexpr Change kFloors = [](Words& command, QuirkMemory&, const Node&) {
  if (!is(command, kCalibrateAngle)) return;
  const auto angle = float_at(command, 1);
  if (angle < 0) set_float(command, 1, angle - kCount);
};
constexpr Change kNotesForgetting = [](Words& command, QuirkMemory& memory, const Node&) {
  if (is(command, kCalibrationUnknown)) memory.count = 1;
  if (is(command, kCalibrateZero) || is(command, kCalibrateAngle)) memory.count = 0;
};
constexpr Change kForgottenAngle = [](Words& answer, QuirkMemory& memory, const Node& node) {
  if (node.selected() == kReadAngle && memory.count == 1) answer.assign(4, {});
};
constexpr Change kUncalibratedAngle = [](Words& answer, QuirkMemory&, const Node& node) {
  const bool knows = node.status() != MotorStatus::kNeedsCalibration;
  if (node.selected() == kReadAngle && !knows) answer.assign(4, {});
};

// References.
template <CommandId forgetting>
constexpr Change kNotes = [](Words& command, QuirkMemory& memory, const Node&) {
  if (is(command, forgetting)) memory.count = 1;
  if (is(command, kPosition) || is(command, kSpeed)) memory.count = 0;
};
constexpr Change kForgottenReference = [](Words& answer, QuirkMemory& memory, const Node& node) {
  const bool is_reference =
      node.selected() == kReadPositionReference || node.selected() == kReadSpeedReference;
  if (is_reference && memory.count == 1) answer.assign(4, {});
};
constexpr Change kNotesReference = [](Words& command, QuirkMemory& memory, const Node&) {
  if (is(command, kPosition) || is(command, kSpeed)) memory.bytes = command;
};
constexpr Change kOneReference = [](Words& answer, QuirkMemory& memory, const Node& node) {
  const bool is_reference =
      node.selected() == kReadPositionReference || node.selected() == kReadSpeedReference;
  if (!is_reference || memory.bytes.empty()) return;
  answer.assign(memory.bytes.begin() + 1, memory.bytes.end());
};
constexpr Change kBoundsReference = [](Words& command, QuirkMemory&, const Node&) {
  if (!is(command, kPosition)) return;
  const auto value = float_at(command, 1);
  if (!(std::fabs(value) <= 100.0F)) set_float(command, 1, 100.0F);
};
constexpr Change kQuietsNan = [](Words& command, QuirkMemory&, const Node&) {
  if (!has_number(id_of(command)) || !std::isnan(float_at(command, 1))) return;
  command[3] |= std::byte{0x40};
};
constexpr Change kRefusesUncalibrated = [](Words& command, QuirkMemory&, const Node& node) {
  if (is_reference(id_of(command)) && node.status() == MotorStatus::kNeedsCalibration)
    command.clear();
};

// Answers.
template <CommandId selected>
constexpr Change kSigned = [](Words& answer, QuirkMemory&, const Node& node) {
  if (node.selected() == selected && float_at(answer, 0) != 0.0F) answer[3] ^= std::byte{0x80};
};
constexpr Change kNotesVoltage = [](Words& command, QuirkMemory& memory, const Node&) {
  if (is(command, kVoltage) || is(command, kDirectVoltage)) memory.bytes = command;
};
constexpr Change kSaysRequest = [](Words& answer, QuirkMemory& memory, const Node& node) {
  const bool is_on = node.status() == MotorStatus::kEnabled && !memory.bytes.empty();
  if (node.selected() != kReadVoltage || !is_on) return;
  answer.assign(memory.bytes.begin() + 1, memory.bytes.end());
};
constexpr Change kCoarseVoltage = [](Words& answer, QuirkMemory&, const Node& node) {
  if (node.selected() != kReadVoltage) return;
  constexpr float kStep = 0.09375F;  // half the resolution, as an older firmware had it
  set_float(answer, 0, std::trunc(float_at(answer, 0) / kStep) * kStep);
};
constexpr Change kShiftedAddress = [](Words& answer, QuirkMemory&, const Node& node) {
  if (node.selected() == kReadAddress) answer[0] <<= 1;
};
constexpr Change kNodeForAddress = [](Words& answer, QuirkMemory&, const Node& node) {
  if (node.selected() == kReadAddress) answer[0] &= std::byte{0x07};
};
constexpr Change kStatusExchanged = [](Words& answer, QuirkMemory&, const Node& node) {
  if (node.selected() == kReadMotorStatus && answer[0] != std::byte{3}) answer[0] ^= std::byte{3};
};
constexpr Change kFilledWithOnes = [](Words& answer, QuirkMemory&, const Node& node) {
  if (answers_set(node)) answer.resize(256, std::byte{0xFF});
};
constexpr Change kEndsByteEarly = [](Words& answer, QuirkMemory&, const Node& node) {
  if (answers_set(node)) answer.pop_back();
};
constexpr Change kByteOnce = [](Words& answer, QuirkMemory& memory, const Node& node) {
  const auto* reading = find_reading(node.selected());
  if (reading->kind == ReadKind::kByte && memory.count++ > 0) answer[0] = std::byte{0};
};
constexpr Change kNotesSelection = [](Words& command, QuirkMemory& memory, const Node&) {
  if (find_reading(id_of(command)) != nullptr) memory.count = 0;
};
constexpr Change kModeForOneRead = [](Words& answer, QuirkMemory& memory, const Node&) {
  if (memory.count++ > 0) std::ranges::fill(answer, std::byte{});
};

// The bus.
constexpr auto kAnyNode = [](std::uint8_t address, const Node&) {
  return (address & 0x78) == 0x10;
};
constexpr auto kGeneralCall = [](std::uint8_t address, const Node& node) {
  return address == 0 || node.acknowledges(address);
};
constexpr auto kReserved = [](std::uint8_t address, const Node& node) {
  return address >= 0x78 || node.acknowledges(address);
};
constexpr auto kSixBitAddress = [](std::uint8_t address, const Node& node) {
  return (address & 0x3F) == node.address();
};
constexpr auto kNacksUnknown = [](Bytes written, const Node&) {
  return !is_known(CommandId{std::to_integer<std::uint8_t>(written[0])});
};
constexpr auto kNacksSurplus = [](Bytes written, const Node&) {
  const auto decoded = decode_command(written);
  const auto* command = std::get_if<DecodedCommand>(&decoded);
  return command != nullptr && written.size() > command->size;
};
template <std::size_t byte>
constexpr auto kNacksByte = [](Bytes written, const Node&) { return written.size() == byte; };
constexpr auto kNacksBrake = [](Bytes written, const Node&) {
  return written[0] == std::byte{14} || written[0] == std::byte{15};
};
constexpr auto kNacksRefused = [](Bytes written, const Node&) {
  const auto decoded = decode_command(written);
  const auto* fault = std::get_if<CommandFault>(&decoded);
  return fault != nullptr && fault->kind == CommandFault::Kind::kBadSet;
};
constexpr auto kHoldsLong = [](Bytes written, bool is_read) -> Duration {
  return !is_read && written.size() == kTuneCommandSize ? 20ms : 0ms;
};
constexpr auto kHoldsAddress = [](Bytes written, bool is_read) -> Duration {
  return is_read && written.empty() ? 8ms : 0ms;
};

constexpr auto kQuirks = std::to_array<Quirk>({
    {.name = "six-bit-ids", .section = "Commands", .hear = kSixBitIds},
    {.name = "unknown-forgets", .section = "Commands", .hear = kUnknownTaken<kCalibrationUnknown>},
    {.name = "unknown-selects", .section = "Reading", .hear = kUnknownTaken<kReadAngle>},
    {.name = "trajectory-disables", .section = "Commands", .hear = kTaken<kTrajectory, kDisable>},
    {.name = "led-on-forgets", .section = "Commands", .hear = kTaken<kLedOn, kCalibrationUnknown>},
    {.name = "led-off-forgets",
     .section = "Commands",
     .hear = kTaken<kLedOff, kCalibrationUnknown>},
    {.name = "led-toggle-forgets",
     .section = "Commands",
     .hear = kTaken<kLedToggle, kCalibrationUnknown>},
    {.name = "brake-14-disables", .section = "Commands", .hear = kTaken<kBrake14, kDisable>},
    {.name = "brake-15-disables", .section = "Commands", .hear = kTaken<kBrake15, kDisable>},
    {.name = "brake-14-selects", .section = "Reading", .hear = kTaken<kBrake14, kReadAngle>},
    {.name = "brake-15-forgets",
     .section = "Commands",
     .hear = kTaken<kBrake15, kCalibrationUnknown>},
    {.name = "disable-forgets", .section = "Status", .hear = kTaken<kDisable, kCalibrationUnknown>},
    {.name = "forgetting-disables",
     .section = "Status",
     .hear = kTaken<kCalibrationUnknown, kDisable>},
    {.name = "calibration-rounds", .section = "Calibration", .hear = kRounds},
    {.name = "calibration-floors", .section = "Calibration", .hear = kFloors},
    {.name = "forgetting-clears-angle",
     .section = "Calibration",
     .hear = kNotesForgetting,
     .say = kForgottenAngle},
    {.name = "no-uncalibrated-angle", .section = "Calibration", .say = kUncalibratedAngle},
    {.name = "disabling-clears-references",
     .section = "References",
     .hear = kNotes<kDisable>,
     .say = kForgottenReference},
    {.name = "forgetting-clears-references",
     .section = "References",
     .hear = kNotes<kCalibrationUnknown>,
     .say = kForgottenReference},
    {.name = "calibrating-clears-references",
     .section = "References",
     .hear = kNotes<kCalibrateZero>,
     .say = kForgottenReference},
    {.name = "one-reference",
     .section = "References",
     .hear = kNotesReference,
     .say = kOneReference},
    {.name = "bounded-reference", .section = "References", .hear = kBoundsReference},
    {.name = "quiet-nan", .section = "References", .hear = kQuietsNan},
    {.name = "refuses-uncalibrated", .section = "References", .hear = kRefusesUncalibrated},
    {.name = "angle-sign", .section = "Reading", .say = kSigned<kReadAngle>},
    {.name = "voltage-sign", .section = "Output", .say = kSigned<kReadVoltage>},
    {.name = "current-sign", .section = "Output", .say = kSigned<kReadCurrent>},
    {.name = "voltage-as-asked", .section = "Output", .hear = kNotesVoltage, .say = kSaysRequest},
    {.name = "voltage-coarse", .section = "Output", .say = kCoarseVoltage},
    {.name = "address-shifted", .section = "Reading", .say = kShiftedAddress},
    {.name = "address-is-node", .section = "Reading", .say = kNodeForAddress},
    {.name = "status-exchanged", .section = "Status", .say = kStatusExchanged},
    {.name = "set-filled-with-ones", .section = "Reading", .say = kFilledWithOnes},
    {.name = "set-without-checksum", .section = "Reading", .say = kEndsByteEarly},
    {.name = "byte-once", .section = "Reading", .hear = kNotesSelection, .say = kByteOnce},
    {.name = "mode-for-one-read",
     .section = "Reading",
     .hear = kNotesSelection,
     .say = kModeForOneRead},
    {.name = "any-node", .section = "Bus", .acknowledges = kAnyNode},
    {.name = "general-call", .section = "Bus", .acknowledges = kGeneralCall},
    {.name = "reserved-addresses", .section = "Bus", .acknowledges = kReserved},
    {.name = "six-bit-address", .section = "Bus", .acknowledges = kSixBitAddress},
    {.name = "nacks-unknown", .section = "Bus", .refuses = kNacksUnknown},
    {.name = "nacks-surplus", .section = "Bus", .refuses = kNacksSurplus},
    {.name = "nacks-float-end", .section = "Bus", .refuses = kNacksByte<5>},
    {.name = "nacks-tune-end", .section = "Bus", .refuses = kNacksByte<10>},
    {.name = "nacks-brake", .section = "Bus", .refuses = kNacksBrake},
    {.name = "nacks-refused", .section = "Bus", .refuses = kNacksRefused},
    {.name = "holds-long", .section = "Bus", .stretch = kHoldsLong},
    {.name = "holds-reads", .section = "Bus", .stretch = kHoldsAddress},
});

}  // namespace

std::span<const Quirk> quirks() noexcept {
  static const auto kAll = [] {
    std::vector<Quirk> all{kQuirks.begin(), kQuirks.end()};
    const auto programming = programming_quirks();
    all.insert(all.end(), programming.begin(), programming.end());
    return all;
  }();
  return kAll;
}

}  // namespace armjig::morap::emulation
