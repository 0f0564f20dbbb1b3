// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr std::uint16_t kRate = kIdleRateHz;

ControllerSet position_set(std::initializer_list<float> d, std::initializer_list<float> c,
                           std::initializer_list<float> f, float integral = 0.0F,
                           std::uint16_t rate_hz = kRate) {
  return {ControllerKind::kPosition, rate_hz, filter(d), filter(c), filter(f), integral};
}

/// One that minds nothing but its reference, so that it does not matter where the shaft is.
ControllerSet blind_set(NodeBench& node, std::initializer_list<float> c,
                        std::initializer_list<float> f, float integral = 0.0F) {
  return position_set({0.0F}, c, f, integral, node.loop_rate());
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

/// What the shaft at so many counts at each tick gives, each a tick later.
std::vector<int> levels_by_law(NodeBench& node, const ControllerSet& set, float reference,
                               std::initializer_list<int> counts) {
  const MotorLaw motor{node.motor()};
  const double wanted{reference};
  LoopLaw law{node.motor(), set, 0, wanted};
  std::vector<int> levels;
  for (const int count : counts) levels.push_back(levels_of(law.step(motor.angle(count), wanted)));
  return levels;
}

/// What the reference and the shaft are at one tick.
struct Sample {
  float reference;
  int counts;
};

/// Another reference and another place of the shaft at each tick.
void follow(NodeBench& node, const ControllerSet& set, std::span<const Sample> samples) {
  const MotorLaw motor{node.motor()};
  LoopLaw law{node.motor(), set, 0, double{samples[0].reference}};
  run_loop(node, set, samples[0].reference);
  int counts = samples[0].counts;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const auto& [reference, place] = samples[i];
    const auto levels = levels_of(law.step(motor.angle(place), double{reference}));
    const auto& next = samples[i + 1];
    if (next.reference != reference) {
      node.send(set.kind == ControllerKind::kSpeed ? kSpeed : kPosition, next.reference);
    }
    if (next.counts != counts) node.turn(next.counts - counts);
    counts = next.counts;
    node.expect_levels_at_ticks({levels});
  }
}

/// One of the stored ones, on a held shaft.
void stored(NodeBench& node, CommandId mode, float reference, std::string_view stored,
            std::initializer_list<int> counts) {
  const auto set = std::get<ControllerSet>(decode_set(*from_hex(stored)));
  node.send(kCalibrateZero);
  node.tick();
  node.send(mode, reference);
  node.tick(set.rate_hz);
  node.expect_levels_at_ticks(levels_by_law(node, set, reference, counts));
}

/// Far from where any shaft is, and the gain of an integrator small for it: a shaft that turns
/// meanwhile is as good as one at rest.
constexpr float kFar = 75.0F;

/// Whose output grows by four levels at each tick.
void run_integrator(NodeBench& node) {
  run_loop(node, blind_set(node, {0.0F}, {0.0F}, 0.0025F), kFar);
}

// On a held shaft, where each tick is known, and on one that may turn, where they are far apart.

void comes_a_tick_late(NodeBench& node) {
  run_loop(node, proportional(node.loop_rate(), 1.0F), 0.75F);
  node.expect_levels(0);
  node.expect_levels_at_ticks({16});
}

void orders_references(NodeBench& node) {
  run_loop(node, blind_set(node, {1.0F, 2.0F}, {0.0F}), 0.25F);
  node.send(kPosition, 0.5F);
  node.expect_levels_at_ticks({16, 27, 32});  // 0.25 + 2 * 0.5 = 1.25 V, then 1.5 V
}

void follows_references(NodeBench& node) {
  constexpr Sample kSamples[] = {{0.25F, 0}, {0.5F, 0},  {-0.25F, 0},  {0.125F, 0},
                                 {0.0F, 0},  {0.75F, 0}, {0.0625F, 0}, {0.0F, 0}};
  const auto set = blind_set(node, {0.3F, -0.5F, 1.1F, 0.7F}, {0.0F});
  follow(node, set, kSamples);
}

