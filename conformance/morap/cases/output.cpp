// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

void voltage_close(NodeBench& node) {
  for (const float volts : {0.5F, 1.0F, 1.5F}) {
    node.send(kVoltage, volts);
    node.settle();
    node.expect_near(kReadVoltage, static_cast<double>(volts), 0.05);
  }
  node.send(kDisable);
}

void voltage_grid(NodeBench& node) {
  struct Row {
    float volts;
    int levels;
  };
  for (const auto& [volts, levels] :
       {Row{0.0234F, 0}, {0.0235F, 1}, {0.5F, 11}, {1.0F, 21}, {1.5F, 32}}) {
    node.about(fmt::format("asked for {} V", volts));
    node.send(kVoltage, volts);
    node.settle();
    node.expect_levels(levels);
  }
  node.send(kDisable);
}

void voltage_sign(NodeBench& node) {
  node.send(kVoltage, -1.5F);
  node.settle();
  node.expect_levels(-32);
  node.send(kDisable);
}

void voltage_uncalibrated(NodeBench& node) {
  node.send(kVoltage, 1.5F);
  node.settle();
  node.expect_levels(0);
  node.send(kCalibrationUnknown);
}

template <CommandId end>
void voltage_ended(NodeBench& node) {
  node.send(kVoltage, 1.5F);
  node.settle();
  node.expect_levels(32);
  node.send(end);
  node.settle();
  node.expect_levels(0);
}

/// Calibrated and ticking, with everything that was pending done.
void calibrate(NodeBench& node) {
  node.send(kCalibrateZero);
  node.tick();
}

/// In a mode of 200 Hz: the levels right before and right behind the next tick.
void expect_step_at_tick(NodeBench& node, int before, int behind, std::uint16_t rate_hz = 0) {
  node.send(kReadVoltage);
  node.wait_for_tick();
  node.about("right before the tick");
  node.expect_read_levels(before);
  node.tick(rate_hz);
  node.about("right behind the tick");
  node.expect_read_levels(behind);
  node.about({});
}

void voltage_at_tick(NodeBench& node) {
  calibrate(node);
  node.send(kVoltage, 1.5F);
  expect_step_at_tick(node, 0, 32);
}

void disabled_at_tick(NodeBench& node) {
  calibrate(node);
  node.send(kVoltage, 1.5F);
  node.tick();
  node.send(kDisable);
  expect_step_at_tick(node, 32, 0);
}

void current_limit(NodeBench& node) {
  calibrate(node);
  node.send(kVoltage, 10.0F);
  node.tick();
  node.expect_levels(node.motor().standstill_levels);
}

void current_limit_negative(NodeBench& node) {
  calibrate(node);
  node.send(kVoltage, -10.0F);
  node.tick();
  node.expect_levels(-node.motor().standstill_levels);
}

constexpr int kMostLevels = 427;  // 20.015625 V

/// At 1 V; to the first tick behind it.
void turn_fast(NodeBench& node) {
  calibrate(node);
  node.send(kVoltage, 1.0F);
  node.ticks(2);
  node.turn(1000);
  node.tick();
}

void overspeed(NodeBench& node) {
  turn_fast(node);
  node.expect_levels(kMostLevels);
}

void speed_unfiltered(NodeBench& node) {
  turn_fast(node);
  node.about("one tick behind the turn");
  node.tick();
  node.expect_levels(21);
}

/// Behind a tick with a direct voltage.
void expect_direct(NodeBench& node, float volts, int levels) {
  node.about(fmt::format("asked for {} V", volts));
  node.send(kDirectVoltage, volts);
  node.tick();
  node.expect_levels(levels);
}

void no_current_limit(NodeBench& node) {
  calibrate(node);
  expect_direct(node, 10.0F, 213);
}

void direct_limit(NodeBench& node) {
  calibrate(node);
  expect_direct(node, 20.0F, kMostLevels);
  expect_direct(node, 24.0F, kMostLevels);
  expect_direct(node, -30.0F, -kMostLevels);
}

