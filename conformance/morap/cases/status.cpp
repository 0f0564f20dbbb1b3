// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

using enum MotorStatus;

void at_boot(NodeBench& node) { node.expect_status(kNeedsCalibration); }

void calibrated_zero(NodeBench& node) {
  node.send(kCalibrateZero);
  node.expect_status(MotorStatus::kDisabled);
}

void calibrated_angle(NodeBench& node) {
  node.send(kCalibrateAngle, 1.0F);
  node.expect_status(MotorStatus::kDisabled);
}

void calibration_whole(NodeBench& node) {
  node.send_bytes("11 00 00 80");
  node.expect_status(kNeedsCalibration);
}

void calibration_surplus(NodeBench& node) {
  node.send_bytes("10 01 02 03");
  node.expect_status(MotorStatus::kDisabled);
}

/// A reference that moves nothing: the node is calibrated at 0 where it stands.
template <CommandId reference>
void enabled_by(NodeBench& node) {
  node.send(reference, 0.0F);
  node.expect_status(kEnabled);
  node.send(kDisable);
}

void disabled(NodeBench& node) {
  node.send(kPosition, 0.0F);
  node.send(kDisable);
  node.expect_status(MotorStatus::kDisabled);
}

void disable_again(NodeBench& node) {
  node.send(kDisable);
  node.expect_status(MotorStatus::kDisabled);
}

void disable_uncalibrated(NodeBench& node) {
  node.send(kDisable);
  node.expect_status(kNeedsCalibration);
}

void forgotten(NodeBench& node) {
  node.send(kCalibrationUnknown);
  node.expect_status(kNeedsCalibration);
}

void forgotten_enabled(NodeBench& node) {
  node.send(kVoltage, 0.0F);
  node.send(kCalibrationUnknown);
  node.expect_status(kNeedsCalibration);
}

void forgetting_disables(NodeBench& node) {
  node.send(kVoltage, 0.0F);
  node.send(kCalibrationUnknown);
  node.send(kCalibrateZero);
  node.expect_status(MotorStatus::kDisabled);
}

void latched(NodeBench& node) {
  for (const auto reference : {kPosition, kSpeed, kVoltage}) {
    node.send(reference, 0.0F);
    node.expect_status(kNeedsCalibration);
  }
  node.send(kCalibrationUnknown);
}

template <CommandId reference>
void runs_with_calibration(NodeBench& node) {
  node.send(reference, 0.0F);
  node.send(kCalibrateZero);
  node.expect_status(kEnabled);
  node.send(kDisable);
}

template <CommandId end>
void unlatches(NodeBench& node) {
  node.send(kVoltage, 0.0F);
  node.send(end);
  node.send(kCalibrateZero);
  node.expect_status(MotorStatus::kDisabled);
}

void calibration_while_enabled(NodeBench& node) {
  node.send(kCalibrateZero);
  node.send(kVoltage, 0.0F);
  node.send(kCalibrateZero);
  node.expect_status(kEnabled);
  node.send(kCalibrateAngle, 1.0F);
  node.expect_status(kEnabled);
  node.send(kDisable);
}

void over_reading(NodeBench& node) {
  node.send(kVoltage, 0.0F);
  for (const auto& reading : readings()) std::ignore = node.read(reading.selector, 4);
  node.expect_status(kEnabled);
  node.send(kDisable);
}

/// Enabled, then these bytes.
template <class Send>
void stays_enabled(NodeBench& node, Send send) {
  node.send(kVoltage, 0.0F);
  send();
  node.expect_status(kEnabled);
  node.settle();
  node.expect_status(kEnabled);
  node.send(kDisable);
}

