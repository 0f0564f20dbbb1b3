// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

void position(NodeBench& node) {
  for (const auto* const bits : {"DB 0F C9 3F", "B8 1E 05 BF", "00 00 00 80", "01 00 00 00"}) {
    node.send_bytes(std::string{"01 "} + bits);
    node.expect_bytes(kReadPositionReference, bits);
  }
}

void speed(NodeBench& node) {
  for (const auto* const bits : {"CD CC 4C 3E", "B8 1E 05 BF", "00 00 00 80", "01 00 00 00"}) {
    node.send_bytes(std::string{"02 "} + bits);
    node.expect_bytes(kReadSpeedReference, bits);
  }
}

void any_bits(NodeBench& node) {
  for (const auto* const bits : {"01 02 80 7F", "FF FF FF FF", "00 00 80 FF", "FF FF 7F 7F"}) {
    node.send_bytes(std::string{"01 "} + bits);
    node.expect_bytes(kReadPositionReference, bits);
    node.send_bytes(std::string{"02 "} + bits);
    node.expect_bytes(kReadSpeedReference, bits);
  }
  node.send(kPosition, 0.0F);
  node.send(kSpeed, 0.0F);
  node.send(kCalibrationUnknown);
}

void apart(NodeBench& node) {
  node.send(kPosition, 0.25F);
  node.send(kSpeed, 0.75F);
  node.expect_number(kReadPositionReference, 0.25F);
  node.send(kPosition, 0.5F);
  node.expect_number(kReadSpeedReference, 0.75F);
}

void voltage_apart(NodeBench& node) {
  node.send(kPosition, 0.25F);
  node.send(kSpeed, 0.75F);
  node.send(kVoltage, 1.0F);
  node.send(kCalibrationUnknown);
  node.expect_number(kReadPositionReference, 0.25F);
  node.expect_number(kReadSpeedReference, 0.75F);
}

void last(NodeBench& node) {
  for (const float value : {0.25F, 0.5F, -0.75F}) node.send(kPosition, value);
  node.expect_number(kReadPositionReference, -0.75F);
}

template <CommandId between>
void kept_over(NodeBench& node) {
  node.send(kPosition, 0.25F);
  node.send(kSpeed, 0.75F);
  node.send(kDisable);  // nothing shall run, whatever comes
  node.send(between);
  node.expect_number(kReadPositionReference, 0.25F);
  node.expect_number(kReadSpeedReference, 0.75F);
}

void short_float(NodeBench& node) {
  node.send(kPosition, 1.0F);
  for (const auto* const cut : {"01", "01 00", "01 00 00", "01 00 00 00"}) {
    node.send_bytes(cut);
    node.expect_number(kReadPositionReference, 1.0F);
  }
}

void short_mode(NodeBench& node) {
  for (const auto* const cut : {"01", "02 00", "03 00 00", "01 00 00 00"}) {
    node.send_bytes(cut);
    node.expect_status(MotorStatus::kDisabled);
  }
}

void short_joined(NodeBench& node) {
  node.send(kPosition, 1.0F);
  node.send_bytes("01 00 00");
  node.send_bytes("02 3F");
  node.expect_number(kReadPositionReference, 1.0F);
}

void payload_no_command(NodeBench& node) {
  node.send_bytes("00 1F");
  node.expect_status(MotorStatus::kDisabled);
  node.send_bytes("10 1F");
  node.expect_status(MotorStatus::kDisabled);
}

void zero(NodeBench& node) {
  node.send(kCalibrateAngle, 1.0F);
  node.send(kCalibrateZero);
  node.expect_number(kReadAngle, 0.0F);
}

/// A real shaft turns by itself a little.
constexpr double kCount = 1e-4;  // of any known motor, and a little more

void angle(NodeBench& node) {
  for (const float wanted : {1.0F, -0.52F, 1.5707964F}) {
    node.send(kCalibrateAngle, wanted);
    node.expect_near(kReadAngle, static_cast<double>(wanted), kCount);
  }
}

void truncates(NodeBench& node) {
  node.send(kCalibrateAngle, 1.0F);
  node.expect_bytes(kReadAngle, node.motor().one_radian);
}

void truncates_negative(NodeBench& node) {
  node.send_bytes("11 B8 1E 05 BF");  // -0.52
  node.expect_bytes(kReadAngle, node.motor().minus_half);
}

void large(NodeBench& node) {
  node.send(kCalibrateAngle, 100.0F);
  node.expect_near(kReadAngle, 100.0, kCount);
}

void scale(NodeBench& node) {
  node.turn(1);
  node.expect_bytes(kReadAngle, node.motor().one_count);
  node.turn(999);
  node.expect_bytes(kReadAngle, node.motor().thousand_counts);
}

