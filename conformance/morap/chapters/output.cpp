// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <optional>

#include "conformance/morap/cases.hpp"
#include "conformance/morap/loop_cases.hpp"

namespace armjig::morap::conformance {
namespace {

void expect_levels_later(NodeBench& node, int levels) {
  node.settle();
  node.expect_levels(levels);
}

template <CommandId end>
void voltage_ended(NodeBench& node) {
  node.send(kVoltage, 1.5F);
  expect_levels_later(node, 32);
  node.send(end);
  expect_levels_later(node, 0);
}

/// Of a node that is not calibrated.
template <CommandId reference>
void drives_nothing(NodeBench& node) {
  node.send(reference, 1.5F);
  expect_levels_later(node, 0);
  node.send(kCalibrationUnknown);
}

/// Calibrated and ticking, with everything that was pending done.
void calibrate(NodeBench& node) {
  node.send(kCalibrateZero);
  node.tick();
}

/// In a mode of 200 Hz: the levels right before and right after the next tick.
void expect_step_at_tick(NodeBench& node, int before, int after, std::uint16_t rate_hz = 0) {
  node.send(kReadVoltage);
  node.wait_for_tick();
  node.about("right before the tick");
  node.expect_read_levels(before);
  node.tick(rate_hz);
  node.about("right after the tick");
  node.expect_read_levels(after);
  node.about({});
}

void expect_voltage_at_tick(NodeBench& node) {
  node.send(kVoltage, 1.5F);
  expect_step_at_tick(node, 0, 32);
}

constexpr int kMostLevels = 427;  // 20.015625 V

/// At 1 V; to the first tick after it.
void turn_fast(NodeBench& node) {
  calibrate(node);
  node.send(kVoltage, 1.0F);
  node.ticks(2);
  node.turn(1000);
  node.tick();
}

/// Behind a tick with a direct voltage.
void expect_direct(NodeBench& node, float volts, int levels) {
  node.about(fmt::format("asked for {} V", volts));
  node.send(kDirectVoltage, volts);
  node.tick();
  node.expect_levels(levels);
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

/// An integrator that comes to 1.4 V within a tenth of a second at 1000 Hz, and its voltage by
/// then.
void expect_growth_at_rate(NodeBench& node, int rate_hz) {
  constexpr float kGain = 1.8e-4F;
  constexpr double kLittle = 3;  // levels
  const float integral = kGain * 1000.0F / static_cast<float>(rate_hz) / 2;
  const auto set =
      position_set({0.0F}, {0.0F}, {0.0F}, integral, static_cast<std::uint16_t>(rate_hz));
  node.send(kDisable);
  node.send(set);
  node.settle();
  node.send(kPosition, kFar);
  node.pause(20ms);
  struct Seen {
    double levels;
    Instant earliest;
    Instant latest;
  };
  const auto look = [&node] {
    const auto earliest = node.now();
    const double volts{node.number(kReadVoltage)};
    return Seen{volts / kVoltsPerLevel, earliest, node.now()};
  };
  const auto first = look();
  node.pause(80ms);
  const auto second = look();
  node.send(kDisable);
  const auto levels_in = [&](Duration time) {
    const std::chrono::duration<double> seconds = time;
    return seconds.count() * rate_hz * double{set.integral} * double{kFar} / kVoltsPerLevel;
  };
  node.about(fmt::format("an integrator at {} Hz", rate_hz));
  node.expect_in_time(
      {second.levels - first.levels, levels_in(second.earliest - first.latest) * 0.98 - kLittle,
       levels_in(second.latest - first.earliest) * 1.02 + kLittle, "levels"},
      "as many levels as there were ticks",
      fmt::format("{:.0f} levels", second.levels - first.levels));
}

constexpr Case fresh(std::string_view rule, CaseBody run) {
  return from(kFresh, Hazard::kMove, rule, run);
}

constexpr Case driven(std::string_view rule, CaseBody run) {
  return from(kDisabled, Hazard::kMove, rule, run);
}

/// On a shaft that may turn, a voltage that does it no harm.
void expect_direct_settled(NodeBench& node, float volts, int levels) {
  node.about(fmt::format("asked for {} V", volts));
  node.send(kDirectVoltage, volts);
  expect_levels_later(node, levels);
}

/// The voltage at the first tick after a reference; none if nobody knows that it was read before
/// the second one. `before`: a mode that it is in already, at 0.
std::optional<int> first_levels(NodeBench& node, CommandId mode, float reference,
                                std::optional<CommandId> before) {
  constexpr int kMostReads = 12;
  const auto between_ticks = tick_period(kIdleRateHz) * 9 / 10;
  node.bring_to(kFree);
  if (before) {
    node.send(*before, 0.0F);
    node.settle();
  }
  auto before_it = node.now();
  node.send(mode, reference);
  int levels = 0;
  bool is_first = false;
  for (int i = 0; i < kMostReads && levels == 0; ++i) {
    const auto begin = node.now();
    levels = levels_of(static_cast<double>(node.number(kReadVoltage)));
    is_first = node.now() - before_it < between_ticks;
    before_it = begin;
  }
  node.send(kDisable);
  return is_first ? std::optional{levels} : std::nullopt;
}

/// Of a free shaft at rest: it is driven for some ticks and let go. In real time the first tick may
/// be missed, and gets further tries.
void expect_first_levels(NodeBench& node, CommandId mode, float reference, int levels,
                         std::optional<CommandId> before = {}) {
  constexpr int kTries = 12;
  std::optional<int> first;
  for (int i = 0; i < kTries && !first && !node.is_over(); ++i) {
    first = first_levels(node, mode, reference, before);
  }
  if (!first) return node.leave_open("this bus is too slow to be read between two ticks");
  const int last = *first;
  node.about(fmt::format("asked for {}", reference));
  node.expect_true(last == levels, fmt::format("{} levels before it turns", levels),
                   fmt::format("{}", last));
}

/// More than drives the rated current.
template <CommandId mode, int sign, bool is_limited>
void drive_after(NodeBench& node, std::optional<CommandId> before) {
  const int most = node.motor().standstill_levels;
  const int asked = most * 3 / 2;
  expect_first_levels(node, mode, static_cast<float>(sign * asked) * kVoltsPerLevel,
                      sign * (is_limited ? most : asked), before);
}

template <CommandId mode, int sign, bool is_limited>
void drive_at_rest(NodeBench& node) {
  drive_after<mode, sign, is_limited>(node, {});
}

constexpr Case at_rest(CaseBody run) { return from(kFree, Hazard::kMove, run); }

/// At 0, so that nothing turns.
template <CommandId mode>
void comes_back_to_idle(NodeBench& node) {
  run_loop(node, proportional(node.loop_rate(), 1.0F), 0.0F);
  node.send(mode, 0.0F);
  node.tick(kIdleRateHz);
  expect_near_ticks(node);
}

constexpr Clause kOutputClauses[] = {
    must("morap.voltage.close", "A drive voltage inside the limits is applied to within 0.05 V.",
         "document, applied voltage; firmware: a step is 0.046875 V"),
    driven("Up to 1.5 V.",
           [](NodeBench& node) {
             for (const float volts : {0.5F, 1.0F, 1.5F}) {
               node.send(kVoltage, volts);
               node.settle();
               node.expect_near(kReadVoltage, static_cast<double>(volts), 0.05);
             }
             node.send(kDisable);
           }),

    must("morap.voltage.grid", "The applied voltage is the nearest multiple of 48/1024 V.",
         "reference, voltage quantisation; vector 56"),
    driven("Up to 1.5 V, around a border too.",
           [](NodeBench& node) {
             struct Row {
               float volts;
               int levels;
             };
             for (const auto& [volts, levels] :
                  {Row{0.0234F, 0}, {0.0235F, 1}, {0.5F, 11}, {1.0F, 21}, {1.5F, 32}}) {
               node.about(fmt::format("asked for {} V", volts));
               node.send(kVoltage, volts);
               expect_levels_later(node, levels);
             }
             node.send(kDisable);
           }),

    must("morap.voltage.sign", "A negative drive voltage is applied as negative.",
         "document; recording static-direct-voltage"),
    driven("-1.5 V.",
           [](NodeBench& node) {
             node.send(kVoltage, -1.5F);
             expect_levels_later(node, -32);
             node.send(kDisable);
           }),

    must("morap.voltage.uncalibrated", "Without calibration no voltage is applied.",
         "document, motor status; vector 14"),
    from(kUncalibrated, Hazard::kMove, "1.5 V.", on<drives_nothing<kVoltage>>),
    variant("direct", from(kUncalibrated, Hazard::kMove, "A direct one of 1.5 V.",
                           on<drives_nothing<kDirectVoltage>>)),
    variant("torque", from(kUncalibrated, Hazard::kMove, "A torque of 1.5 N m.",
                           on<drives_nothing<kTorque>>)),

    must("morap.voltage.disabled", "Once disabled no voltage is applied.",
         "document; recording loop-disable-coast"),
    driven("1.5 V, then 0.", on<voltage_ended<kDisable>>),

    must("morap.voltage.forgotten", "Once the calibration is forgotten no voltage is applied.",
         "firmware, tick"),
    driven("1.5 V, then 31.", on<voltage_ended<kCalibrationUnknown>>),

    must("morap.voltage.at-tick", "A drive voltage is applied at the next tick and not before.",
         "vector 55"),
    fresh("1.5 V between ticks.",
          [](NodeBench& node) {
            calibrate(node);
            expect_voltage_at_tick(node);
          }),
    variant("slowly", slowly([](NodeBench& node) {
              run_slow_loop(node);
              node.send(kVoltage, 1.5F);
              expect_step_at_tick(node, 16, 32, kIdleRateHz);
              node.send(kDisable);
            })),

    must("morap.voltage.disabled-at-tick",
         "Disabling takes the voltage away at the next tick and not before.",
         "recording static-slow-controller"),
    fresh("0 between ticks.",
          [](NodeBench& node) {
            calibrate(node);
            node.send(kVoltage, 1.5F);
            node.tick();
            node.send(kDisable);
            expect_step_at_tick(node, 32, 0);
          }),
    variant("slowly", slowly([](NodeBench& node) {
              run_slow_loop(node);
              node.send(kDisable);
              expect_step_at_tick(node, 16, 0, kIdleRateHz);
            })),

    must("morap.voltage.current-limit",
         "At standstill the drive voltage is limited to what drives the rated current.",
         "vector 55; recording static-voltage-limited"),
    fresh("10 V.",
          [](NodeBench& node) {
            calibrate(node);
            node.send(kVoltage, 10.0F);
            node.tick();
            node.expect_levels(node.motor().standstill_levels);
          }),
    variant("free", at_rest(on<drive_at_rest<kVoltage, 1, true>>)),

    must("morap.voltage.current-limit-negative", "So is a negative drive voltage.",
         "recording static-voltage-limited"),
    fresh("-10 V.",
          [](NodeBench& node) {
            calibrate(node);
            node.send(kVoltage, -10.0F);
            node.tick();
            node.expect_levels(-node.motor().standstill_levels);
          }),
    variant("free", at_rest(on<drive_at_rest<kVoltage, -1, true>>)),

    must("morap.voltage.overspeed",
         "A shaft that turns too fast for the drive voltage gets a higher one, up to the limit.",
         "vector 59"),
    fresh("1000 counts in a tick.",
          [](NodeBench& node) {
            turn_fast(node);
            node.expect_levels(kMostLevels);
          }),

    must("morap.voltage.speed-unfiltered",
         "The limit of the drive voltage follows the speed over one tick, unfiltered.",
         "firmware, voltage mode; recording stim-voltage"),
    fresh("1000 counts in a tick, and the next tick.",
          [](NodeBench& node) {
            turn_fast(node);
            node.about("one tick after the turn");
            node.tick();
            node.expect_levels(21);
          }),

    must("morap.direct.no-current-limit",
         "The direct drive voltage is not limited to the rated current.", "vector 57",
         Profiles::kFirmware),
    fresh("10 V at standstill.",
          [](NodeBench& node) {
            calibrate(node);
            expect_direct(node, 10.0F, 213);
          }),
    variant("free", at_rest(on<drive_at_rest<kDirectVoltage, 1, false>>)),
    variant("behind-voltage", at_rest([](NodeBench& node) {
              drive_after<kDirectVoltage, 1, false>(node, kVoltage);
            })),

    must("morap.direct.limit", "No voltage beyond 20 V is applied, which reads as 20.015625 V.",
         "vector 58", Profiles::kFirmware),
    fresh("More than 20 V of both signs.",
          [](NodeBench& node) {
            calibrate(node);
            expect_direct(node, 20.0F, kMostLevels);
            expect_direct(node, 24.0F, kMostLevels);
            expect_direct(node, -30.0F, -kMostLevels);
          }),

    must("morap.direct.rounding", "Voltages are rounded to the nearest level of both signs alike.",
         "reference, voltage quantisation", Profiles::kFirmware),
    fresh("Around borders of both signs.",
          [](NodeBench& node) {
            calibrate(node);
            expect_direct(node, 0.0234F, 0);
            expect_direct(node, 0.0235F, 1);
            expect_direct(node, -0.0234F, 0);
            expect_direct(node, -0.0235F, -1);
            expect_direct(node, 5.0F, 107);
            expect_direct(node, 12.0F, 256);
            expect_direct(node, -15.0F, -320);
          }),
    variant("turning", driven("Up to 1.5 V, whether the shaft turns or not.",
                              [](NodeBench& node) {
                                expect_direct_settled(node, 0.0234F, 0);
                                expect_direct_settled(node, 0.0235F, 1);
                                expect_direct_settled(node, -0.0234F, 0);
                                expect_direct_settled(node, -0.0235F, -1);
                                expect_direct_settled(node, 1.5F, 32);
                                expect_direct_settled(node, -1.5F, -32);
                                node.send(kDisable);
                              })),

    must("morap.direct.infinite", "An infinite direct voltage is one of 20 V.",
         "reference, voltage quantisation", Profiles::kFirmware),
    fresh("Infinitely many volts.",
          [](NodeBench& node) {
            calibrate(node);
            expect_direct(node, std::numeric_limits<float>::infinity(), kMostLevels);
          }),

    must("morap.torque.standstill",
         "At standstill a torque is driven by the voltage of its current.", "vectors 60 and 62",
         Profiles::kFirmware),
    fresh("2 and -3 N m.",
          [](NodeBench& node) {
            calibrate(node);
            for (const float torque : {2.0F, -3.0F}) {
              node.about(fmt::format("{} N m", torque));
              node.send(kTorque, torque);
              node.tick();
              node.expect_levels(levels_of(MotorLaw{node.motor()}.torque_voltage(torque, 0)));
            }
          }),
    variant("free", at_rest([](NodeBench& node) {
              for (const float torque : {1.0F, -2.0F}) {
                const MotorLaw law{node.motor()};
                expect_first_levels(node, kTorque, torque,
                                    levels_of(law.torque_voltage(double{torque}, 0)));
              }
            })),

    must("morap.torque.limit", "A torque is limited to that of the rated current.",
         "vector 61; recording static-torque-limited", Profiles::kFirmware),
    fresh("10 N m both ways.",
          [](NodeBench& node) {
            calibrate(node);
            for (const int sign : {1, -1}) {
              node.send(kTorque, static_cast<float>(10 * sign));
              node.tick();
              node.expect_levels(sign * node.motor().standstill_levels);
            }
          }),
    variant("free", at_rest([](NodeBench& node) {
              for (const int sign : {1, -1}) {
                expect_first_levels(node, kTorque, static_cast<float>(10 * sign),
                                    sign * node.motor().standstill_levels);
              }
            })),

    must("morap.torque.motion",
         "To the voltage of a torque that of the motion is added, for one tick without a filter.",
         "firmware, torque mode; recording stim-torque", Profiles::kFirmware),
    fresh("100 counts in a tick, without a torque.",
          [](NodeBench& node) {
            calibrate(node);
            node.send(kTorque, 0.0F);
            node.ticks(2);
            node.turn(100);
            node.tick();
            const MotorLaw law{node.motor()};
            node.expect_levels(levels_of(law.torque_voltage(0, law.angle(100) * kIdleRateHz)));
            node.tick();
            node.expect_levels(0);
          }),

    must("morap.current.scale", "The current is the converted code in steps of 2.60678 mA.",
         "vectors 66 and 67; recording stim-adc-current"),
    fresh("Codes over the whole range.",
          [](NodeBench& node) {
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
          }),
    variant("starting", at_rest([](NodeBench& node) {
              constexpr double kStep = 2.60678e-3;
              node.send(kVoltage, 1.5F);
              for (int i = 0; i < 20; ++i) {
                const double steps = double{node.number(kReadCurrent)} / kStep;
                node.expect_true(std::fabs(steps - std::round(steps)) < 0.01, "whole steps",
                                 fmt::format("{} of them", steps));
              }
              node.send(kDisable);
            })),

    must("morap.current.zero", "Without a current 0 is read.", "firmware, current"),
    from(kSwitchedOn, Hazard::kState, "At power-on.",
         [](NodeBench& node) { node.expect_number(kReadCurrent, 0.0F); }),
    variant("ended", at_rest([](NodeBench& node) {
              constexpr float kNoticed = 0.01F;  // A, four steps
              node.send(kVoltage, 1.5F);
              node.settle();
              const auto driven = node.number(kReadCurrent);
              node.send(kDisable);
              node.settle();
              if (driven < kNoticed) return node.leave_open("hardly any current drives this shaft");
              node.about("once nothing drives the motor any more");
              node.expect_near(kReadCurrent, 0.0, std::max(0.02, double{driven} / 10));
            })),

    must("morap.tick.idle-rate", "Without a feedback loop a tick comes every 5.0005 ms.",
         "recording static-tick-timing"),
    fresh("The 42nd tick comes when it should.",
          [](NodeBench& node) {
            calibrate(node);
            node.ticks(40);
            expect_voltage_at_tick(node);
          }),

    must("morap.tick.loop-rate", "With a feedback loop ticks come at the rate of its controller.",
         "recording static-rate-change-timing"),
    fresh("A loop of 320 Hz, 60 ticks.", [](NodeBench& node) { expect_loop_rate(node, 320, 60); }),

    variant("fast", from(kProgrammable, Hazard::kProgram,
                         "An integrator grows with the rates of 1000 and 2000 Hz.",
                         [](NodeBench& node) {
                           for (const int rate : {1000, 2000}) expect_growth_at_rate(node, rate);
                         })),

    must("morap.tick.slow-rate",
         "Rates for which the timer has to be divided are kept as well, down to a few hertz.",
         "reference, timer; recording static-slow-controller"),
    fresh("A loop of 50 Hz, 10 ticks.", [](NodeBench& node) { expect_loop_rate(node, 50, 10); }),

    variant("slowly", slowly([](NodeBench& node) {
              run_loop(node, proportional(2, 1.0F), 0.75F);
              node.expect_levels(0);
              node.expect_levels_at_ticks({16});
              node.send(kPosition, 0.375F);
              node.expect_levels_at_ticks({16, 8});
              node.send(kDisable);
            })),

    must("morap.tick.uncalibrated-rate",
         "The rate follows the mode also while the node is uncalibrated.", "firmware, tick"),
    fresh("A latched loop of 50 Hz.",
          [](NodeBench& node) {
            node.send(proportional(50, 1.0F));
            node.tick();
            node.send(kPosition, 0.75F);
            node.tick(50);
            node.tick();
            node.send(kCalibrateZero);
            expect_voltage_at_tick(node);
          }),

    must("morap.tick.back-to-idle", "After a feedback loop the idle rate comes back.",
         "recording static-mode-switch-locked"),
    fresh("A loop of 320 Hz, then a voltage.",
          [](NodeBench& node) {
            node.send(proportional(320, 1.0F));
            calibrate(node);
            node.send(kPosition, 0.75F);
            node.tick(320);
            node.ticks(2);
            node.send(kVoltage, 0.0F);
            node.tick(200);
            node.ticks(20);
            expect_voltage_at_tick(node);
          }),
    variant("slowly", slowly(on<comes_back_to_idle<kVoltage>>)),
    variant("disabled", slowly([](NodeBench& node) {
              run_slow_loop(node);
              node.send(kDisable);
              node.tick(kIdleRateHz);
              expect_near_ticks(node);
            })),

    must("morap.tick.back-to-idle-any",
         "The idle rate comes back with a direct voltage or a torque, too.", "firmware, tick",
         Profiles::kFirmware),
    variant("direct", slowly(on<comes_back_to_idle<kDirectVoltage>>)),
    variant("torque", slowly(on<comes_back_to_idle<kTorque>>)),
};

}  // namespace

Chapter output_chapter() { return chapter("Output and ticks", kOutputClauses); }

}  // namespace armjig::morap::conformance
