// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

/// Both references are as they were written, whatever was done since.
template <class Act>
void expect_both_kept(NodeBench& node, Act act) {
  node.send(kPosition, 0.25F);
  node.send(kSpeed, 0.75F);
  act();
  node.expect_number(kReadPositionReference, 0.25F);
  node.expect_number(kReadSpeedReference, 0.75F);
}

template <CommandId between, auto... number>
void kept_over(NodeBench& node) {
  expect_both_kept(node, [&node] {
    node.send(kDisable);  // nothing shall run, whatever comes
    node.send(between, number...);
  });
}

template <CommandId... between>
void kept_beside(NodeBench& node) {
  constexpr float kLittle = 0.5F;  // V, or N m
  expect_both_kept(node, [&node] {
    (node.send(between, kLittle), ...);
    node.send(kCalibrationUnknown);  // it ends what was started
  });
}

/// A real shaft turns by itself a little.
constexpr double kCount = 1e-4;  // of any known motor, and a little more

/// The encoder of a shaft at rest may be just between two counts: one of some tries has to be
/// right.
void expect_calibrated(NodeBench& node, std::string_view message, std::string_view angle) {
  constexpr int kTries = 5;
  const auto wanted = *from_hex(angle);
  for (int i = 1; i < kTries; ++i) {
    node.send_bytes(message);
    if (node.read(kReadAngle, 4) == wanted) return;
  }
  node.send_bytes(message);
  node.expect_bytes(kReadAngle, angle);
}

constexpr Case reference(std::string_view rule, CaseBody run, Start start) {
  return from(start, Hazard::kState, rule, run);
}