void over_defaults(NodeBench& node) {
  stays_enabled(node, [&] { node.send(kDefaultControllers); });
}
void over_program(NodeBench& node) {
  stays_enabled(node, [&] {
    node.send_bytes("20 00 C8 00 01 00 00 20 41 01 00 00 20 41 01 00 00 00 00 00 00 00 00 71");
  });
}
void over_tune(NodeBench& node) {
  stays_enabled(node, [&] { node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1"); });
}
void over_brake(NodeBench& node) {
  stays_enabled(node, [&] {
    node.send(kBrake14);
    node.send(kBrake15);
  });
}

void at_the_byte(NodeBench& node) {
  node.tick();
  node.send(kCalibrateZero);
  node.expect_status(MotorStatus::kDisabled);
  node.send(kVoltage, 0.0F);
  node.expect_status(kEnabled);
  node.send(kDisable);
  node.expect_status(MotorStatus::kDisabled);
}

constexpr bool is_undefined(int id) {
  return id == 6 || (id >= 8 && id <= 13) || (id >= 18 && id <= 30) || (id >= 35 && id <= 127) ||
         id == 135 || id == 137 || (id >= 140 && id <= 251) || id == 255;
}

void undefined(NodeBench& node) {
  node.send(kVoltage, 0.0F);
  node.send(kReadMotorStatus);
  for (int id = 0; id < 256; ++id) {
    if (!is_undefined(id)) continue;
    node.about(fmt::format("behind identifier {}", id));
    node.send_bytes(std::vector{static_cast<std::byte>(id)});
    node.expect_read_on("01");
  }
  node.send(kDisable);
}

template <CommandId id>
void does_nothing(NodeBench& node) {
  node.send(kVoltage, 0.0F);
  node.send(kReadMotorStatus);
  node.send(id);
  node.expect_read_on("01");
  node.send(kDisable);
}

void all_bits(NodeBench& node) {
  node.send(kVoltage, 0.0F);
  for (const auto* const id : {"40", "60", "50", "5F", "7F"}) node.send_bytes(id);
  node.expect_status(kEnabled);
  node.send(kDisable);
}

void power_forgets(NodeBench& node) {
  node.send(kCalibrateZero);
  node.send(kPosition, 0.5F);
  node.send(kSpeed, 0.5F);
  node.touch("power", 1);
  node.expect_status(kNeedsCalibration);
  node.expect_number(kReadPositionReference, 0.0F);
  node.expect_number(kReadSpeedReference, 0.0F);
}

void power_forgets_parameters(NodeBench& node) {
  const auto before = node.read(kReadPositionSet, 31);
  node.send_bytes("20 00 C8 00 01 00 00 20 41 01 00 00 20 41 01 00 00 00 00 00 00 00 00 71");
  node.settle();
  node.touch("power", 1);
  node.expect_same(node.read(kReadPositionSet, 31), before);
}

constexpr Case state(std::string_view requirement, std::string_view rule, void (*run)(Bench&),
                     Start start) {
  return from(start, start == kProgrammable ? Hazard::kProgram : Hazard::kState, requirement, rule,
              run);
}

constexpr Start kCalibrated = Start::kDisabled;

constexpr Case kCases[] = {
    state("morap.status.at-boot", "It is read first.", on<at_boot>, kFresh),
    state("morap.status.calibrated-zero", "16, then the status.", on<calibrated_zero>,
          kUncalibrated),
    state("morap.status.calibrated-angle", "17 with 1 rad, then the status.", on<calibrated_angle>,
          kUncalibrated),
    state("morap.status.calibration-whole", "17 with three bytes.", on<calibration_whole>,
          kUncalibrated),
    state("morap.status.calibration-surplus", "16 with three bytes behind it.",
          on<calibration_surplus>, kUncalibrated),
    state("morap.status.enabled-by-position", "To where it stands.", on<enabled_by<kPosition>>,
          kCalibrated),
    state("morap.status.enabled-by-speed", "Of 0.", on<enabled_by<kSpeed>>, kCalibrated),
    state("morap.status.enabled-by-voltage", "Of 0.", on<enabled_by<kVoltage>>, kCalibrated),
    state("morap.status.enabled-by-torque", "Of 0.", on<enabled_by<kTorque>>, kCalibrated),
    state("morap.status.disabled", "A position reference, then 0.", on<disabled>, kCalibrated),
    state("morap.status.disable-again", "0 once more.", on<disable_again>, kCalibrated),
    state("morap.status.disable-uncalibrated", "0, then the status.", on<disable_uncalibrated>,
          kUncalibrated),
    state("morap.status.forgotten", "31, then the status.", on<forgotten>, kCalibrated),
    state("morap.status.forgotten-enabled", "Enabled with 0 V, then 31.", on<forgotten_enabled>,
          kCalibrated),
    state("morap.status.forgetting-disables", "Enabled, 31, 16.", on<forgetting_disables>,
          kCalibrated),
    state("morap.status.latched", "References of all documented kinds.", on<latched>,
          kUncalibrated),
    state("morap.status.runs-with-calibration", "0 V, then 16.",
          on<runs_with_calibration<kVoltage>>, kUncalibrated),
    state("morap.status.runs-with-direct-voltage", "Direct 0 V, then 16.",
          on<runs_with_calibration<kDirectVoltage>>, kUncalibrated),
    state("morap.status.runs-with-torque", "0 N m, then 16.", on<runs_with_calibration<kTorque>>,
          kUncalibrated),
    state("morap.status.disable-unlatches", "0 V, 0, 16.", on<unlatches<kDisable>>, kUncalibrated),
    state("morap.status.forgetting-unlatches", "0 V, 31, 16.", on<unlatches<kCalibrationUnknown>>,
          kUncalibrated),
    state("morap.status.calibration-while-enabled", "0 V, 16, 17, on a held shaft.",
          on<calibration_while_enabled>, kFresh),
    state("morap.status.over-reading", "0 V, then all readings.", on<over_reading>, kCalibrated),
    state("morap.status.over-defaults", "0 V, then 33.", on<over_defaults>, kProgrammable),
    state("morap.status.over-program", "0 V, then a good message.", on<over_program>,
          kProgrammable),
    state("morap.status.over-tune", "0 V, then a good request.", on<over_tune>, kProgrammable),
    state("morap.status.over-brake", "0 V, then 14 and 15.", on<over_brake>, kCalibrated),
    state("morap.status.at-the-byte", "Three commands inside of one tick.", on<at_the_byte>,
          kFresh),
    state("morap.ids.undefined", "0 V, then each of them.", on<undefined>, kCalibrated),
    state("morap.ids.trajectory", "0 V, then 7.", on<does_nothing<kTrajectory>>, kCalibrated),
    state("morap.ids.led-on", "0 V, then 252.", on<does_nothing<kLedOn>>, kCalibrated),
    state("morap.ids.led-off", "0 V, then 253.", on<does_nothing<kLedOff>>, kCalibrated),
    state("morap.ids.led-toggle", "0 V, then 254.", on<does_nothing<kLedToggle>>, kCalibrated),
    state("morap.ids.all-bits", "Those that end like disabling and forgetting.", on<all_bits>,
          kCalibrated),
    state("morap.power.forgets", "Calibrated, with references; off and on.", on<power_forgets>,
          kFresh),
    state("morap.power.forgets-parameters", "Programmed; off and on.", on<power_forgets_parameters>,
          kFresh),
};

}  // namespace

std::span<const Case> status_cases() noexcept { return kCases; }

}  // namespace armjig::morap::conformance
