// SPDX-License-Identifier: Apache-2.0
// Levels are steps of 48/1024 V. 0.75 V are 16, 0.1875 V are 4; others are the nearest.
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr std::uint16_t kRate = 200;

ControllerSet position_set(std::initializer_list<float> d, std::initializer_list<float> c,
                           std::initializer_list<float> f, float integral = 0.0F) {
  return {ControllerKind::kPosition, kRate, filter(d), filter(c), filter(f), integral};
}

/// Up to the tick at which the loop computes for the first time.
void run(NodeBench& node, const ControllerSet& set, float reference) {
  const bool is_speed = set.kind == ControllerKind::kSpeed;
  node.send(set);
  node.send(kCalibrateZero);
  node.tick();
  node.send(is_speed ? kSpeed : kPosition, reference);
  node.tick(set.rate_hz);
}

/// So many counts, and the gain with which their angle gives 0.25 V.
constexpr int kCounts = 10;
float gain_of_counts(NodeBench& node) {
  const auto count = decode_float(slice<4>(Bytes{*from_hex(node.motor().one_count)}, 0));
  return 0.25F / (static_cast<float>(kCounts) * count);
}

/// The same behind a turn, with a reference of 0.
void run_turned(NodeBench& node, const ControllerSet& set) {
  node.send(set);
  node.send(kCalibrateZero);
  node.turn(kCounts);
  node.tick();
  node.send(kPosition, 0.0F);
  node.tick(kRate);
}

void one_tick_late(NodeBench& node) {
  run(node, proportional(kRate, 1.0F), 0.75F);
  node.expect_levels(0);
  node.expect_levels_at_ticks({16});
}

/// One of the stored ones, which of them depends on the motor.
void stored(NodeBench& node, CommandId mode, float reference, std::uint16_t rate_hz,
            std::initializer_list<int> levels) {
  node.send(kCalibrateZero);
  node.tick();
  node.send(mode, reference);
  node.tick(rate_hz);
  node.expect_levels_at_ticks(levels);
}

void position_default(NodeBench& node) {
  if (node.motor().name == "dcx22l") {
    stored(node, kPosition, 1.0F, 625, {15, 29, 43, 57, 69});
  } else {
    stored(node, kPosition, 1.0F, 625, {9, 18, 26, 34, 34});
  }
}

void speed_default(NodeBench& node) {
  if (node.motor().name == "dcx22l") {
    stored(node, kSpeed, 0.2F, 500, {5, 8, 12, 14});
  } else {
    stored(node, kSpeed, 0.2F, 400, {2, 4, 6, 7});
  }
}

void reference_order(NodeBench& node) {
  run(node, position_set({0.0F}, {1.0F, 2.0F}, {0.0F}), 0.25F);
  node.send(kPosition, 0.5F);
  node.expect_levels_at_ticks({16, 27, 32});  // 0.25 + 2 * 0.5 = 1.25 V, then 1.5 V
}

void measured_order(NodeBench& node) {
  const float gain = gain_of_counts(node);
  run(node, position_set({gain, 2 * gain}, {0.0F}, {0.0F}), 0.0F);
  node.turn(kCounts);
  node.expect_levels_at_ticks({0, -11, -16});  // -0.5 V, then -0.75 V
}

void feedback_of_output(NodeBench& node) {
  run(node, position_set({0.0F}, {0.375F}, {-0.5F}), 1.0F);
  node.expect_levels_at_ticks({8, 12, 14, 15});  // half of the one before, and 8
}

void output_order(NodeBench& node) {
  run(node, position_set({0.0F}, {0.375F}, {-0.5F, 0.0F}), 1.0F);
  node.expect_levels_at_ticks({8, 8, 12, 12, 14});  // half of the one before that, and 8
}

void begins_with_reference(NodeBench& node) {
  run(node, position_set({0.0F}, {1.0F, 2.0F}, {0.0F}), 0.25F);
  node.expect_levels_at_ticks({16, 16});
}

void begins_with_angle(NodeBench& node) {
  const float gain = gain_of_counts(node);
  run_turned(node, position_set({gain, gain}, {0.0F}, {0.0F}));
  node.expect_levels_at_ticks({-11, -11});  // twice -0.25 V
}

void integral_of_reference(NodeBench& node) {
  run(node, position_set({0.0F}, {0.0F}, {0.0F}, 0.25F), 0.75F);
  node.expect_levels_at_ticks({4, 8, 12, 16});
}

void integral_of_angle(NodeBench& node) {
  run_turned(node, position_set({0.0F}, {0.0F}, {0.0F}, 0.75F * gain_of_counts(node)));
  node.expect_levels_at_ticks({-4, -8, -12});
}

void negative_integral(NodeBench& node) {
  run(node, position_set({0.0F}, {0.5F}, {0.0F}, -0.25F), 0.75F);
  node.expect_levels_at_ticks({8, 8, 8});
}

void anti_windup(NodeBench& node) {
  const int most = node.motor().standstill_levels;
  run(node, position_set({0.0F}, {10.0F}, {0.0F}, 0.375F), 1.0F);
  node.expect_levels_at_ticks({most, most, most});
  node.send(kPosition, 0.0F);
  node.expect_levels_at_ticks({most, 8, 8});  // of the first sample only
}

void current_limit(NodeBench& node) {
  const int most = node.motor().standstill_levels;
  run(node, proportional(kRate, 10.0F), 1.0F);
  node.expect_levels_at_ticks({most});
  node.send(kPosition, -1.0F);
  node.expect_levels_at_ticks({most, -most});
}

