// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

using enum MotorStatus;

/// A reference that moves nothing: the node is calibrated at 0 where it stands.
template <CommandId reference>
void enabled_by(NodeBench& node) {
  node.send(reference, 0.0F);
  node.expect_status(kEnabled);
  node.send(kDisable);
}

template <CommandId reference, CommandId calibration = kCalibrateZero, auto... angle>
void runs_with_calibration(NodeBench& node) {
  node.send(reference, 0.0F);
  node.send(calibration, angle...);
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

template <CommandId id>
void does_nothing_when_enabled(NodeBench& node) {
  node.send(kVoltage, 0.0F);
  node.send(kReadMotorStatus);
  node.send(id);
  node.expect_read_on("01");
  node.send(kDisable);
}

/// As commands have one, which sets an angle, a reference or a voltage.
template <CommandId... ids>
void ignores_numbers(NodeBench& node) {
  constexpr float kNumber = 1.5F;
  constexpr float kReference = 0.25F;
  constexpr double kLittle = 0.1;  // rad, of a shaft that nothing drives
  node.send(kPosition, kReference);
  node.send(kSpeed, kReference);
  node.send(kDisable);
  node.send(kCalibrateZero);
  for (const auto id : {ids...}) {
    node.about(fmt::format("{} and a number after identifier {}", kNumber, static_cast<int>(id)));
    node.send(id, kNumber);
    node.expect_near(kReadAngle, 0.0, kLittle);
    node.expect_number(kReadPositionReference, kReference);
    node.expect_number(kReadSpeedReference, kReference);
    node.expect_status(MotorStatus::kDisabled);
  }
}

constexpr Case state(std::string_view rule, CaseBody run, Start start) {
  return from(start, start == kProgrammable ? Hazard::kProgram : Hazard::kState, rule, run);
}

constexpr Start kCalibrated = Start::kDisabled;

void enable_and_forget(NodeBench& node) {
  node.send(kVoltage, 0.0F);
  node.send(kCalibrationUnknown);
}

constexpr Clause kStatusClauses[] = {
    must("morap.status.at-boot", "After power-on the motor status is 3.",
         "document, motor status; vector 2"),
    state(
        "It is read first.", [](NodeBench& node) { node.expect_status(kNeedsCalibration); },
        kSwitchedOn),

    must("morap.status.calibrated-zero",
         "Identifier 16 ends the need for calibration: the status becomes 2.",
         "document, motor status; vector 7"),
    state(
        "16, then the status.",
        [](NodeBench& node) {
          node.send(kCalibrateZero);
          node.expect_status(MotorStatus::kDisabled);
        },
        kUncalibrated),

    must("morap.status.calibrated-angle",
         "Identifier 17 with an angle ends the need for calibration: the status becomes 2.",
         "document, motor status; vector 8"),
    state(
        "17 with 1 rad, then the status.",
        [](NodeBench& node) {
          node.send(kCalibrateAngle, 1.0F);
          node.expect_status(MotorStatus::kDisabled);
        },
        kUncalibrated),

    must("morap.status.calibration-whole",
         "Identifier 17 with fewer than four bytes does not calibrate.",
         "recording static-partial-writes"),
    state(
        "17 with three bytes.",
        [](NodeBench& node) {
          node.send_bytes("11 00 00 80");
          node.expect_status(kNeedsCalibration);
        },
        kUncalibrated),

    must("morap.status.calibration-surplus",
         "Bytes after identifier 16 do not take the calibration away.", "firmware, vector 22"),
    state(
        "16 with three bytes after it.",
        [](NodeBench& node) {
          node.send_bytes("10 01 02 03");
          node.expect_status(MotorStatus::kDisabled);
        },
        kUncalibrated),

    must("morap.status.enabled-by-position",
         "A position reference makes the status of a calibrated node 1.", "document, motor status"),
    state("To where it stands.", on<enabled_by<kPosition>>, kCalibrated),

    must("morap.status.enabled-by-speed",
         "A speed reference makes the status of a calibrated node 1.", "document, motor status"),
    state("Of 0.", on<enabled_by<kSpeed>>, kCalibrated),

    must("morap.status.enabled-by-voltage",
         "A drive voltage makes the status of a calibrated node 1.", "document, motor status"),
    state("Of 0.", on<enabled_by<kVoltage>>, kCalibrated),
    variant("any", from(kCalibrated, Hazard::kMove, "Up to 1000 V, for a moment.",
                        [](NodeBench& node) {
                          for (const float volts : {1.0F, -23.0F, 30.0F, -1000.0F}) {
                            node.about(fmt::format("{} V", volts));
                            node.send(kVoltage, volts);
                            node.expect_status(kEnabled);
                            node.send(kDisable);
                          }
                        })),

    must("morap.status.enabled-by-torque", "A torque makes the status of a calibrated node 1.",
         "firmware; recording static-status-transitions", Profiles::kFirmware),
    state("Of 0.", on<enabled_by<kTorque>>, kCalibrated),

    must("morap.status.disabled", "Identifier 0 makes the status of an enabled node 2.",
         "document, motor status; vector 18"),
    state(
        "A position reference, then 0.",
        [](NodeBench& node) {
          node.send(kPosition, 0.0F);
          node.send(kDisable);
          node.expect_status(MotorStatus::kDisabled);
        },
        kCalibrated),

    must("morap.status.disable-again", "Identifier 0 to a disabled node leaves its status at 2.",
         "firmware, status table"),
    state(
        "0 once more.",
        [](NodeBench& node) {
          node.send(kDisable);
          node.expect_status(MotorStatus::kDisabled);
        },
        kCalibrated),

    must("morap.status.disable-uncalibrated", "Identifier 0 does not end the need for calibration.",
         "firmware, status table"),
    state(
        "0, then the status.",
        [](NodeBench& node) {
          node.send(kDisable);
          node.expect_status(kNeedsCalibration);
        },
        kUncalibrated),

    must("morap.status.forgotten", "Identifier 31 makes the status of a disabled node 3.",
         "document; firmware, status table"),
    state(
        "31, then the status.",
        [](NodeBench& node) {
          node.send(kCalibrationUnknown);
          node.expect_status(kNeedsCalibration);
        },
        kCalibrated),

    must("morap.status.forgotten-enabled", "Identifier 31 makes the status of an enabled node 3.",
         "vector 19"),
    state(
        "Enabled with 0 V, then 31.",
        [](NodeBench& node) {
          enable_and_forget(node);
          node.expect_status(kNeedsCalibration);
        },
        kCalibrated),

    must("morap.status.forgetting-disables",
         "Identifier 31 also disables: after the next calibration the status is 2.", "vector 19"),
    state(
        "Enabled, 31, 16.",
        [](NodeBench& node) {
          enable_and_forget(node);
          node.send(kCalibrateZero);
          node.expect_status(MotorStatus::kDisabled);
        },
        kCalibrated),

    must("morap.status.latched", "A reference to an uncalibrated node leaves its status at 3.",
         "document, motor status; vector 14"),
    state(
        "References of all documented kinds.",
        [](NodeBench& node) {
          for (const auto reference : {kPosition, kSpeed, kVoltage}) {
            node.send(reference, 0.0F);
            node.expect_status(kNeedsCalibration);
          }
          node.send(kCalibrationUnknown);
        },
        kUncalibrated),

    must("morap.status.runs-with-calibration",
         "A reference that came before calibration enables the node as soon as that comes.",
         "vector 14; recording loop-uncalibrated", Profiles::kFirmware),
    state("0 V, then 16.", on<runs_with_calibration<kVoltage>>, kUncalibrated),
    variant("angle",
            state("0 V, then 17.", on<runs_with_calibration<kVoltage, kCalibrateAngle, 1.0F>>,
                  kUncalibrated)),

    must("morap.status.runs-with-direct-voltage",
         "So does a direct drive voltage that came before calibration.", "firmware, identifier 4",
         Profiles::kFirmware),
    state("Direct 0 V, then 16.", on<runs_with_calibration<kDirectVoltage>>, kUncalibrated),

    must("morap.status.runs-with-torque", "So does a torque that came before calibration.",
         "firmware, identifier 5", Profiles::kFirmware),
    state("0 N m, then 16.", on<runs_with_calibration<kTorque>>, kUncalibrated),

    must("morap.status.disable-unlatches",
         "Identifier 0 takes back a reference that came before calibration.",
         "firmware, status table"),
    state("0 V, 0, 16.", on<unlatches<kDisable>>, kUncalibrated),

    must("morap.status.forgetting-unlatches",
         "Identifier 31 takes back a reference that came before calibration, too.",
         "firmware, status table"),
    state("0 V, 31, 16.", on<unlatches<kCalibrationUnknown>>, kUncalibrated),

    must("morap.status.calibration-while-enabled",
         "Calibrating an enabled node leaves its status at 1.", "recording loop-calibrate-moving"),
    state(
        "0 V, 16, 17, on a held shaft.",
        [](NodeBench& node) {
          node.send(kCalibrateZero);
          node.send(kVoltage, 0.0F);
          node.send(kCalibrateZero);
          node.expect_status(kEnabled);
          node.send(kCalibrateAngle, 1.0F);
          node.expect_status(kEnabled);
          node.send(kDisable);
        },
        kFresh),

    must("morap.status.over-reading", "Reading leaves an enabled node enabled.",
         "firmware, status table"),
    state(
        "0 V, then all readings.",
        [](NodeBench& node) {
          node.send(kVoltage, 0.0F);
          for (const auto& reading : readings()) std::ignore = node.read(reading.selector, 4);
          node.expect_status(kEnabled);
          node.send(kDisable);
        },
        kCalibrated),

    must("morap.status.over-defaults",
         "Loading the stored controllers leaves an enabled node enabled.",
         "firmware, status table"),
    state(
        "0 V, then 33.",
        [](NodeBench& node) { stays_enabled(node, [&] { node.send(kDefaultControllers); }); },
        kProgrammable),

    must("morap.status.over-program", "A parameter message leaves an enabled node enabled.",
         "firmware, status table"),
    state(
        "0 V, then a good message.",
        [](NodeBench& node) {
          stays_enabled(node, [&] {
            node.send_bytes(
                "20 00 C8 00 01 00 00 20 41 01 00 00 20 41 01 00 00 00 00 00 00 00 00 71");
          });
        },
        kProgrammable),

    must("morap.status.over-tune", "A tuning message leaves an enabled node enabled.",
         "firmware, status table"),
    state(
        "0 V, then a good request.",
        [](NodeBench& node) {
          stays_enabled(node, [&] { node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1"); });
        },
        kProgrammable),

    must("morap.status.over-brake", "Identifiers 14 and 15 leave an enabled node enabled.",
         "vector 25"),
    state(
        "0 V, then 14 and 15.",
        [](NodeBench& node) {
          stays_enabled(node, [&] {
            node.send(kBrake14);
            node.send(kBrake15);
          });
        },
        kCalibrated),

    must("morap.status.at-the-byte",
         "The status changes with the last byte of a command and does not wait for a tick.",
         "recording static-status-transitions"),
    state(
        "Three commands inside of one tick.",
        [](NodeBench& node) {
          node.tick();
          node.send(kCalibrateZero);
          node.expect_status(MotorStatus::kDisabled);
          node.send(kVoltage, 0.0F);
          node.expect_status(kEnabled);
          node.send(kDisable);
          node.expect_status(MotorStatus::kDisabled);
        },
        kFresh),

    must("morap.ids.undefined", "Identifiers without a meaning change nothing at an enabled node.",
         "recording static-unknown-ids"),
    state(
        "0 V, then each of them.",
        [](NodeBench& node) {
          node.send(kVoltage, 0.0F);
          node.send(kReadMotorStatus);
          for (int id = 0; id < 256; ++id) {
            if (is_known(CommandId{static_cast<std::uint8_t>(id)})) continue;
            node.about(fmt::format("after identifier {}", id));
            node.send_bytes(std::vector{static_cast<std::byte>(id)});
            node.expect_read_on("01");
          }
          node.send(kDisable);
        },
        kCalibrated),

    must("morap.ids.trajectory", "Identifier 7 does nothing.",
         "firmware: a placeholder; recording static-unknown-ids"),
    state("0 V, then 7.", on<does_nothing_when_enabled<kTrajectory>>, kCalibrated),

    must("morap.ids.led-on", "Identifier 252 does nothing.", "firmware"),
    state("0 V, then 252.", on<does_nothing_when_enabled<kLedOn>>, kCalibrated),

    must("morap.ids.led-off", "Identifier 253 does nothing.", "firmware"),
    state("0 V, then 253.", on<does_nothing_when_enabled<kLedOff>>, kCalibrated),

    must("morap.ids.led-toggle", "Identifier 254 does nothing.", "firmware"),
    state("0 V, then 254.", on<does_nothing_when_enabled<kLedToggle>>, kCalibrated),

    must("morap.ids.no-number", "Nor do these do anything with a number after them.", "firmware"),
    state("7, 14, 15 and 252 to 254 with 1.5.",
          on<ignores_numbers<kTrajectory, kBrake15, kBrake14, kLedOn, kLedOff, kLedToggle>>,
          kCalibrated),

    must("morap.ids.all-bits", "All eight bits of an identifier count.",
         "arithmetic; recording static-unknown-ids"),
    state(
        "Those that end like disabling and forgetting.",
        [](NodeBench& node) {
          node.send(kVoltage, 0.0F);
          for (const auto* const id : {"40", "60", "50", "5F", "7F"}) node.send_bytes(id);
          node.expect_status(kEnabled);
          node.send(kDisable);
        },
        kCalibrated),

    must("morap.power.forgets",
         "A power cycle takes away calibration, references and what was chosen.",
         "recording static-restart"),
    state(
        "Calibrated, with references; off and on.",
        [](NodeBench& node) {
          node.send(kCalibrateZero);
          node.send(kPosition, 0.5F);
          node.send(kSpeed, 0.5F);
          node.touch("power", 1);
          node.expect_status(kNeedsCalibration);
          node.expect_number(kReadPositionReference, 0.0F);
          node.expect_number(kReadSpeedReference, 0.0F);
        },
        kFresh),

    must("morap.power.forgets-parameters", "A power cycle brings back the stored controllers.",
         "recording static-restart", Profiles::kFirmware),
    state(
        "Programmed; off and on.",
        [](NodeBench& node) {
          const auto before = node.read(kReadPositionSet, 31);
          node.send_bytes(
              "20 00 C8 00 01 00 00 20 41 01 00 00 20 41 01 00 00 00 00 00 00 00 00 71");
          node.settle();
          node.touch("power", 1);
          node.expect_same(node.read(kReadPositionSet, 31), before);
        },
        kFresh),
};

}  // namespace

Chapter status_chapter() { return chapter("Status and identifiers", kStatusClauses); }

}  // namespace armjig::morap::conformance