void direct_rounding(NodeBench& node) {
  calibrate(node);
  expect_direct(node, 0.0234F, 0);
  expect_direct(node, 0.0235F, 1);
  expect_direct(node, -0.0234F, 0);
  expect_direct(node, -0.0235F, -1);
  expect_direct(node, 5.0F, 107);
  expect_direct(node, 12.0F, 256);
  expect_direct(node, -15.0F, -320);
}

void direct_infinite(NodeBench& node) {
  calibrate(node);
  expect_direct(node, std::numeric_limits<float>::infinity(), kMostLevels);
}

/// The levels for a current in amperes at standstill.
int levels_of_current(const Motor& motor, double amperes) {
  const auto resistance = static_cast<double>(motor.eeprom(0).motor.resistance);
  return static_cast<int>(std::lround(amperes * resistance * 1024 / 48));
}

double torque_constant(const Motor& motor) {
  const auto constants = motor.eeprom(0).motor;
  return static_cast<double>(constants.efficiency) *
         static_cast<double>(constants.torque_constant) * static_cast<double>(constants.gear_ratio);
}

void torque_standstill(NodeBench& node) {
  calibrate(node);
  for (const float torque : {2.0F, -3.0F}) {
    node.about(fmt::format("{} N m", torque));
    node.send(kTorque, torque);
    node.tick();
    const auto amperes = static_cast<double>(torque) / torque_constant(node.motor());
    node.expect_levels(levels_of_current(node.motor(), amperes));
  }
}

void torque_limit(NodeBench& node) {
  calibrate(node);
  for (const int sign : {1, -1}) {
    node.send(kTorque, static_cast<float>(10 * sign));
    node.tick();
    node.expect_levels(sign * node.motor().standstill_levels);
  }
}

void torque_motion(NodeBench& node) {
  calibrate(node);
  node.send(kTorque, 0.0F);
  node.ticks(2);
  node.turn(100);
  node.tick();
  // K n times 100 counts in 5 ms.
  const auto constants = node.motor().eeprom(0).motor;
  const double counts_per_turn = 4.0 * static_cast<double>(constants.pulses_per_turn);
  const double volts = static_cast<double>(constants.torque_constant) * 100 * 2 * 3.14159265358979 /
                       counts_per_turn / 0.005;
  node.expect_levels(static_cast<int>(std::lround(volts * 1024 / 48)));
  node.tick();
  node.expect_levels(0);
}

void current_scale(NodeBench& node) {
  struct Row {
    int code;
    const char* bytes;
  };
  for (const auto& [code, bytes] : {Row{1, "8F D6 2A 3B"},
                                    {100, "A0 77 85 3E"},
                                    {575, "F5 DB BF 3F"},
                                    {1000, "87 D5 26 40"},
                                    {2048, "8F D6 AA 40"},
                                    {4095, "E1 CB 2A 41"}}) {
    node.about(fmt::format("code {}", code));
    node.touch("adc", code);
    node.expect_bytes(kReadCurrent, bytes);
  }
}

void current_zero(NodeBench& node) { node.expect_number(kReadCurrent, 0.0F); }

void idle_rate(NodeBench& node) {
  calibrate(node);
  node.ticks(40);
  node.send(kVoltage, 1.5F);
  expect_step_at_tick(node, 0, 32);
}

/// Runs a loop, whose third step is then the first with another reference.
void expect_loop_rate(NodeBench& node, std::uint16_t rate_hz, int ticks) {
  node.send(proportional(rate_hz, 1.0F));
  node.send(kCalibrateZero);
  node.tick();
  node.send(kPosition, 0.75F);
  node.tick(rate_hz);
  expect_step_at_tick(node, 0, 16);
  node.ticks(ticks);
  node.send(kPosition, 1.5F);
  node.tick();
  expect_step_at_tick(node, 16, 32);
}

void loop_rate(NodeBench& node) { expect_loop_rate(node, 320, 60); }

void slow_rate(NodeBench& node) { expect_loop_rate(node, 50, 10); }

