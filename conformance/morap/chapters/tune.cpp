// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

using enum ProgrammingStatus;

using enum TuneKind;

template <TuneKind kind>
void tuned(NodeBench& node) {
  for (const auto& [request, set] : node.motor().tuned) {
    if (request.kind != kind) continue;
    node.about(fmt::format("inertia {}, pole {}", request.inertia, request.pole));
    node.tune(request.kind, request.inertia, request.pole);
    node.settle();
    node.expect_bytes(selector_of(kind_of(kind)), set);
  }
}

/// The same where the set before had more coefficients than any that is tuned, and an integrator.
template <TuneKind kind>
void tuned_after_a_larger_one(NodeBench& node) {
  const auto most = filter({0.0F, 0.0F, 0.0F, 0.0F});
  node.send(ControllerSet{kind_of(kind), kIdleRateHz, most, most, most, 0.5F});
  node.settle();
  tuned<kind>(node);
}

/// Of two loads that differ by little.
template <TuneKind kind>
void tells_loads_apart(NodeBench& node) {
  std::vector<std::vector<std::byte>> sets;
  for (const float inertia : {0.0431F, 0.0438F}) {
    node.tune(kind, inertia, -9.0F);
    node.settle();
    sets.push_back(node.read(selector_of(kind_of(kind)), 31));
  }
  node.expect_true(sets[0] != sets[1], "another controller for 0.0438 kg m^2 than for 0.0431",
                   "the same");
}

void expect_rate(NodeBench& node, TuneKind kind, float inertia, int rate_hz) {
  node.about(fmt::format("inertia {}", inertia));
  node.tune(kind, inertia, -9.0F);
  node.settle();
  const auto bytes = node.read(selector_of(kind_of(kind)), 3);
  const int actual = load_u16_le(slice<2>(Bytes{bytes}, 1));
  node.expect_true(actual == rate_hz, fmt::format("{} Hz", rate_hz), fmt::format("{} Hz", actual));
}

/// The inertia with which the motor's own pole is at `-pole`.
float inertia_of(const Motor& motor, double pole) {
  return static_cast<float>(MotorLaw{motor}.inertia(pole));
}