constexpr Clause kReferenceClauses[] = {
    must("morap.reference.position",
         "The position reference is read back as it was written, bit for bit.",
         "document; recording static-reference-readback"),
    reference(
        "Values of all signs, and the smallest.",
        [](NodeBench& node) {
          for (const auto* const bits :
               {"DB 0F C9 3F", "B8 1E 05 BF", "00 00 00 80", "01 00 00 00"}) {
            node.send_bytes(std::string{"01 "} + bits);
            node.expect_bytes(kReadPositionReference, bits);
          }
        },
        kUncalibrated),

    must("morap.reference.speed",
         "The speed reference is read back as it was written, bit for bit.", "vector 17"),
    reference(
        "Values of all signs, and the smallest.",
        [](NodeBench& node) {
          for (const auto* const bits :
               {"CD CC 4C 3E", "B8 1E 05 BF", "00 00 00 80", "01 00 00 00"}) {
            node.send_bytes(std::string{"02 "} + bits);
            node.expect_bytes(kReadSpeedReference, bits);
          }
        },
        kUncalibrated),

    must("morap.reference.any-bits",
         "References of any bits are kept, those that are no numbers among them.", "vector 16",
         Profiles::kFirmware),
    reference(
        "Not a number, infinity, the largest; nothing runs.",
        [](NodeBench& node) {
          for (const auto* const bits :
               {"01 02 80 7F", "FF FF FF FF", "00 00 80 FF", "FF FF 7F 7F"}) {
            node.send_bytes(std::string{"01 "} + bits);
            node.expect_bytes(kReadPositionReference, bits);
            node.send_bytes(std::string{"02 "} + bits);
            node.expect_bytes(kReadSpeedReference, bits);
          }
          node.send(kPosition, 0.0F);
          node.send(kSpeed, 0.0F);
          node.send(kCalibrationUnknown);
        },
        kUncalibrated),

    must("morap.reference.apart",
         "A speed reference leaves the position reference alone, and the other way round.",
         "vector 17"),
    reference(
        "Both are written in turn.",
        [](NodeBench& node) {
          node.send(kPosition, 0.25F);
          node.send(kSpeed, 0.75F);
          node.expect_number(kReadPositionReference, 0.25F);
          node.send(kPosition, 0.5F);
          node.expect_number(kReadSpeedReference, 0.75F);
        },
        kUncalibrated),

    must("morap.reference.voltage-apart", "A drive voltage leaves both references alone.",
         "firmware, commands"),
    reference("Both, then a voltage.", on<kept_beside<kVoltage>>, kUncalibrated),
    variant("others", reference("Both, then a torque and a direct voltage.",
                                on<kept_beside<kTorque, kDirectVoltage>>, kUncalibrated)),

    must("morap.reference.last", "Of several references the last one counts.",
         "firmware, commands"),
    reference(
        "Three are written.",
        [](NodeBench& node) {
          for (const float value : {0.25F, 0.5F, -0.75F}) node.send(kPosition, value);
          node.expect_number(kReadPositionReference, -0.75F);
        },
        kUncalibrated),

    must("morap.reference.over-disable", "Disabling keeps the references.", "vector 18"),
    reference("Both, then 0.", on<kept_over<kDisable>>, kUncalibrated),

    must("morap.reference.over-forgetting", "Forgetting the calibration keeps them.",
         "firmware, commands"),
    reference("Both, then 31.", on<kept_over<kCalibrationUnknown>>, kUncalibrated),

    must("morap.reference.over-calibration", "Calibrating keeps them as well.",
         "firmware, commands"),
    reference("Both, then 16.", on<kept_over<kCalibrateZero>>, kUncalibrated),
    variant("angle",
            reference("Both, then 17.", on<kept_over<kCalibrateAngle, 1.0F>>, kUncalibrated)),

    must("morap.write.short-float",
         "A reference with fewer than four bytes leaves the one before in place.", "vector 15"),
    reference(
        "Cut at every byte.",
        [](NodeBench& node) {
          node.send(kPosition, 1.0F);
          for (const auto* const cut : {"01", "01 00", "01 00 00", "01 00 00 00"}) {
            node.send_bytes(cut);
            node.expect_number(kReadPositionReference, 1.0F);
          }
        },
        kUncalibrated),

    must("morap.write.short-mode", "A reference with fewer than four bytes enables nothing.",
         "firmware: an older one changed the mode at the identifier"),
    reference(
        "Cut references of all kinds.",
        [](NodeBench& node) {
          for (const auto* const cut : {"01", "02 00", "03 00 00", "01 00 00 00"}) {
            node.send_bytes(cut);
            node.expect_status(MotorStatus::kDisabled);
          }
        },
        kDisabled),

    must("morap.write.short-joined",
         "What a transaction leaves open the next one does not complete.",
         "recording static-partial-writes"),
    reference(
        "The second write would complete the first.",
        [](NodeBench& node) {
          node.send(kPosition, 1.0F);
          node.send_bytes("01 00 00");
          node.send_bytes("02 3F");
          node.expect_number(kReadPositionReference, 1.0F);
        },
        kUncalibrated),

    must("morap.write.payload-no-command",
         "After a command without payload nothing more is done in that write.",
         "firmware: one write, one command"),
    reference(
        "31 after 0 and after 16.",
        [](NodeBench& node) {
          node.send_bytes("00 1F");
          node.expect_status(MotorStatus::kDisabled);
          node.send_bytes("10 1F");
          node.expect_status(MotorStatus::kDisabled);
        },
        kDisabled),

    must("morap.calibrate.zero", "Identifier 16 makes the present angle 0.",
         "document; recording static-calibrate-angle"),
    reference(
        "To 1 rad, then to 0.",
        [](NodeBench& node) {
          node.send(kCalibrateAngle, 1.0F);
          node.send(kCalibrateZero);
          node.expect_number(kReadAngle, 0.0F);
        },
        kUncalibrated),

    must("morap.calibrate.angle",
         "Identifier 17 makes the present angle the given one, but for a count.",
         "document; vector 8"),
    reference(
        "Angles of both signs.",
        [](NodeBench& node) {
          for (const float wanted : {1.0F, -0.52F, 1.5707964F}) {
            node.send(kCalibrateAngle, wanted);
            node.expect_near(kReadAngle, static_cast<double>(wanted), kCount);
          }
        },
        kUncalibrated),

    must("morap.calibrate.truncates", "The given angle is cut to whole counts, towards zero.",
         "vectors 8 and 10", Profiles::kFirmware),
    reference(
        "1 rad, on a held shaft.",
        [](NodeBench& node) {
          node.send(kCalibrateAngle, 1.0F);
          node.expect_bytes(kReadAngle, node.motor().one_radian);
        },
        kFresh),
    variant("at-rest", reference(
                           "1 rad, on a shaft at rest.",
                           [](NodeBench& node) {
                             expect_calibrated(node, "11 00 00 80 3F", node.motor().one_radian);
                           },
                           kUncalibrated)),

    must("morap.calibrate.truncates-negative", "A negative angle is cut towards zero as well.",
         "vector 9", Profiles::kFirmware),
    reference(
        "-0.52 rad, on a held shaft.",
        [](NodeBench& node) {
          node.send_bytes("11 B8 1E 05 BF");  // -0.52
          node.expect_bytes(kReadAngle, node.motor().minus_half);
        },
        kFresh),
    variant("at-rest", reference(
                           "-0.52 rad, on a shaft at rest.",
                           [](NodeBench& node) {
                             expect_calibrated(node, "11 B8 1E 05 BF", node.motor().minus_half);
                           },
                           kUncalibrated)),

    must("morap.calibrate.large", "An angle of many turns is kept in the same scale.",
         "recording static-calibrate-angle"),
    reference(
        "100 rad.",
        [](NodeBench& node) {
          node.send(kCalibrateAngle, 100.0F);
          node.expect_near(kReadAngle, 100.0, kCount);
        },
        kUncalibrated),

    must("morap.angle.scale",
         "A count is 2 pi through four times the pulses of the encoder and the gear ratio.",
         "vector 13; recording stim-encoder-angle"),
    reference(
        "One count and a thousand.",
        [](NodeBench& node) {
          node.turn(1);
          node.expect_bytes(kReadAngle, node.motor().one_count);
          node.turn(999);
          node.expect_bytes(kReadAngle, node.motor().thousand_counts);
        },
        kFresh),

    must("morap.angle.many-turns", "The angle counts on beyond 16 bits of the encoder, both ways.",
         "firmware, encoder: counts have 32 bits"),
    reference(
        "Beyond 32,767 and 65,535 counts, and below -32,768.",
        [](NodeBench& node) {
          const MotorLaw motor{node.motor()};
          int counts = 0;
          for (const int by : {30'000, 2'767, 1, 32'000, 1'000, -66'000, -32'000, -1'000}) {
            node.turn(by);
            counts += by;
            const auto angle = motor.angle(counts);
            node.about(fmt::format("{} counts", counts));
            node.expect_near(kReadAngle, angle, 1e-5 + 1e-6 * std::abs(angle));
          }
        },
        kFresh),

    must("morap.angle.sign", "Counts downwards make the angle smaller.", "vector 13"),
    reference(
        "One count down.",
        [](NodeBench& node) {
          node.turn(-1);
          const auto count = decode_float(slice<4>(Bytes{*from_hex(node.motor().one_count)}, 0));
          node.expect_number(kReadAngle, -count);
        },
        kFresh),

    must("morap.angle.uncalibrated", "The angle is read also without calibration.", "vector 12"),
    reference(
        "A thousand counts before any calibration.",
        [](NodeBench& node) {
          node.expect_status(MotorStatus::kNeedsCalibration);
          expect_turned(node);
        },
        kFresh),

    must("morap.angle.disabled", "Counting goes on while the node is disabled.",
         "firmware, encoder"),
    reference(
        "A thousand counts while disabled.",
        [](NodeBench& node) {
          node.send(kCalibrateZero);
          node.tick();
          expect_turned(node);
        },
        kFresh),

    must("morap.angle.over-disable", "Disabling keeps the angle as it is.",
         "firmware, identifier 0"),
    reference(
        "A thousand counts, then 0.",
        [](NodeBench& node) {
          node.send(kCalibrateZero);
          node.turn(1000);
          node.send(kDisable);
          node.expect_bytes(kReadAngle, node.motor().thousand_counts);
        },
        kFresh),

    must("morap.calibrate.zero-while-enabled", "An enabled node is calibrated to 0 as well.",
         "recording loop-calibrate-moving"),
    reference(
        "0 V on a held shaft, then 16.",
        [](NodeBench& node) {
          node.send(kCalibrateAngle, 1.0F);
          node.send(kVoltage, 0.0F);
          node.send(kCalibrateZero);
          node.expect_number(kReadAngle, 0.0F);
        },
        kFresh),

    must("morap.calibrate.angle-while-enabled",
         "An enabled node is calibrated to an angle as well.", "recording loop-calibrate-moving"),
    reference(
        "0 V on a held shaft, then 17.",
        [](NodeBench& node) {
          node.send(kCalibrateZero);
          node.send(kVoltage, 0.0F);
          node.send(kCalibrateAngle, 1.0F);
          node.expect_near(kReadAngle, 1.0, kCount);
        },
        kFresh),
    variant("twice", reference(
                         "0 V, and five times two angles before the next tick.",
                         [](NodeBench& node) {
                           // A tick between the two sees the shaft turn, and drives it.
                           constexpr double kKicked = 0.2;  // rad, at most
                           node.send(kVoltage, 0.0F);
                           node.settle();
                           for (const float angle : {20.0F, -30.0F, 40.0F, 5.0F, 0.5F}) {
                             node.send(kCalibrateAngle, 2 * angle);
                             node.send(kCalibrateAngle, angle);
                             node.expect_near(kReadAngle, double{angle}, kKicked);
                           }
                           node.send(kDisable);
                         },
                         Start::kDisabled)),
    variant("zero", reference(
                        "0 V, an angle of 5, then 16.",
                        [](NodeBench& node) {
                          constexpr double kKicked = 0.5;  // rad, at most, as above
                          node.send(kVoltage, 0.0F);
                          node.send(kCalibrateAngle, 5.0F);
                          node.send(kCalibrateZero);
                          node.expect_near(kReadAngle, 0.0, kKicked);
                          node.send(kDisable);
                        },
                        Start::kDisabled)),

    must("morap.angle.over-forgetting", "Forgetting the calibration keeps the angle as it is.",
         "firmware, identifier 31"),
    reference(
        "A thousand counts, then 31.",
        [](NodeBench& node) {
          node.turn(1000);
          node.send(kCalibrationUnknown);
          node.expect_bytes(kReadAngle, node.motor().thousand_counts);
        },
        kFresh),
    variant("at-rest", reference(
                           "5 rad, then 31.",
                           [](NodeBench& node) {
                             constexpr double kLittle = 0.1;  // rad, of a shaft that nothing drives
                             node.send(kCalibrateAngle, 5.0F);
                             node.send(kCalibrationUnknown);
                             node.expect_near(kReadAngle, 5.0, kLittle);
                           },
                           Start::kDisabled)),
};

}  // namespace

Chapter reference_chapter() {
  return chapter("References, calibration and angle", kReferenceClauses);
}

}  // namespace armjig::morap::conformance
