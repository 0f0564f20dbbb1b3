// SPDX-License-Identifier: Apache-2.0
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
  run(node, set, samples[0].reference);
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

/// Whose output grows by four levels at each tick.
void run_integrator(NodeBench& node) {
  run(node, position_set({0.0F}, {0.0F}, {0.0F}, 0.25F), 0.75F);
}

constexpr Case loop(std::string_view rule, CaseBody run) {
  return from(kFresh, Hazard::kProgram, rule, run);
}

constexpr Clause kLoopClauses[] = {
    must("morap.loop.one-tick-late",
         "What a feedback loop computes at a tick is applied at the next.", "vector 63",
         Profiles::kFirmware),
    loop("A gain of 1.",
         [](NodeBench& node) {
           run(node, proportional(kRate, 1.0F), 0.75F);
           node.expect_levels(0);
           node.expect_levels_at_ticks({16});
         }),

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
    loop("1 and 2, with another reference on the way.",
         [](NodeBench& node) {
           run(node, position_set({0.0F}, {1.0F, 2.0F}, {0.0F}), 0.25F);
           node.send(kPosition, 0.5F);
           node.expect_levels_at_ticks({16, 27, 32});  // 0.25 + 2 * 0.5 = 1.25 V, then 1.5 V
         }),

    must("morap.loop.measured-order",
         "The last coefficient of the angle belongs to its newest sample, and is taken off.",
         "recording stim-custom-controllers", Profiles::kFirmware),
    loop("1 and 2, with a turn of the shaft.",
         [](NodeBench& node) {
           const float gain = gain_of_counts(node);
           run(node, position_set({gain, 2 * gain}, {0.0F}, {0.0F}), 0.0F);
           node.turn(kCounts);
           node.expect_levels_at_ticks({0, -11, -16});  // -0.5 V, then -0.75 V
         }),

    must("morap.loop.four-coefficients",
         "All four coefficients of each filter count, each for its own sample.",
         "firmware, feedback loop; recording static-custom-controller-locked", Profiles::kFirmware),
    variant("reference",
            loop("Six references, one after the other.",
                 [](NodeBench& node) {
                   constexpr Sample kSamples[] = {{0.25F, 0}, {0.5F, 0},  {-0.25F, 0},  {0.125F, 0},
                                                  {0.0F, 0},  {0.75F, 0}, {0.0625F, 0}, {0.0F, 0}};
                   const auto set = position_set({0.0F}, {0.3F, -0.5F, 1.1F, 0.7F}, {0.0F});
                   follow(node, set, kSamples);
                 })),
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
    variant("output",
            loop("The echo of one reference.",
                 [](NodeBench& node) {
                   constexpr Sample kSamples[] = {{0, 0}, {1.0F, 0}, {0, 0}, {0, 0},    {0, 0},
                                                  {0, 0}, {0, 0},    {0, 0}, {0.5F, 0}, {0, 0}};
                   const auto set = position_set({0.0F}, {0.75F}, {-0.2F, 0.3F, 0.4F, -0.5F});
                   follow(node, set, kSamples);
                 })),

    must("morap.loop.begins-still",
         "A speed loop begins as if the shaft had always stood, however far it was turned before.",
         "firmware, feedback loop", Profiles::kFirmware),
    loop("A turn before the mode, and none behind it.",
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

    must("morap.loop.feedback-of-output", "The coefficients of earlier outputs are taken off.",
         "recording static-custom-controller-locked", Profiles::kFirmware),
    loop("-0.5.",
         [](NodeBench& node) {
           run(node, position_set({0.0F}, {0.375F}, {-0.5F}), 1.0F);
           node.expect_levels_at_ticks({8, 12, 14, 15});  // half of the one before, and 8
         }),

    must("morap.loop.output-order",
         "The last coefficient of earlier outputs belongs to the newest of them.",
         "recording static-custom-controller-locked", Profiles::kFirmware),
    loop("-0.5 and 0.",
         [](NodeBench& node) {
           run(node, position_set({0.0F}, {0.375F}, {-0.5F, 0.0F}), 1.0F);
           node.expect_levels_at_ticks({8, 8, 12, 12, 14});  // half of the one before that, and 8
         }),

    must("morap.loop.begins-with-reference",
         "A loop begins as if its reference had always been there.", "firmware, feedback loop",
         Profiles::kFirmware),
    loop("Two samples of it count.",
         [](NodeBench& node) {
           run(node, position_set({0.0F}, {1.0F, 2.0F}, {0.0F}), 0.25F);
           node.expect_levels_at_ticks({16, 16});
         }),

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
    loop("Nothing but an integrator.",
         [](NodeBench& node) {
           run_integrator(node);
           node.expect_levels_at_ticks({4, 8, 12, 16});
         }),

    must("morap.loop.integral-of-angle", "And takes off the measured value times its gain.",
         "firmware, feedback loop", Profiles::kFirmware),
    loop("Nothing but an integrator.",
         [](NodeBench& node) {
           run_turned(node, position_set({0.0F}, {0.0F}, {0.0F}, 0.75F * gain_of_counts(node)));
           node.expect_levels_at_ticks({-4, -8, -12});
         }),

    must("morap.loop.negative-integral", "A negative gain of the integrator is none.",
         "firmware, feedback loop", Profiles::kFirmware),
    loop("-0.25 beside a gain of 0.5.",
         [](NodeBench& node) {
           run(node, position_set({0.0F}, {0.5F}, {0.0F}, -0.25F), 0.75F);
           node.expect_levels_at_ticks({8, 8, 8});
         }),

    must("morap.loop.anti-windup",
         "Behind a sample with a limited output the integrators stand still.",
         "recording static-antiwindup-locked", Profiles::kFirmware),
    loop("Three limited samples, then a reference of 0.",
         [](NodeBench& node) {
           const int most = node.motor().standstill_levels;
           run(node, position_set({0.0F}, {10.0F}, {0.0F}, 0.375F), 1.0F);
           node.expect_levels_at_ticks({most, most, most});
           node.send(kPosition, 0.0F);
           node.expect_levels_at_ticks({most, 8, 8});  // of the first sample only
         }),

    must("morap.loop.current-limit",
         "At standstill a loop is limited to the voltage of the rated current, both ways.",
         "vector 64; recording loop-current-limit", Profiles::kFirmware),
    loop("10 V and -10 V.",
         [](NodeBench& node) {
           const int most = node.motor().standstill_levels;
           run(node, proportional(kRate, 10.0F), 1.0F);
           node.expect_levels_at_ticks({most});
           node.send(kPosition, -1.0F);
           node.expect_levels_at_ticks({most, -most});
         }),

    must("morap.loop.current-limit-speed",
         "The limit of a loop follows the speed, of which a fifth is new at each tick.",
         "firmware, feedback loop; recording stim-position", Profiles::kFirmware),
    loop("10 V, and one turn of the shaft.",
         [](NodeBench& node) {
           const auto set = proportional(kRate, 10.0F);
           run(node, set, 1.0F);
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
           run(node, proportional(kRate, 100.0F), 1.0F);
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
           run(node, set, 0.0F);
           node.turn(kCounts);
           node.expect_levels_at_ticks({0, -5, 0});  // -0.25 V
         }),

    must("morap.loop.own-controller", "Each mode runs with its own controller.",
         "recording static-mode-switch-locked", Profiles::kFirmware),
    loop("Gains of 1 and 2.",
         [](NodeBench& node) {
           node.send(proportional(kRate, 2.0F, ControllerKind::kSpeed));
           node.tick();
           run(node, proportional(kRate, 1.0F), 0.75F);
           node.expect_levels_at_ticks({16});
           node.send(kSpeed, 0.75F);
           node.expect_levels_at_ticks({16, 32});
         }),

    must("morap.loop.own-reference", "Each mode follows its own reference.",
         "recording static-mode-switch-locked", Profiles::kFirmware),
    loop("0.75 and 0.375.",
         [](NodeBench& node) {
           node.send(proportional(kRate, 1.0F, ControllerKind::kSpeed));
           node.tick();
           run(node, proportional(kRate, 1.0F), 0.75F);
           node.send(kSpeed, 0.375F);
           node.expect_levels_at_ticks({16, 8});
           node.send(kPosition, 0.75F);
           node.expect_levels_at_ticks({8, 16});
         }),

    must("morap.loop.new-mode-resets", "Another mode begins its loop anew.",
         "recording static-mode-switch-locked", Profiles::kFirmware),
    loop("An integrator, with a voltage between.",
         [](NodeBench& node) {
           run_integrator(node);
           node.expect_levels_at_ticks({4, 8});
           node.send(kVoltage, 0.0F);
           node.expect_levels_at_ticks({0});
           node.send(kPosition, 0.75F);
           node.expect_levels_at_ticks({0, 4, 8});
         }),

    must("morap.loop.new-reference-goes-on", "Another reference in the same mode does not.",
         "recording static-position-locked", Profiles::kFirmware),
    loop("An integrator.",
         [](NodeBench& node) {
           run_integrator(node);
           node.send(kPosition, 0.375F);
           node.expect_levels_at_ticks({4, 6, 8});
         }),

    must("morap.loop.new-parameters-reset",
         "Newly installed parameters of any controller begin the running loop anew.",
         "firmware, tick", Profiles::kFirmware),
    loop("An integrator, and the speed controller.",
         [](NodeBench& node) {
           run_integrator(node);
           node.expect_levels_at_ticks({4, 8});
           node.send(proportional(kRate, 1.0F, ControllerKind::kSpeed));
           node.expect_levels_at_ticks({12, 4, 8});
         }),

    must("morap.loop.reenabled-goes-on",
         "A loop that was disabled and enabled between two ticks goes on.",
         "recording static-reenable-within-tick", Profiles::kFirmware),
    loop("An integrator.",
         [](NodeBench& node) {
           run_integrator(node);
           node.expect_levels_at_ticks({4, 8});
           node.send(kDisable);
           node.send(kPosition, 0.75F);
           node.expect_levels_at_ticks({12, 16});
         }),
};

}  // namespace

Chapter loop_chapter() { return chapter("Feedback loops", kLoopClauses); }

}  // namespace armjig::morap::conformance
