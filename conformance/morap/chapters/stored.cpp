// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/program_cases.hpp"

namespace armjig::morap::conformance {
namespace {

using enum ProgrammingStatus;

/// Programmed, then loaded again.
void expect_back(NodeBench& node, CommandId selector, std::string_view set) {
  const auto before = node.read(selector, 31);
  program(node, set);
  node.settle();
  node.send(kDefaultControllers);
  node.settle();
  node.expect_same(node.read(selector, 31), before);
}

/// The same with a reference of the other mode, which a node that is not calibrated only keeps.
template <CommandId selector, CommandId other_mode>
void expect_back_in_other_mode(NodeBench& node) {
  node.send(kCalibrationUnknown);
  node.send(other_mode, 0.0F);
  expect_back(node, selector, selector == kReadPositionSet ? good() : std::string{kSpeedSet});
  node.send(kCalibrationUnknown);
}

/// As they are at power-on, and when they were loaded.
template <CommandId selector>
void expect_stored(NodeBench& node) {
  const auto at_boot = node.read(selector, 59);
  node.send(kDefaultControllers);
  node.settle();
  node.expect_same(node.read(selector, 59), at_boot);
}

constexpr Clause kStoredClauses[] = {
    must("morap.defaults.status", "Loading the stored controllers makes the programming status 1.",
         "vector 41", Profiles::kFirmware),
    programming("After a success.",
                [](NodeBench& node) {
                  program(node, good());
                  node.settle();
                  node.send(kDefaultControllers);
                  node.expect_programming(kNothing);
                }),

    variant("failure", programming("After a refused message.",
                                   [](NodeBench& node) {
                                     program(node, kGood, " A8");
                                     node.send(kDefaultControllers);
                                     node.expect_programming(kNothing);
                                   })),

    must("morap.defaults.position", "Identifier 33 brings the stored position controller back.",
         "document; vector 41", Profiles::kFirmware),
    programming("Programmed and loaded.",
                [](NodeBench& node) { expect_back(node, kReadPositionSet, good()); }),
    variant("at-boot", programming("It is in use at power-on.", on<expect_stored<kReadPositionSet>>,
                                   kSwitchedOn)),

    variant("in-speed-mode", programming("After a speed reference.",
                                         on<expect_back_in_other_mode<kReadPositionSet, kSpeed>>)),

    must("morap.defaults.speed", "Identifier 33 brings the stored speed controller back.",
         "document; firmware", Profiles::kFirmware),
    programming("Programmed and loaded.",
                [](NodeBench& node) { expect_back(node, kReadSpeedSet, kSpeedSet); }),
    variant("at-boot", programming("It is in use at power-on.", on<expect_stored<kReadSpeedSet>>,
                                   kSwitchedOn)),

    variant("in-position-mode",
            programming("After a position reference.",
                        on<expect_back_in_other_mode<kReadSpeedSet, kPosition>>)),

    must("morap.defaults.while-enabled",
         "The stored controllers are loaded also into an enabled node.", "firmware, identifier 33",
         Profiles::kFirmware),
    programming("Programmed, then 0 V, then loaded.",
                [](NodeBench& node) {
                  const auto before = node.read(kReadPositionSet, 31);
                  program(node, good());
                  node.settle();
                  node.send(kVoltage, 0.0F);
                  node.send(kDefaultControllers);
                  node.settle();
                  node.send(kDisable);
                  node.expect_same(node.read(kReadPositionSet, 31), before);
                }),

    must("morap.defaults.at-tick",
         "The stored controllers are in use from the next tick on and not before.",
         "recording static-program-timing", Profiles::kFirmware),
    programming(
        "Read before and after the tick.",
        [](NodeBench& node) {
          const auto before = node.read(kReadPositionSet, 4);
          program(node, "00 C8 00 00 00 00 00 00 00 00", " 37");
          node.ticks(2);
          node.send(kDefaultControllers);
          node.expect_bytes(kReadPositionSet, "00 C8 00 00");
          node.tick();
          node.expect_same(node.read(kReadPositionSet, 4), before);
        },
        kFresh),
    variant("slowly", slowly([](NodeBench& node) {
              const auto before = node.read(kReadSpeedSet, 4);
              node.send(proportional(node.loop_rate(), 0.0F, ControllerKind::kSpeed));
              node.tick();
              run_slow_loop(node);
              node.send(kDefaultControllers);
              node.expect_bytes(kReadSpeedSet, "01 05 00 01");
              node.send(kDisable);  // what is stored is not to run from here
              node.tick(kIdleRateHz);
              node.expect_same(node.read(kReadSpeedSet, 4), before);
            })),

    must("morap.defaults.last-counts",
         "Of parameters and a load of the stored ones inside one tick the last is used.",
         "firmware: one flag for both", Profiles::kFirmware),
    variant("loaded", slowly([](NodeBench& node) {
              const auto before = node.read(kReadSpeedSet, 4);
              run_slow_loop(node);
              program(node, kSpeedSet);
              node.send(kDefaultControllers);
              node.send(kDisable);  // what is stored is not to run from here
              node.tick(kIdleRateHz);
              node.expect_same(node.read(kReadSpeedSet, 4), before);
            })),
    variant("programmed", slowly([](NodeBench& node) {
              run_slow_loop(node);
              node.send(kDefaultControllers);
              program(node, kSpeedSet);
              node.send(kDisable);
              node.tick(kIdleRateHz);
              node.expect_bytes(kReadSpeedSet, kSpeedSet);
            })),

    must("morap.defaults.running", "A loop that runs goes on at the rate of its stored controller.",
         "firmware, identifier 33 and tick", Profiles::kFirmware),
    slowly([](NodeBench& node) {
      // At its reference, so that nothing turns, whichever controller has it.
      run_loop(node, proportional(node.loop_rate(), 1.0F), 0.0F);
      node.send(kDefaultControllers);
      node.tick(kIdleRateHz);
      expect_near_ticks(node);
    }),
};

}  // namespace

Chapter stored_chapter() { return chapter("Stored controllers", kStoredClauses); }

}  // namespace armjig::morap::conformance