constexpr Clause kTuneClauses[] = {
    must("morap.tune.success",
         "A tuning message with sound figures makes the programming status 2.",
         "document, tuning; vector 42"),
    programming(
        "0.2 kg m^2 and -9.",
        [](NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 00 00 10 C1", kSuccess); }),

    must("morap.tune.at-the-byte", "The result is there with the tenth byte, before the stop.",
         "firmware, tuner"),
    programming("With a repeated start.",
                [](NodeBench& node) {
                  node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1", BusBench::End::kOpen);
                  node.expect_programming(kSuccess);
                }),

    must("morap.tune.pd", "Kind 0 gives the PD position controller of those poles, byte for byte.",
         "vectors 42 and 45; recording static-tune-pd", Profiles::kFirmware),
    programming("Light and heavy loads, slow and fast poles.", on<tuned<kPdPosition>>),
    variant("after-larger", programming("After a set of four coefficients each.",
                                        on<tuned_after_a_larger_one<kPdPosition>>)),

    variant("close",
            programming("Two loads that differ by little.", on<tells_loads_apart<kPdPosition>>)),

    must("morap.tune.pid",
         "Kind 1 gives the PID position controller of those poles, byte for byte.",
         "vectors 44 and 46; recording static-tune-pid", Profiles::kFirmware),
    programming("Light and heavy loads, slow and fast poles.", on<tuned<kPidPosition>>),

    must("morap.tune.pi", "Kind 2 gives the PI speed controller of those poles, byte for byte.",
         "vectors 43 and 47; recording static-tune-pi-speed", Profiles::kFirmware),
    programming("Light and heavy loads, slow and fast poles.", on<tuned<kPiSpeed>>),
    variant("after-larger", programming("After a set of four coefficients each.",
                                        on<tuned_after_a_larger_one<kPiSpeed>>)),

    variant("close",
            programming("Two loads that differ by little.", on<tells_loads_apart<kPiSpeed>>)),

    must("morap.tune.position-rate",
         "A tuned position controller runs at 625 Hz with a light load and at 400 Hz with a heavy "
         "one.",
         "reference, tuner", Profiles::kFirmware),
    programming("Around the border, with PD and PID.",
                [](NodeBench& node) {
                  expect_rate(node, kPdPosition, inertia_of(node.motor(), 71), 625);
                  expect_rate(node, kPdPosition, inertia_of(node.motor(), 69), 400);
                  expect_rate(node, kPidPosition, inertia_of(node.motor(), 71), 625);
                  expect_rate(node, kPidPosition, inertia_of(node.motor(), 69), 400);
                }),

    must("morap.tune.speed-rate",
         "A tuned speed controller runs at 625, 400 or 320 Hz, the slower the heavier its load.",
         "reference, tuner", Profiles::kFirmware),
    programming("Around both borders.",
                [](NodeBench& node) {
                  expect_rate(node, kPiSpeed, inertia_of(node.motor(), 152), 625);
                  expect_rate(node, kPiSpeed, inertia_of(node.motor(), 148), 400);
                  expect_rate(node, kPiSpeed, inertia_of(node.motor(), 102), 400);
                  expect_rate(node, kPiSpeed, inertia_of(node.motor(), 98), 320);
                }),

    must("morap.tune.pole-of-motor", "A pole faster than the motor's own is replaced by that.",
         "vector 51; reference, tuner", Profiles::kFirmware),
    programming("Two that are faster, one that is not.",
                [](NodeBench& node) {
                  const float inertia = inertia_of(node.motor(), 60);
                  node.tune(kPdPosition, inertia, -100.0F);
                  node.settle();
                  const auto limited = node.read(kReadPositionSet, 31);
                  node.tune(kPdPosition, inertia, -200.0F);
                  node.settle();
                  node.expect_same(node.read(kReadPositionSet, 31), limited);
                  node.tune(kPdPosition, inertia, -55.0F);
                  node.settle();
                  node.expect_true(node.read(kReadPositionSet, 31) != limited,
                                   "another controller for -55", "the same");
                }),

    must("morap.tune.at-tick", "Tuned parameters are in use from the next tick on and not before.",
         "firmware, tuner", Profiles::kFirmware),
    programming(
        "Read before and after the tick.",
        [](NodeBench& node) {
          node.tick();
          node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1");
          node.expect_bytes(kReadPositionSet, "00 71 02");
          node.tick();
          node.expect_bytes(kReadPositionSet, "00 90 01");
        },
        kFresh),
    variant("slowly", slowly([](NodeBench& node) {
              run_slow_loop(node);
              node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1");
              node.expect_bytes(kReadPositionSet, "00 05 00");
              node.send(kDisable);  // what was tuned is not to run from here
              node.tick(kIdleRateHz);
              node.expect_bytes(kReadPositionSet, "00 90 01");
            })),

    must("morap.tune.positive-pole", "A positive pole makes the status 3.",
         "document: poles are negative; vector 48"),
    programming(
        "1.",
        [](NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 00 00 80 3F", kFailure); }),

    must("morap.tune.fast-pole", "A pole below -200 makes the status 3.", "vector 52"),
    programming(
        "-200.01.",
        [](NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 8F 02 48 C3", kFailure); }),

    must("morap.tune.fastest-pole", "A pole of -200 is taken.", "vector 51"),
    programming(
        "-200.",
        [](NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 00 00 48 C3", kSuccess); }),

    must("morap.tune.heavy", "An inertia above 10 makes the status 3.", "vector 49"),
    programming("11, and the next above 10.",
                [](NodeBench& node) {
                  expect_outcome(node, "22 00 00 00 30 41 00 00 10 C1", kFailure);
                  expect_outcome(node, "22 00 01 00 20 41 00 00 10 C1", kFailure);
                }),

    must("morap.tune.heaviest", "An inertia of 10 is taken.", "recording static-tune-edges"),
    programming(
        "10.",
        [](NodeBench& node) { expect_outcome(node, "22 00 00 00 20 41 00 00 80 BF", kSuccess); }),

    must("morap.tune.negative-inertia", "A negative inertia makes the status 3.",
         "recording static-tune-fail"),
    programming(
        "-0.2.",
        [](NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C BE 00 00 10 C1", kFailure); }),

    must("morap.tune.unknown-kind", "A kind above 2 makes the status 3.", "vector 50"),
    programming("3 and 255.",
                [](NodeBench& node) {
                  expect_outcome(node, "22 03 CD CC 4C 3E 00 00 10 C1", kFailure);
                  expect_outcome(node, "22 FF CD CC 4C 3E 00 00 10 C1", kFailure);
                }),
    variant("each-bit",
            programming("Kinds 0 to 2 with one of the other bits.",
                        [](NodeBench& node) {
                          for (unsigned bit = 4; bit <= 0x80; bit <<= 1U) {
                            for (const unsigned kind : {bit, bit + 1, bit + 2}) {
                              node.about(fmt::format("kind {}", kind));
                              expect_outcome(node,
                                             fmt::format("22 {:02X} CD CC 4C 3E 00 00 10 C1", kind),
                                             kFailure);
                            }
                          }
                        })),

    must("morap.tune.failure-unused",
         "A refused tuning message leaves both controllers as they are.",
         "recording static-tune-fail", Profiles::kFirmware),
    programming("One of each controller.",
                [](NodeBench& node) {
                  const auto position = node.read(kReadPositionSet, 31);
                  const auto speed = node.read(kReadSpeedSet, 31);
                  node.send_bytes("22 00 00 00 30 41 00 00 10 C1");
                  node.send_bytes("22 02 CD CC 4C 3E 00 00 80 3F");
                  node.settle();
                  node.expect_same(node.read(kReadPositionSet, 31), position);
                  node.expect_same(node.read(kReadSpeedSet, 31), speed);
                }),

    variant("beside", slowly([](NodeBench& node) {
              run_slow_loop(node);
              node.send(proportional(kIdleRateHz, 1.0F, ControllerKind::kSpeed));
              const auto before = node.read(kReadSpeedSet, 3);
              node.send_bytes("22 00 00 00 30 41 00 00 10 C1");
              node.send(kDisable);
              node.tick(kIdleRateHz);
              const auto after = node.read(kReadSpeedSet, 3);
              node.expect_true(after != before, "the set that came before it in use", "not in use");
            })),

    must("morap.tune.short", "A tuning message of nine bytes does nothing.", "vector 53"),
    programming(
        "One byte is missing.",
        [](NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 00 00 10", kNothing); }),

    must("morap.tune.surplus", "An eleventh byte does no harm.", "vector 54"),
    programming("One byte more.",
                [](NodeBench& node) {
                  expect_outcome(node, "22 00 CD CC 4C 3E 00 00 10 C1 09", kSuccess);
                }),

    must("morap.tune.pieces", "A tuning message cannot be sent in two writes.",
         "recording static-tune-partial"),
    programming("The pole in a write of its own.",
                [](NodeBench& node) {
                  node.send_bytes("22 00 CD CC 4C 3E");
                  expect_outcome(node, "00 00 10 C1", kNothing);
                }),

    must("morap.tune.zero-pole", "A pole of 0 is taken.", "recording static-tune-edges",
         Profiles::kFirmware),
    programming(
        "0.",
        [](NodeBench& node) { expect_outcome(node, "22 00 CD CC 4C 3E 00 00 00 00", kSuccess); }),

    Requirement{"morap.tune.no-inertia", Level::kMay,
                "An inertia of 0 is taken, though no number comes out.", "reference, tuner",
                Profiles::kFirmware},
    programming(
        "0, never run.",
        [](NodeBench& node) {
          node.needs_emulation();
          expect_outcome(node, "22 00 00 00 00 00 00 00 10 C1", kSuccess);
        },
        kFresh),
};

}  // namespace

Chapter tune_chapter() { return chapter("Tuning", kTuneClauses); }

}  // namespace armjig::morap::conformance