void sign(NodeBench& node) {
  node.turn(-1);
  const auto count = decode_float(slice<4>(Bytes{*from_hex(node.motor().one_count)}, 0));
  node.expect_number(kReadAngle, -count);
}

void uncalibrated(NodeBench& node) {
  node.expect_status(MotorStatus::kNeedsCalibration);
  expect_turned(node);
}

void while_disabled(NodeBench& node) {
  node.send(kCalibrateZero);
  node.tick();
  expect_turned(node);
}

void over_disable(NodeBench& node) {
  node.send(kCalibrateZero);
  node.turn(1000);
  node.send(kDisable);
  node.expect_bytes(kReadAngle, node.motor().thousand_counts);
}

void zero_while_enabled(NodeBench& node) {
  node.send(kCalibrateAngle, 1.0F);
  node.send(kVoltage, 0.0F);
  node.send(kCalibrateZero);
  node.expect_number(kReadAngle, 0.0F);
}

void angle_while_enabled(NodeBench& node) {
  node.send(kCalibrateZero);
  node.send(kVoltage, 0.0F);
  node.send(kCalibrateAngle, 1.0F);
  node.expect_near(kReadAngle, 1.0, kCount);
}

void over_forgetting(NodeBench& node) {
  node.turn(1000);
  node.send(kCalibrationUnknown);
  node.expect_bytes(kReadAngle, node.motor().thousand_counts);
}

constexpr Case state(std::string_view requirement, std::string_view rule, void (*run)(Bench&),
                     Start start) {
  return from(start, Hazard::kState, requirement, rule, run);
}

constexpr Case kCases[] = {
    state("morap.reference.position", "Values of all signs, and the smallest.", on<position>,
          kUncalibrated),
    state("morap.reference.speed", "Values of all signs, and the smallest.", on<speed>,
          kUncalibrated),
    state("morap.reference.any-bits", "Not a number, infinity, the largest; nothing runs.",
          on<any_bits>, kUncalibrated),
    state("morap.reference.apart", "Both are written in turn.", on<apart>, kUncalibrated),
    state("morap.reference.voltage-apart", "Both, then a voltage.", on<voltage_apart>,
          kUncalibrated),
    state("morap.reference.last", "Three are written.", on<last>, kUncalibrated),
    state("morap.reference.over-disable", "Both, then 0.", on<kept_over<kDisable>>, kUncalibrated),
    state("morap.reference.over-forgetting", "Both, then 31.", on<kept_over<kCalibrationUnknown>>,
          kUncalibrated),
    state("morap.reference.over-calibration", "Both, then 16.", on<kept_over<kCalibrateZero>>,
          kUncalibrated),
    state("morap.write.short-float", "Cut at every byte.", on<short_float>, kUncalibrated),
    state("morap.write.short-mode", "Cut references of all kinds.", on<short_mode>, kDisabled),
    state("morap.write.short-joined", "The second write would complete the first.",
          on<short_joined>, kUncalibrated),
    state("morap.write.payload-no-command", "31 behind 0 and behind 16.", on<payload_no_command>,
          kDisabled),
    state("morap.calibrate.zero", "To 1 rad, then to 0.", on<zero>, kUncalibrated),
    state("morap.calibrate.angle", "Angles of both signs.", on<angle>, kUncalibrated),
    state("morap.calibrate.truncates", "1 rad, on a held shaft.", on<truncates>, kFresh),
    state("morap.calibrate.truncates-negative", "-0.52 rad, on a held shaft.",
          on<truncates_negative>, kFresh),
    state("morap.calibrate.large", "100 rad.", on<large>, kUncalibrated),
    state("morap.angle.scale", "One count and a thousand.", on<scale>, kFresh),
    state("morap.angle.sign", "One count down.", on<sign>, kFresh),
    state("morap.angle.uncalibrated", "A thousand counts before any calibration.", on<uncalibrated>,
          kFresh),
    state("morap.angle.disabled", "A thousand counts while disabled.", on<while_disabled>, kFresh),
    state("morap.angle.over-disable", "A thousand counts, then 0.", on<over_disable>, kFresh),
    state("morap.calibrate.zero-while-enabled", "0 V on a held shaft, then 16.",
          on<zero_while_enabled>, kFresh),
    state("morap.calibrate.angle-while-enabled", "0 V on a held shaft, then 17.",
          on<angle_while_enabled>, kFresh),
    state("morap.angle.over-forgetting", "A thousand counts, then 31.", on<over_forgetting>,
          kFresh),
};

}  // namespace

std::span<const Case> reference_cases() noexcept { return kCases; }

}  // namespace armjig::morap::conformance