void uncalibrated_rate(NodeBench& node) {
  node.send(proportional(50, 1.0F));
  node.tick();
  node.send(kPosition, 0.75F);
  node.tick(50);
  node.tick();
  node.send(kCalibrateZero);
  node.send(kVoltage, 1.5F);
  expect_step_at_tick(node, 0, 32);
}

void back_to_idle(NodeBench& node) {
  node.send(proportional(320, 1.0F));
  calibrate(node);
  node.send(kPosition, 0.75F);
  node.tick(320);
  node.ticks(2);
  node.send(kVoltage, 0.0F);
  node.tick(200);
  node.ticks(20);
  node.send(kVoltage, 1.5F);
  expect_step_at_tick(node, 0, 32);
}

constexpr Case fresh(std::string_view requirement, std::string_view rule, void (*run)(Bench&)) {
  return from(kFresh, Hazard::kMove, requirement, rule, run);
}
constexpr Case moving(std::string_view requirement, std::string_view rule, void (*run)(Bench&)) {
  return from(kDisabled, Hazard::kMove, requirement, rule, run);
}

constexpr Case kCases[] = {
    moving("morap.voltage.close", "Up to 1.5 V.", on<voltage_close>),
    moving("morap.voltage.grid", "Up to 1.5 V, around a border too.", on<voltage_grid>),
    moving("morap.voltage.sign", "-1.5 V.", on<voltage_sign>),
    from(kUncalibrated, Hazard::kMove, "morap.voltage.uncalibrated", "1.5 V.",
         on<voltage_uncalibrated>),
    moving("morap.voltage.disabled", "1.5 V, then 0.", on<voltage_ended<kDisable>>),
    moving("morap.voltage.forgotten", "1.5 V, then 31.", on<voltage_ended<kCalibrationUnknown>>),
    fresh("morap.voltage.at-tick", "1.5 V between ticks.", on<voltage_at_tick>),
    fresh("morap.voltage.disabled-at-tick", "0 between ticks.", on<disabled_at_tick>),
    fresh("morap.voltage.current-limit", "10 V.", on<current_limit>),
    fresh("morap.voltage.current-limit-negative", "-10 V.", on<current_limit_negative>),
    fresh("morap.voltage.overspeed", "1000 counts in a tick.", on<overspeed>),
    fresh("morap.voltage.speed-unfiltered", "1000 counts in a tick, and the next tick.",
          on<speed_unfiltered>),
    fresh("morap.direct.no-current-limit", "10 V at standstill.", on<no_current_limit>),
    fresh("morap.direct.limit", "More than 20 V of both signs.", on<direct_limit>),
    fresh("morap.direct.rounding", "Around borders of both signs.", on<direct_rounding>),
    fresh("morap.direct.infinite", "Infinitely many volts.", on<direct_infinite>),
    fresh("morap.torque.standstill", "2 and -3 N m.", on<torque_standstill>),
    fresh("morap.torque.limit", "10 N m both ways.", on<torque_limit>),
    fresh("morap.torque.motion", "100 counts in a tick, without a torque.", on<torque_motion>),
    fresh("morap.current.scale", "Codes over the whole range.", on<current_scale>),
    fresh("morap.current.zero", "At power-on.", on<current_zero>),
    fresh("morap.tick.idle-rate", "The 42nd tick comes when it should.", on<idle_rate>),
    fresh("morap.tick.loop-rate", "A loop of 320 Hz, 60 ticks.", on<loop_rate>),
    fresh("morap.tick.slow-rate", "A loop of 50 Hz, 10 ticks.", on<slow_rate>),
    fresh("morap.tick.uncalibrated-rate", "A latched loop of 50 Hz.", on<uncalibrated_rate>),
    fresh("morap.tick.back-to-idle", "A loop of 320 Hz, then a voltage.", on<back_to_idle>),
};

}  // namespace

std::span<const Case> output_cases() noexcept { return kCases; }

}  // namespace armjig::morap::conformance