void echoes_outputs(NodeBench& node) {
  constexpr Sample kSamples[] = {{0, 0}, {1.0F, 0}, {0, 0}, {0, 0},    {0, 0},
                                 {0, 0}, {0, 0},    {0, 0}, {0.5F, 0}, {0, 0}};
  const auto set = blind_set(node, {0.75F}, {-0.2F, 0.3F, 0.4F, -0.5F});
  follow(node, set, kSamples);
}

void takes_off_an_output(NodeBench& node) {
  run_loop(node, blind_set(node, {0.375F}, {-0.5F}), 1.0F);
  node.expect_levels_at_ticks({8, 12, 14, 15});  // half of the one before, and 8
}

void orders_outputs(NodeBench& node) {
  run_loop(node, blind_set(node, {0.375F}, {-0.5F, 0.0F}), 1.0F);
  node.expect_levels_at_ticks({8, 8, 12, 12, 14});  // half of the one before that, and 8
}

void begins_with_reference(NodeBench& node) {
  run_loop(node, blind_set(node, {1.0F, 2.0F}, {0.0F}), 0.25F);
  node.expect_levels_at_ticks({16, 16});
}

void integrates_references(NodeBench& node) {
  run_integrator(node);
  node.expect_levels_at_ticks({4, 8, 12, 16});
}

/// Half of the output before without its integral, and 8 levels; and four more each time.
void integrates_beside_outputs(NodeBench& node) {
  run_loop(node, blind_set(node, {0.005F}, {-0.5F}, 0.0025F), kFar);
  node.expect_levels_at_ticks({12, 20, 26});
}

void integrates_nothing(NodeBench& node) {
  run_loop(node, blind_set(node, {0.5F}, {0.0F}, -0.25F), 0.75F);
  node.expect_levels_at_ticks({8, 8, 8});
}

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