/// 67 counts in 5 ms: a fifth of the back-EMF of that speed is 0.753 V with one motor and 0.704 V
/// with the other, and then four fifths of it each time.
void current_limit_speed(NodeBench& node) {
  run(node, proportional(kRate, 10.0F), 1.0F);
  node.tick();
  node.turn(67);
  node.tick();
  if (node.motor().name == "dcx22l") {
    node.expect_levels_at_ticks({85, 82, 79, 77});
  } else {
    node.expect_levels_at_ticks({49, 46, 44, 42});
  }
}

void voltage_limit(NodeBench& node) {
  run(node, proportional(kRate, 100.0F), 1.0F);
  node.tick();
  node.turn(20'000);
  node.tick();
  node.expect_levels_at_ticks({427});
}

void speed_measured(NodeBench& node) {
  constexpr std::uint16_t kSpeedRate = 400;
  auto set = proportional(kSpeedRate, 0.0F, ControllerKind::kSpeed);
  set.d = filter({gain_of_counts(node) / static_cast<float>(kSpeedRate)});
  run(node, set, 0.0F);
  node.turn(kCounts);
  node.expect_levels_at_ticks({0, -5, 0});  // -0.25 V
}

void own_controller(NodeBench& node) {
  node.send(proportional(kRate, 2.0F, ControllerKind::kSpeed));
  node.tick();
  run(node, proportional(kRate, 1.0F), 0.75F);
  node.expect_levels_at_ticks({16});
  node.send(kSpeed, 0.75F);
  node.expect_levels_at_ticks({16, 32});
}

void own_reference(NodeBench& node) {
  node.send(proportional(kRate, 1.0F, ControllerKind::kSpeed));
  node.tick();
  run(node, proportional(kRate, 1.0F), 0.75F);
  node.send(kSpeed, 0.375F);
  node.expect_levels_at_ticks({16, 8});
  node.send(kPosition, 0.75F);
  node.expect_levels_at_ticks({8, 16});
}

void new_mode_resets(NodeBench& node) {
  run(node, position_set({0.0F}, {0.0F}, {0.0F}, 0.25F), 0.75F);
  node.expect_levels_at_ticks({4, 8});
  node.send(kVoltage, 0.0F);
  node.expect_levels_at_ticks({0});
  node.send(kPosition, 0.75F);
  node.expect_levels_at_ticks({0, 4, 8});
}

void new_reference_goes_on(NodeBench& node) {
  run(node, position_set({0.0F}, {0.0F}, {0.0F}, 0.25F), 0.75F);
  node.send(kPosition, 0.375F);
  node.expect_levels_at_ticks({4, 6, 8});
}

void new_parameters_reset(NodeBench& node) {
  run(node, position_set({0.0F}, {0.0F}, {0.0F}, 0.25F), 0.75F);
  node.expect_levels_at_ticks({4, 8});
  node.send(proportional(kRate, 1.0F, ControllerKind::kSpeed));
  node.expect_levels_at_ticks({12, 4, 8});
}

void reenabled_goes_on(NodeBench& node) {
  run(node, position_set({0.0F}, {0.0F}, {0.0F}, 0.25F), 0.75F);
  node.expect_levels_at_ticks({4, 8});
  node.send(kDisable);
  node.send(kPosition, 0.75F);
  node.expect_levels_at_ticks({12, 16});
}

constexpr Case loop(std::string_view requirement, std::string_view rule, void (*run)(Bench&)) {
  return from(kFresh, Hazard::kProgram, requirement, rule, run);
}

constexpr Case kCases[] = {
    loop("morap.loop.one-tick-late", "A gain of 1.", on<one_tick_late>),
    loop("morap.loop.position-default", "Tick by tick.", on<position_default>),
    loop("morap.loop.speed-default", "Tick by tick.", on<speed_default>),
    loop("morap.loop.reference-order", "1 and 2, with another reference on the way.",
         on<reference_order>),
    loop("morap.loop.measured-order", "1 and 2, with a turn of the shaft.", on<measured_order>),
    loop("morap.loop.feedback-of-output", "-0.5.", on<feedback_of_output>),
    loop("morap.loop.output-order", "-0.5 and 0.", on<output_order>),
    loop("morap.loop.begins-with-reference", "Two samples of it count.", on<begins_with_reference>),
    loop("morap.loop.begins-with-angle", "Two samples of it count.", on<begins_with_angle>),
    loop("morap.loop.integral-of-reference", "Nothing but an integrator.",
         on<integral_of_reference>),
    loop("morap.loop.integral-of-angle", "Nothing but an integrator.", on<integral_of_angle>),
    loop("morap.loop.negative-integral", "-0.25 beside a gain of 0.5.", on<negative_integral>),
    loop("morap.loop.anti-windup", "Three limited samples, then a reference of 0.",
         on<anti_windup>),
    loop("morap.loop.current-limit", "10 V and -10 V.", on<current_limit>),
    loop("morap.loop.current-limit-speed", "10 V, and one turn of the shaft.",
         on<current_limit_speed>),
    loop("morap.loop.voltage-limit", "100 V, and a fast turn.", on<voltage_limit>),
    loop("morap.loop.speed-measured", "One turn at 400 Hz.", on<speed_measured>),
    loop("morap.loop.own-controller", "Gains of 1 and 2.", on<own_controller>),
    loop("morap.loop.own-reference", "0.75 and 0.375.", on<own_reference>),
    loop("morap.loop.new-mode-resets", "An integrator, with a voltage between.",
         on<new_mode_resets>),
    loop("morap.loop.new-reference-goes-on", "An integrator.", on<new_reference_goes_on>),
    loop("morap.loop.new-parameters-reset", "An integrator, and the speed controller.",
         on<new_parameters_reset>),
    loop("morap.loop.reenabled-goes-on", "An integrator.", on<reenabled_goes_on>),
};

}  // namespace

std::span<const Case> loop_cases() noexcept { return kCases; }

}  // namespace armjig::morap::conformance
