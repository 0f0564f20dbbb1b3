// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/loop_cases.hpp"

namespace armjig::morap::conformance {
namespace {

/// So many counts, and the gain with which their angle gives 0.25 V.
constexpr int kCounts = 10;

float gain_of_counts(NodeBench& node) {
  const auto count = decode_float(slice<4>(Bytes{*from_hex(node.motor().one_count)}, 0));
  return 0.25F / (static_cast<float>(kCounts) * count);
}

/// The same after a turn, with a reference of 0.
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

/// Of a shaft that stands until the first voltage, at an angle that is another one from some moment
/// on: a calibration lets the loop go on. It is small, for what turns fast gets more voltage.
void integrates_angles(NodeBench& node) {
  run_loop(node, blind_set(node, {0.0F}, {0.0F}, 1.0F), 0.0F);
  node.expect_levels_at_ticks({0});
  node.send(kCalibrateAngle, 0.1875F);
  node.expect_levels_at_ticks({0, -4});
  node.send(kDisable);
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

/// The shaft turns on at the voltage of the first steps, so that what it has turned since the tick
/// before is most of a tick's way. A share of that would leave most of the voltage.
void sees_speed_of_one_tick(NodeBench& node) {
  constexpr double kVolts = 0.75;
  constexpr double kLeastSpeed = 0.1;  // rad/s
  constexpr auto kWhile = 400ms;
  node.send(kCalibrateZero);
  node.send(kVoltage, static_cast<float>(kVolts));
  node.pause(kWhile);
  const double before{node.number(kReadAngle)};
  node.pause(kWhile);
  const double way = double{node.number(kReadAngle)} - before;
  const double speed = way / std::chrono::duration<double>{kWhile}.count();
  node.send(kDisable);
  if (std::fabs(speed) < kLeastSpeed) return node.leave_open("0.75 V hardly turn this shaft");
  node.pause(kWhile);
  auto set = proportional(node.loop_rate(), 1.0F, ControllerKind::kSpeed);
  set.d = filter({static_cast<float>(kVolts / 2 / speed)});
  run_loop(node, set, static_cast<float>(kVolts));
  node.expect_levels_at_ticks({16, 16});
  node.tick();
  const auto levels = levels_of(double{node.number(kReadVoltage)});
  node.about("once the shaft has turned for a tick");
  node.expect_true(levels >= 4 && levels <= 12, "some 8 levels", fmt::format("{}", levels));
  node.send(kDisable);
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
              // 0.375 V each, had the shaft come here within a tick, or been as fast as it is far.
              set.d = filter({0.005F, 0.005F, 0.005F, 0.001F});
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
    variant("slowly", slowly(on<integrates_angles>)),

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
    variant("slowly", slowly(on<sees_speed_of_one_tick>)),
};

}  // namespace

Chapter loop_chapter() { return chapter("Feedback loops", kLoopClauses); }

}  // namespace armjig::morap::conformance
