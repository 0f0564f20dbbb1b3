// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <chrono>
#include <string>

#include "cli/devices/machines.hpp"
#include "harness/wire/morap/message.hpp"

namespace armjig::morap {
namespace {

using namespace std::chrono_literals;
using campaign::AbstractLetter;
using campaign::Acts;
using mealy::Row;

constexpr std::uint8_t kAddress =
    0x12;                         ///< of the node that there is unless the target says another
constexpr Duration kRest = 10ms;  ///< programming needs it

void write(Acts& acts, const Command& command) { acts.write(kAddress, encode(command)); }

/// What follows each letter: both states are asked for.
void ask(Acts& acts) {
  acts.wait(kRest);
  for (const auto id : {CommandId::kReadMotorStatus, CommandId::kReadProgrammingStatus}) {
    write(acts, {id, {}});
    acts.wait(1ms);
    acts.read(kAddress, 1);
    acts.wait(1ms);
  }
}

template <CommandId id>
void plain(Acts& acts) {
  write(acts, {id, {}});
  ask(acts);
}
/// A number that leaves the motor where it is.
template <CommandId id>
void with_number(Acts& acts) {
  write(acts, {id, 0.0F});
  ask(acts);
}
template <int pole>
void tune(Acts& acts) {
  write(acts,
        {CommandId::kTune, TuneRequest{TuneKind::kPdPosition, 0.2F, static_cast<float>(pole)}});
  ask(acts);
}
void program(Acts& acts) {
  constexpr Coefficients kOne{1, {}};
  write(acts, {CommandId::kProgram,
               ControllerSet{ControllerKind::kPosition, 200, kOne, kOne, kOne, 0.0F}});
  ask(acts);
}
/// No filter has five coefficients.
void program_too_much(Acts& acts) {
  constexpr std::array kBegin{static_cast<std::byte>(CommandId::kProgram), std::byte{0},
                              std::byte{200}, std::byte{0}, std::byte{5}};
  acts.write(kAddress, kBegin);
  ask(acts);
}

constexpr std::array kLetters{
    AbstractLetter{"disable", plain<CommandId::kDisable>},
    AbstractLetter{"position", with_number<CommandId::kPosition>},
    AbstractLetter{"speed", with_number<CommandId::kSpeed>},
    AbstractLetter{"torque", with_number<CommandId::kTorque>},
    AbstractLetter{"brake", plain<CommandId::kBrake14>},
    AbstractLetter{"calibrate zero", plain<CommandId::kCalibrateZero>},
    AbstractLetter{"calibrate angle", with_number<CommandId::kCalibrateAngle>},
    AbstractLetter{"calibration unknown", plain<CommandId::kCalibrationUnknown>},
    AbstractLetter{"program", program},
    AbstractLetter{"program too much", program_too_much},
    AbstractLetter{"tune", tune<-9>},
    AbstractLetter{"tune unstable", tune<1>},
    AbstractLetter{"default controllers", plain<CommandId::kDefaultControllers>}};

std::string motor_status_in_words(std::byte value) {
  switch (static_cast<MotorStatus>(value)) {
    case MotorStatus::kEnabled:
      return "enabled";
    case MotorStatus::kDisabled:
      return "disabled";
    case MotorStatus::kNeedsCalibration:
      return "uncalibrated";
  }
  return "status unknown";
}
std::string programming_in_words(std::byte value) {
  switch (static_cast<ProgrammingStatus>(value)) {
    case ProgrammingStatus::kNothing:
      return "nothing";
    case ProgrammingStatus::kSuccess:
      return "accepted";
    case ProgrammingStatus::kFailure:
      return "refused";
  }
  return "programming unknown";
}

/// The reads are told by what was chosen before them.
std::string said(std::span<const Message> messages) {
  std::string text;
  for (const auto& message : messages) {
    const bool is_motor = message.name == "motor_status";
    if (!text.empty()) text += ", ";
    if (!message.fault.empty() || (!is_motor && message.name != "programming_status")) {
      text += "noise";
      continue;
    }
    text += is_motor ? motor_status_in_words(message.raw.back())
                     : programming_in_words(message.raw.back());
  }
  return text;
}

/// docs/spec/morap.md, "Commands" and "Status".
constexpr std::array kMotorRows{
    Row{"uncalibrated", "position", "uncalibrated", "waiting"},
    Row{"uncalibrated", "speed", "uncalibrated", "waiting"},
    Row{"uncalibrated", "torque", "uncalibrated", "waiting"},
    Row{"uncalibrated", "calibrate zero", "disabled", "disabled"},
    Row{"uncalibrated", "calibrate angle", "disabled", "disabled"},
    Row{"uncalibrated", "", "uncalibrated", ""},
    Row{"waiting", "disable", "uncalibrated", "uncalibrated"},
    Row{"waiting", "calibration unknown", "uncalibrated", "uncalibrated"},
    Row{"waiting", "calibrate zero", "enabled", "enabled"},
    Row{"waiting", "calibrate angle", "enabled", "enabled"},
    Row{"waiting", "", "uncalibrated", ""},
    Row{"", "calibration unknown", "uncalibrated", "uncalibrated"},
    Row{"disabled", "position", "enabled", "enabled"},
    Row{"disabled", "speed", "enabled", "enabled"},
    Row{"disabled", "torque", "enabled", "enabled"},
    Row{"disabled", "", "disabled", ""},
    Row{"enabled", "disable", "disabled", "disabled"},
    Row{"enabled", "", "enabled", ""},
};
constexpr std::array kProgrammingRows{
    Row{"", "program", "accepted", "accepted"},
    Row{"", "tune", "accepted", "accepted"},
    Row{"", "program too much", "refused", "refused"},
    Row{"", "tune unstable", "refused", "refused"},
    Row{"", "default controllers", "nothing", "nothing"},
    Row{"nothing", "", "nothing", ""},
    Row{"accepted", "", "accepted", ""},
    Row{"refused", "", "refused", ""},
};
constexpr std::array kTables{mealy::Table{"uncalibrated", kMotorRows},
                             mealy::Table{"nothing", kProgrammingRows}};

}  // namespace

std::span<const campaign::Learnable> machines() {
  static const std::array kMachines{
      campaign::Learnable{.name = "node",
                          .letters = kLetters,
                          .said = said,
                          .quiet = 1s,
                          .documented = kTables,
                          .source = "docs/spec/morap.md, Commands, Status"}};
  return kMachines;
}

}  // namespace armjig::morap