void begins_anew_in_another_mode(NodeBench& node) {
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

/// What a limit holds back is held back of the same loop only.
void begins_anew_behind_a_limit(NodeBench& node) {
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
void begins_anew_with_parameters(NodeBench& node) {
  run_integrator(node);
  node.expect_levels_at_ticks({4, 8});
  const auto other_rate = static_cast<std::uint16_t>(2 * node.loop_rate());
  node.send(proportional(other_rate, 1.0F, ControllerKind::kSpeed));
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

void begins_anew_behind_calibration(NodeBench& node) {
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

template <int sign>
void holds_integrator(NodeBench& node) {
  // 10.5 V: below the limit of the output, so that the current alone limits it
  run_loop(node, blind_set(node, {0.14F}, {0.0F}, 0.005F), sign * kFar);
  node.expect_levels_at_ticks({sign * node.motor().standstill_levels});
  node.send(kPosition, 0.0F);
  node.tick();  // by then a shaft that may turns
  node.expect_levels_at_ticks({sign * 8, sign * 8});
}

/// Where the shaft is counts half as much as the reference, and both are integrated.
void holds_both_integrators(NodeBench& node) {
  // 10.5 V: below the limit of the output, so that the current alone limits it
  node.send(blind_set(node, {0.14F}, {0.0F}, 0.005F));
  node.send(kCalibrateAngle, kFar / 2);
  node.tick();
  node.send(kPosition, kFar);
  node.tick(node.loop_rate());
  node.expect_levels_at_ticks({node.motor().standstill_levels});
  node.send(kPosition, 0.0F);
  node.tick();                       // by then a shaft that may turns
  node.expect_levels_at_ticks({4});  // 8 and -4, of the first sample only
}

template <int sign>
void limits_at_first(NodeBench& node) {
  run_loop(node, proportional(node.loop_rate(), 10.0F), static_cast<float>(sign) * 0.5F);
  node.expect_levels_at_ticks({sign * node.motor().standstill_levels});
  node.send(kDisable);
}

constexpr Case loop(std::string_view rule, CaseBody run) {
  return from(kFresh, Hazard::kProgram, rule, run);
}

constexpr Clause kLoopClauses[] = {
    must("morap.loop.one-tick-late",
         "What a feedback loop computes at a tick is applied at the next.", "vector 63",
         Profiles::kFirmware),
    loop("A gain of 1.", on<comes_a_tick_late>),
    variant("slowly", slowly(on<comes_a_tick_late>)),

    must("morap.loop.position-default",
         "The stored position controller answers a step of 1 rad of a held shaft as recorded.",
         "vector 64; recording static-position-locked", Profiles::kFirmware),
    loop("Tick by tick.",
         [](NodeBench& node) {
           stored(node, kPosition, 1.0F, node.motor().position_set, {0, 0, 0, 0, 0});
         }),

    must("morap.loop.speed-default",
         "The stored speed controller answers a step of 0.2 rad/s of a held shaft as recorded.",
         "vector 65; recording static-speed-locked", Profiles::kFirmware),
    loop("Tick by tick.",
         [](NodeBench& node) { stored(node, kSpeed, 0.2F, node.motor().speed_set, {0, 0, 0, 0}); }),

    must("morap.loop.reference-order",
         "The last coefficient of the reference belongs to its newest sample.",
         "recording static-custom-controller-locked", Profiles::kFirmware),
    loop("1 and 2, with another reference on the way.", on<orders_references>),
    variant("slowly", slowly(on<orders_references>)),

    must("morap.loop.measured-order",
         "The last coefficient of the angle belongs to its newest sample, and is taken off.",
         "recording stim-custom-controllers", Profiles::kFirmware),
    loop("1 and 2, with a turn of the shaft.",
         [](NodeBench& node) {
           const float gain = gain_of_counts(node);
           run_loop(node, position_set({gain, 2 * gain}, {0.0F}, {0.0F}), 0.0F);
           node.turn(kCounts);
           node.expect_levels_at_ticks({0, -11, -16});  // -0.5 V, then -0.75 V
         }),

    must("morap.loop.four-coefficients",
         "All four coefficients of each filter count, each for its own sample.",
         "firmware, feedback loop; recording static-custom-controller-locked", Profiles::kFirmware),
    variant("reference", loop("Six references, one after the other.", on<follows_references>)),
    variant("slowly.reference", slowly(on<follows_references>)),
    variant("angle", loop("The shaft at six places, one after the other.",
                          [](NodeBench& node) {
                            constexpr Sample kSamples[] = {{0, 0}, {0, 10}, {0, -20}, {0, 30},
                                                           {0, 5}, {0, 5},  {0, 5},   {0, 5}};
                            const float gain = gain_of_counts(node);
                            const auto set =
                                position_set({0.3F * gain, -0.5F * gain, 1.1F * gain, 0.7F * gain},
                                             {0.0F}, {0.0F});
                            follow(node, set, kSamples);
                          })),
    variant("output", loop("The echo of one reference.", on<echoes_outputs>)),
    variant("slowly.output", slowly(on<echoes_outputs>)),

    must("morap.loop.begins-still",
         "A speed loop begins as if the shaft had always stood, however far it was turned before.",
         "firmware, feedback loop", Profiles::kFirmware),
    loop("A turn before the mode, and none after it.",
         [](NodeBench& node) {
           auto set = proportional(kRate, 1.0F, ControllerKind::kSpeed);
           set.d = filter({gain_of_counts(node)});
           node.send(set);
           node.send(kCalibrateZero);
           node.turn(1000);
           node.tick();
           node.send(kSpeed, 0.75F);
           node.tick(kRate);
           node.expect_levels_at_ticks({16, 16, 16});
         }),

    variant("slowly", slowly([](NodeBench& node) {
              auto set = proportional(node.loop_rate(), 1.0F, ControllerKind::kSpeed);
              set.d = filter({0.001F});  // 0.375 V, had the shaft come here within a tick
              node.send(set);
              node.send(kCalibrateAngle, kFar);
              node.tick();
              node.send(kSpeed, 0.75F);
              node.tick(set.rate_hz);
              node.expect_levels_at_ticks({16});
            })),

    must("morap.loop.feedback-of-output", "The coefficients of earlier outputs are taken off.",
         "recording static-custom-controller-locked", Profiles::kFirmware),
    loop("-0.5.", on<takes_off_an_output>),
    variant("slowly", slowly(on<takes_off_an_output>)),

    must("morap.loop.output-order",
         "The last coefficient of earlier outputs belongs to the newest of them.",
         "recording static-custom-controller-locked", Profiles::kFirmware),
    loop("-0.5 and 0.", on<orders_outputs>),
    variant("slowly", slowly(on<orders_outputs>)),

    must("morap.loop.begins-with-reference",
         "A loop begins as if its reference had always been there.", "firmware, feedback loop",
         Profiles::kFirmware),
    loop("Two samples of it count.", on<begins_with_reference>),
    variant("slowly", slowly(on<begins_with_reference>)),

    must("morap.loop.begins-with-angle",
         "A position loop begins as if the shaft had always stood where it is.",
         "firmware, feedback loop", Profiles::kFirmware),
    loop("Two samples of it count.",
         [](NodeBench& node) {
           const float gain = gain_of_counts(node);
           run_turned(node, position_set({gain, gain}, {0.0F}, {0.0F}));
           node.expect_levels_at_ticks({-11, -11});  // twice -0.25 V
         }),

    must("morap.loop.integral-of-reference",
         "The integrator adds the reference times its gain at each tick, from the first on.",
         "recording static-speed-locked", Profiles::kFirmware),
    loop("Nothing but an integrator.", on<integrates_references>),
    variant("slowly", slowly(on<integrates_references>)),
    variant("beside-outputs", slowly(on<integrates_beside_outputs>)),

    must("morap.loop.integral-of-angle", "And takes off the measured value times its gain.",
         "firmware, feedback loop", Profiles::kFirmware),
    loop("Nothing but an integrator.",
         [](NodeBench& node) {
           run_turned(node, position_set({0.0F}, {0.0F}, {0.0F}, 0.75F * gain_of_counts(node)));
           node.expect_levels_at_ticks({-4, -8, -12});
         }),

    must("morap.loop.negative-integral", "A negative gain of the integrator is none.",
         "firmware, feedback loop", Profiles::kFirmware),
    loop("-0.25 beside a gain of 0.5.", on<integrates_nothing>),
    variant("slowly", slowly(on<integrates_nothing>)),

    must("morap.loop.anti-windup",
         "After a sample with a limited output the integrators stand still.",
         "recording static-antiwindup-locked", Profiles::kFirmware),
    loop("Three limited samples, then a reference of 0.",
         [](NodeBench& node) {
           const int most = node.motor().standstill_levels;
           run_loop(node, position_set({0.0F}, {10.0F}, {0.0F}, 0.375F), 1.0F);
           node.expect_levels_at_ticks({most, most, most});
           node.send(kPosition, 0.0F);
           node.expect_levels_at_ticks({most, 8, 8});  // of the first sample only
         }),
    variant("slowly", slowly(on<holds_integrator<1>>)),
    variant("slowly.negative", slowly(on<holds_integrator<-1>>)),
    variant("both", loop("Of the reference and of the angle.", on<holds_both_integrators>)),
    variant("slowly.both", slowly(on<holds_both_integrators>)),

    must("morap.loop.current-limit",
         "At standstill a loop is limited to the voltage of the rated current, both ways.",
         "vector 64; recording loop-current-limit", Profiles::kFirmware),
    loop("10 V and -10 V.",
         [](NodeBench& node) {
           const int most = node.motor().standstill_levels;
           run_loop(node, proportional(kRate, 10.0F), 1.0F);
           node.expect_levels_at_ticks({most});
           node.send(kPosition, -1.0F);
           node.expect_levels_at_ticks({most, -most});
         }),
    variant("slowly", slowly(on<limits_at_first<1>>)),
    variant("slowly.negative", slowly(on<limits_at_first<-1>>)),

    must("morap.loop.current-limit-speed",
         "The limit of a loop follows the speed, of which a fifth is new at each tick.",
         "firmware, feedback loop; recording stim-position", Profiles::kFirmware),
    loop("10 V, and one turn of the shaft.",
         [](NodeBench& node) {
           const auto set = proportional(kRate, 10.0F);
           run_loop(node, set, 1.0F);
           node.tick();
           node.turn(67);
           node.tick();
           const auto levels = levels_by_law(node, set, 1.0F, {0, 0, 67, 67, 67, 67});
           node.expect_levels_at_ticks(std::span{levels}.subspan(2));
         }),

    must("morap.loop.voltage-limit",
         "A loop applies no more than 20 V, however fast the shaft turns.",
         "recording loop-saturation", Profiles::kFirmware),
    loop("100 V, and a fast turn.",
         [](NodeBench& node) {
           run_loop(node, proportional(kRate, 100.0F), 1.0F);
           node.tick();
           node.turn(20'000);
           node.tick();
           node.expect_levels_at_ticks({427});
         }),

    must("morap.loop.speed-measured",
         "A speed loop measures the turn since the tick before, times the rate of its controller.",
         "recording stim-speed", Profiles::kFirmware),
    loop("One turn at 400 Hz.",
         [](NodeBench& node) {
           constexpr std::uint16_t kSpeedRate = 400;
           auto set = proportional(kSpeedRate, 0.0F, ControllerKind::kSpeed);
           set.d = filter({gain_of_counts(node) / static_cast<float>(kSpeedRate)});
           run_loop(node, set, 0.0F);
           node.turn(kCounts);
           node.expect_levels_at_ticks({0, -5, 0});  // -0.25 V
         }),

    must("morap.loop.own-controller", "Each mode runs with its own controller.",
         "recording static-mode-switch-locked", Profiles::kFirmware),
    loop("Gains of 1 and 2.", on<has_its_own_controller>),
    variant("slowly", slowly(on<has_its_own_controller>)),

    must("morap.loop.own-reference", "Each mode follows its own reference.",
         "recording static-mode-switch-locked", Profiles::kFirmware),
    loop("0.75 and 0.375.", on<has_its_own_reference>),
    variant("slowly", slowly(on<has_its_own_reference>)),

    must("morap.loop.new-mode-resets", "Another mode begins its loop anew.",
         "recording static-mode-switch-locked", Profiles::kFirmware),
    loop("An integrator, with a voltage between.", on<begins_anew_in_another_mode>),
    variant("slowly", slowly(on<begins_anew_in_another_mode>)),

    variant("limited", loop("One that was limited.", on<begins_anew_behind_a_limit>)),
    variant("slowly.limited", slowly(on<begins_anew_behind_a_limit>)),

    must("morap.loop.new-reference-goes-on", "Another reference in the same mode does not.",
         "recording static-position-locked", Profiles::kFirmware),
    loop("An integrator.", on<goes_on_with_another_reference>),
    variant("slowly", slowly(on<goes_on_with_another_reference>)),

    variant("speed", loop("An integrator of speed.", on<speed_goes_on_with_another_reference>)),
    variant("slowly.speed", slowly(on<speed_goes_on_with_another_reference>)),

    must("morap.loop.new-parameters-reset",
         "Newly installed parameters of any controller begin the running loop anew.",
         "firmware, tick", Profiles::kFirmware),
    loop("An integrator, and the speed controller.", on<begins_anew_with_parameters>),
    variant("slowly", slowly(on<begins_anew_with_parameters>)),

    must("morap.loop.reenabled-goes-on",
         "A loop that was disabled and enabled between two ticks goes on.",
         "recording static-reenable-within-tick", Profiles::kFirmware),
    loop("An integrator.", on<goes_on_when_enabled_again>),
    variant("slowly", slowly(on<goes_on_when_enabled_again>)),

    must(
        "morap.loop.else-goes-on",
        "Calibrating, the brake, refused parameters and unknown identifiers do not begin a running "
        "loop anew.",
        "firmware, tick; recording loop-calibrate-moving", Profiles::kFirmware),
    loop("An integrator.", on<goes_on_whatever_else>),
    variant("slowly", slowly(on<goes_on_whatever_else>)),

    must("morap.loop.latched-begins-anew",
         "A loop whose mode came before calibration begins anew with it.",
         "firmware, tick: the reset waits; recording loop-uncalibrated", Profiles::kFirmware),
    loop("An integrator that has run before.", on<begins_anew_behind_calibration>),
    variant("slowly", slowly(on<begins_anew_behind_calibration>)),
    variant("reference",
            loop("With the reference of that time.", on<begins_with_latest_reference>)),
    variant("slowly.reference", slowly(on<begins_with_latest_reference>)),
};

}  // namespace

Chapter loop_chapter() { return chapter("Feedback loops", kLoopClauses); }

}  // namespace armjig::morap::conformance
