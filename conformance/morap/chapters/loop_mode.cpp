// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/loop_cases.hpp"
#include "conformance/morap/program_cases.hpp"

namespace armjig::morap::conformance {
namespace {

void has_its_own_controller(NodeBench& node) {
  node.send(proportional(node.loop_rate(), 2.0F, ControllerKind::kSpeed));
  node.tick();
  run_loop(node, proportional(node.loop_rate(), 1.0F), 0.75F);
  node.expect_levels_at_ticks({16});
  node.send(kSpeed, 0.75F);
  node.expect_levels_at_ticks({16, 32});
}

void has_its_own_reference(NodeBench& node) {
  node.send(proportional(node.loop_rate(), 1.0F, ControllerKind::kSpeed));
  node.tick();
  run_loop(node, proportional(node.loop_rate(), 1.0F), 0.75F);
  node.send(kSpeed, 0.375F);
  node.expect_levels_at_ticks({16, 8});
  node.send(kPosition, 0.75F);
  node.expect_levels_at_ticks({8, 16});
}

void begins_again_once_disabled(NodeBench& node) {
  run_slow_loop(node);
  node.expect_levels(16);
  node.send(kDisable);
  node.tick(kIdleRateHz);
  node.expect_levels(0);
  node.send(kPosition, 0.375F);
  node.tick(node.loop_rate());
  node.expect_levels(0);
  node.expect_levels_at_ticks({8});
}

/// References that differ by less than a 256th.
void follows_small_references(NodeBench& node) {
  constexpr float kSmall = 1.5F / 256.0F;
  auto set = blind_set(node, {128.0F}, {0.0F});
  run_loop(node, set, kSmall);
  node.expect_levels_at_ticks({16});
  node.send(kPosition, kSmall / 2);
  node.expect_levels_at_ticks({16, 8});
  node.send(kDisable);
  node.tick(kIdleRateHz);
  set.kind = ControllerKind::kSpeed;
  run_loop(node, set, kSmall);
  node.expect_levels_at_ticks({16});
  node.send(kSpeed, kSmall / 2);
  node.expect_levels_at_ticks({16, 8});
}

void begins_again_in_another_mode(NodeBench& node) {
  run_integrator(node);
  node.expect_levels_at_ticks({4, 8});
  node.send(kVoltage, 0.0F);
  node.tick(kIdleRateHz);
  node.expect_levels(0);
  node.send(kPosition, kFar);
  node.tick(node.loop_rate());
  node.expect_levels(0);
  node.expect_levels_at_ticks({4, 8});
}

/// Also without any other between: what the loop of positions had summed is not that of speeds.
void begins_again_at_once_in_another_mode(NodeBench& node) {
  auto set = blind_set(node, {0.0F}, {0.0F}, 0.0025F);
  set.kind = ControllerKind::kSpeed;
  node.send(set);
  node.tick();
  run_integrator(node);
  node.expect_levels_at_ticks({4, 8});
  node.send(kSpeed, kFar);
  node.expect_levels_at_ticks({12, 4, 8});
}

/// What a limit holds back is held back of the same loop only.
void begins_again_after_a_limit(NodeBench& node) {
  constexpr float kTooFar = 1000.0F;
  run_loop(node, blind_set(node, {0.01F}, {0.0F}, 0.0025F), kTooFar);
  node.expect_levels_at_ticks({node.motor().standstill_levels});
  node.send(kVoltage, 0.0F);
  node.tick(kIdleRateHz);
  node.send(kPosition, kFar);
  node.tick(node.loop_rate());
  node.expect_levels_at_ticks({20, 24});
}

void goes_on_with_another_reference(NodeBench& node) {
  run_integrator(node);
  node.send(kPosition, kFar / 2);
  node.expect_levels_at_ticks({4, 6, 8});
}

void speed_goes_on_with_another_reference(NodeBench& node) {
  auto set = blind_set(node, {0.0F}, {0.0F}, 0.0025F);
  set.kind = ControllerKind::kSpeed;
  run_loop(node, set, kFar);
  node.expect_levels_at_ticks({4, 8});
  node.send(kSpeed, kFar / 2);
  node.expect_levels_at_ticks({12, 14, 16});
}

/// Those of the other controller, whose rate is none of this loop's.
void begins_again_with_parameters(NodeBench& node) {
  run_integrator(node);
  node.expect_levels_at_ticks({4, 8});
  const auto other_rate = static_cast<std::uint16_t>(2 * node.loop_rate());
  node.send(proportional(other_rate, 1.0F, ControllerKind::kSpeed));
  node.expect_levels_at_ticks({12, 4, 8});
}

void begins_again_with_a_dropped_set(NodeBench& node) {
  run_integrator(node);
  node.expect_levels_at_ticks({4, 8});
  program(node, kOtherKind);
  node.expect_levels_at_ticks({12, 4, 8});
}

void goes_on_when_enabled_again(NodeBench& node) {
  run_integrator(node);
  node.expect_levels_at_ticks({4, 8});
  node.send(kDisable);
  node.send(kPosition, kFar);
  node.expect_levels_at_ticks({12, 16});
}

/// What a running loop does not mind: its shaft stands at 0, or hardly matters to it.
void goes_on_whatever_else(NodeBench& node) {
  run_integrator(node);
  node.expect_levels_at_ticks({4});
  node.send(kCalibrateZero);
  node.expect_levels_at_ticks({8});
  node.send(kCalibrateAngle, 0.0F);
  node.expect_levels_at_ticks({12});
  node.send(kBrake14);
  node.send(kBrake15);
  node.expect_levels_at_ticks({16});
  node.send_bytes("20 00 C8 00 05");  // refused
  node.send_bytes("06");              // means nothing
  node.expect_levels_at_ticks({20});
}

/// An integrator has run. In a position mode without calibration the time between ticks is that of
/// its loop, and calibrating lets it run.
void latch_position(NodeBench& node, float reference) {
  node.send(kCalibrationUnknown);
  node.tick(kIdleRateHz);
  node.send(kPosition, reference);
  node.tick(node.loop_rate());
}

void begins_again_after_calibration(NodeBench& node) {
  run_integrator(node);
  node.expect_levels_at_ticks({4, 8});
  latch_position(node, kFar);
  node.send(kCalibrateZero);
  node.tick();
  node.expect_levels(0);
  node.expect_levels_at_ticks({4, 8});
}

void begins_with_latest_reference(NodeBench& node) {
  run_loop(node, blind_set(node, {1.0F, 2.0F}, {0.0F}), 0.75F);
  node.tick();
  latch_position(node, 0.5F);
  node.send(kPosition, 0.25F);
  node.send(kCalibrateZero);
  node.tick();
  node.expect_levels_at_ticks({16, 16});
}

constexpr Clause kLoopModeClauses[] = {
    must("morap.loop.own-controller", "Each mode runs with its own controller.",
         "recording static-mode-switch-locked", Profiles::kFirmware),
    loop("Gains of 1 and 2.", on<has_its_own_controller>),
    variant("slowly", slowly(on<has_its_own_controller>)),

    must("morap.loop.own-reference", "Each mode follows its own reference.",
         "recording static-mode-switch-locked", Profiles::kFirmware),
    loop("0.75 and 0.375.", on<has_its_own_reference>),
    variant("slowly", slowly(on<has_its_own_reference>)),
    variant("slowly.small", slowly(on<follows_small_references>)),

    must("morap.loop.new-mode-resets", "Another mode begins its loop again.",
         "recording static-mode-switch-locked", Profiles::kFirmware),
    loop("An integrator, with a voltage between.", on<begins_again_in_another_mode>),
    variant("slowly", slowly(on<begins_again_in_another_mode>)),

    variant("slowly.at-once", slowly(on<begins_again_at_once_in_another_mode>)),
    variant("slowly.disabled", slowly(on<begins_again_once_disabled>)),
    variant("limited", loop("One that was limited.", on<begins_again_after_a_limit>)),
    variant("slowly.limited", slowly(on<begins_again_after_a_limit>)),

    must("morap.loop.new-reference-goes-on", "Another reference in the same mode does not.",
         "recording static-position-locked", Profiles::kFirmware),
    loop("An integrator.", on<goes_on_with_another_reference>),
    variant("slowly", slowly(on<goes_on_with_another_reference>)),

    variant("speed", loop("An integrator of speed.", on<speed_goes_on_with_another_reference>)),
    variant("slowly.speed", slowly(on<speed_goes_on_with_another_reference>)),

    must("morap.loop.new-parameters-reset",
         "Newly installed parameters of any controller begin the running loop again.",
         "firmware, tick", Profiles::kFirmware),
    loop("An integrator, and the speed controller.", on<begins_again_with_parameters>),
    variant("slowly", slowly(on<begins_again_with_parameters>)),

    must("morap.loop.dropped-parameters-reset",
         "So do parameters of a kind that there is not, which are used nowhere.",
         "firmware, tick and identifier 32", Profiles::kFirmware),
    loop("An integrator.", on<begins_again_with_a_dropped_set>),
    variant("slowly", slowly(on<begins_again_with_a_dropped_set>)),

    must("morap.loop.reenabled-goes-on",
         "A loop that was disabled and enabled between two ticks goes on.",
         "recording static-reenable-within-tick", Profiles::kFirmware),
    loop("An integrator.", on<goes_on_when_enabled_again>),
    variant("slowly", slowly(on<goes_on_when_enabled_again>)),

    must(
        "morap.loop.else-goes-on",
        "Calibrating, the brake, refused parameters and unknown identifiers do not begin a running "
        "loop again.",
        "firmware, tick; recording loop-calibrate-moving", Profiles::kFirmware),
    loop("An integrator.", on<goes_on_whatever_else>),
    variant("slowly", slowly(on<goes_on_whatever_else>)),

    must("morap.loop.latched-begins-anew",
         "A loop whose mode came before calibration begins again with it.",
         "firmware, tick: the reset waits; recording loop-uncalibrated", Profiles::kFirmware),
    loop("An integrator that has run before.", on<begins_again_after_calibration>),
    variant("slowly", slowly(on<begins_again_after_calibration>)),
    variant("reference",
            loop("With the reference of that time.", on<begins_with_latest_reference>)),
    variant("slowly.reference", slowly(on<begins_with_latest_reference>)),
};

}  // namespace

Chapter loop_mode_chapter() { return chapter("Loops and modes", kLoopModeClauses); }

}  // namespace armjig::morap::conformance
