// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/program_cases.hpp"

namespace armjig::morap::conformance {
namespace {

using enum ProgrammingStatus;

// Messages without their identifier, from the reference's worked examples.
constexpr std::string_view kOfFour =
    "00 71 02 04 CD CC CC 3D CD CC 4C 3E 9A 99 99 3E CD CC CC 3E 04 00 00 00 3F 9A 99 19 3F 33 33 "
    "33 3F CD CC 4C 3F 04 CD CC CC BD CD CC 4C BE 9A 99 99 BE CD CC CC BE 0A D7 23 3C 7B";

constexpr std::string_view kOfThree =
    "00 90 01 03 00 00 80 3F 00 00 00 C0 00 00 80 3F 02 00 00 40 40 00 00 80 BF 02 00 00 80 3E 00 "
    "00 00 BF 00 00 00 00 E7";

constexpr std::string_view kOfNone = "00 C8 00 00 00 00 00 00 00 00";

constexpr std::string_view kZeros = "00 00 00 00 00 00 00 00 00 00";

/// Programmed, and read back when it is in use.
void expect_kept(NodeBench& node, CommandId selector, std::string_view set) {
  program(node, set);
  node.settle();
  node.expect_bytes(selector, set);
}

/// Programmed, but not in use.
void expect_unused(NodeBench& node, std::string_view checksum) {
  const auto before = node.read(kReadPositionSet, 31);
  program(node, kGood, checksum);
  node.settle();
  node.expect_same(node.read(kReadPositionSet, 31), before);
}

void expect_failure_then_success(NodeBench& node, std::string_view wrong_checksum) {
  program(node, kGood, wrong_checksum);
  node.expect_programming(kFailure);
  program(node, good());
  node.expect_programming(kSuccess);
}

void expect_no_other_checksum(NodeBench& node) {
  for (int checksum = 0; checksum < 256; ++checksum) {
    const auto text = fmt::format(" {:02X}", checksum);
    if (text == kGoodSum) continue;
    node.about(fmt::format("checksum{}", text));
    program(node, kGood, text);
    node.expect_programming(kFailure);
  }
}

/// New parameters, which never run, are read before and after the next tick.
void expect_in_use_at_tick(NodeBench& node) {
  program(node, "01 2C 01 01 00 00 20 41 01 00 00 20 41 01 00 00 00 00 00 00 00 00 0C");
  node.expect_programming(kSuccess);
  const auto before = node.read(kReadSpeedSet, 4);
  node.expect_true(before[1] != std::byte{0x2C}, "the parameters before, before the tick",
                   "the new ones");
  node.tick();
  node.expect_bytes(kReadSpeedSet, "01 2C 01 01");
}

/// A position and a speed controller before the next tick.
void expect_last_in_use(NodeBench& node) {
  const auto before = node.read(kReadPositionSet, 4);
  program(node, "00 C8 00 01 00 00 00 00 01 00 00 00 00 01 00 00 00 00 00 00 00 00", " 34");
  program(node, "01 2C 01 01 00 00 20 41 01 00 00 20 41 01 00 00 00 00 00 00 00 00", " 0C");
  node.ticks(2);
  node.expect_same(node.read(kReadPositionSet, 4), before);
  node.expect_bytes(kReadSpeedSet, "01 2C 01 01");
}

/// All bits of each coefficient set, then none.
void expect_all_bits_kept(NodeBench& node) {
  for (const std::uint32_t bits : {UINT32_MAX, std::uint32_t{0}}) {
    Coefficients some{kMostCoefficients};
    some.values.fill(std::bit_cast<float>(bits));
    const auto rate = static_cast<std::uint16_t>(bits == 0 ? 0x0100 : 0x02FF);
    const auto message =
        encode(Command{kProgram, ControllerSet{ControllerKind::kSpeed, rate, some, some, some,
                                               std::bit_cast<float>(bits)}});
    node.send_bytes(message);
    node.settle();
    node.expect_same(node.read(kReadSpeedSet, message.view().size() - 1),
                     message.view().subspan(1));
  }
}

/// A whole message and a refused one before the next tick. What is then in use must never run.
void expect_mixed(NodeBench& node, std::string_view refused, CommandId selector,
                  std::string_view read_back) {
  program(node, kOfFour);
  node.expect_programming(kSuccess);
  program(node, refused);
  node.expect_programming(kFailure);
  node.ticks(3);
  node.expect_bytes(selector, read_back);
}

void expect_too_many(NodeBench& node, std::string_view refused, CommandId selector,
                     std::string_view read_back) {
  node.needs_emulation();
  node.tick();
  expect_mixed(node, refused, selector, read_back);
}

constexpr std::string_view kSevenOfSecond = "01 90 01 01 00 00 A0 40 07";
constexpr std::string_view kSevenReadBack =
    "01 90 01 01 00 00 A0 40 07 00 00 00 3F 9A 99 19 3F 33 33 33 3F CD CC 4C 3F 00 00 CD CC CC BD "
    "CD CC 4C BE 9A 99 00 0A D7 23 3C 79";

constexpr Clause kProgramClauses[] = {
    must("morap.program.status-at-boot", "After power-on the programming status is 1.",
         "document, programming status; vector 3"),
    programming(
        "It is read first.", [](NodeBench& node) { node.expect_programming(kNothing); },
        kSwitchedOn),

    must("morap.program.success",
         "A parameter message with the right checksum makes the programming status 2.",
         "document, programming; vector 30"),
    programming("Example 15.",
                [](NodeBench& node) {
                  program(node, good());
                  node.expect_programming(kSuccess);
                }),

    must("morap.program.at-the-byte",
         "The programming status changes with the checksum byte, before the stop.",
         "recording static-program-timing"),
    programming("Example 15, with a repeated start.",
                [](NodeBench& node) {
                  node.send_bytes(fmt::format("20 {}", good()), BusBench::End::kOpen);
                  node.expect_programming(kSuccess);
                }),

    must("morap.program.position",
         "A message of kind 0 becomes the position controller, byte for byte.", "vector 30",
         Profiles::kFirmware),
    programming("Example 15, read back.",
                [](NodeBench& node) { expect_kept(node, kReadPositionSet, good()); }),
    variant("alone", programming("With another message after it in the same write.",
                                 [](NodeBench& node) {
                                   const auto speed = node.read(kReadSpeedSet, 23);
                                   program(node, good(), " 01 40 01 02 00 00 00 3F");
                                   node.expect_programming(kSuccess);
                                   node.settle();
                                   node.expect_bytes(kReadPositionSet, good());
                                   node.expect_same(node.read(kReadSpeedSet, 23), speed);
                                 })),

    must("morap.program.speed", "A message of kind 1 becomes the speed controller, byte for byte.",
         "recording static-program-sizes", Profiles::kFirmware),
    programming("Example 11, read back.",
                [](NodeBench& node) { expect_kept(node, kReadSpeedSet, kSpeedSet); }),

    must("morap.program.other-untouched",
         "A message for one controller leaves the other one alone.",
         "recording static-program-sizes", Profiles::kFirmware),
    programming("Each kind in turn.",
                [](NodeBench& node) {
                  const auto position_before = node.read(kReadPositionSet, 31);
                  program(node, kSpeedSet);
                  node.settle();
                  node.expect_same(node.read(kReadPositionSet, 31), position_before);
                  const auto speed_before = node.read(kReadSpeedSet, 23);
                  program(node, good());
                  node.settle();
                  node.expect_same(node.read(kReadSpeedSet, 23), speed_before);
                }),

    must("morap.program.at-tick",
         "Accepted parameters are in use from the next tick on and not before.", "vector 30",
         Profiles::kFirmware),
    programming(
        "Read before and after the tick.",
        [](NodeBench& node) {
          node.tick();
          expect_in_use_at_tick(node);
        },
        kFresh),
    variant("slowly", slowly([](NodeBench& node) {
              run_slow_loop(node);
              expect_in_use_at_tick(node);
            })),

    must("morap.program.four", "Up to four coefficients of each filter are taken.",
         "document, programming; reference, example 9"),
    programming("Example 9.",
                [](NodeBench& node) {
                  program(node, kOfFour);
                  node.expect_programming(kSuccess);
                }),

    must("morap.program.four-kept", "All of four coefficients are kept, in their order.",
         "recording static-program-sizes", Profiles::kFirmware),
    programming("Example 9, read back.",
                [](NodeBench& node) { expect_kept(node, kReadPositionSet, kOfFour); }),

    must("morap.program.uneven", "The three filters may have different numbers of coefficients.",
         "recording static-program-sizes; reference, example 13", Profiles::kFirmware),
    programming("Example 13, read back.",
                [](NodeBench& node) { expect_kept(node, kReadPositionSet, kOfThree); }),

    must("morap.program.none", "A filter without coefficients is taken.",
         "document, programming; recording static-program-sizes"),
    programming("None in any filter.",
                [](NodeBench& node) {
                  program(node, kOfNone, " 37");
                  node.expect_programming(kSuccess);
                }),

    must("morap.program.any-bits", "Coefficients are kept bit for bit, whatever number they are.",
         "firmware: nothing looks at them", Profiles::kFirmware),
    programming(
        "Not a number and infinity, never run.",
        [](NodeBench& node) {
          expect_kept(
              node, kReadSpeedSet,
              "01 90 01 02 00 00 00 00 00 00 00 80 02 01 02 80 7F 00 00 80 FF 01 00 00 00 00 00 00 "
              "00 00 64");
        }),

    variant("one-after-the-other", programming("All bits, then none.", on<expect_all_bits_kept>)),

    must("morap.program.too-many-d",
         "A count above 4 of the first filter makes the status 3 at once.", "vector 32"),
    programming("5.", [](NodeBench& node) { expect_outcome(node, "20 00 C8 00 05", kFailure); }),

    must("morap.program.too-many-c",
         "A count above 4 of the second filter makes the status 3 at once.", "vector 33"),
    programming("5.", [](NodeBench& node) { expect_outcome(node, "20 00 C8 00 00 05", kFailure); }),

    must("morap.program.too-many-f",
         "A count above 4 of the third filter makes the status 3 at once.", "vector 34"),
    programming("255.",
                [](NodeBench& node) { expect_outcome(node, "20 00 C8 00 00 00 FF", kFailure); }),

    must("morap.program.too-many-any", "Any count above 4 is refused, of each filter.",
         "document, parameter message; recording static-program-limits"),
    programming("Seven counts of each filter.",
                [](NodeBench& node) {
                  for (const auto* const before : {"", "00 ", "00 00 "}) {
                    for (const auto* const count : {"05", "06", "08", "10", "40", "80", "FF"}) {
                      const auto message = fmt::format("20 00 C8 00 {}{}", before, count);
                      expect_outcome(node, fmt::format("20 {}", good()), kSuccess);
                      node.about(message);
                      expect_outcome(node, message, kFailure);
                    }
                  }
                }),

    must("morap.program.too-many-rest",
         "What follows a refused count is ignored until the write ends.",
         "recording static-program-limits"),
    programming("All of a good message after it.",
                [](NodeBench& node) {
                  // Behind the refused count all of a good message.
                  node.send_bytes(fmt::format("20 00 C8 00 05 20 {}", good()));
                  node.expect_programming(kFailure);
                }),

    must(
        "morap.program.too-many-active",
        "A refused count stays, and is in use with what a good message before it had staged, if no "
        "tick came between; then the read-back goes on with the fields after the coefficients, as "
        "they lie in memory.",
        "recordings random/mini-count5-active, random/s1-race-905 and others", Profiles::kFirmware),
    variant("d", programming(
                     "7 and 10 of the first filter.",
                     [](NodeBench& node) {
                       expect_too_many(node, "00 C8 00 07", kReadPositionSet,
                                       "00 C8 00 07 CD CC CC 3D CD CC 4C 3E 9A 99 99 3E CD CC CC "
                                       "3E 00 00 00 00 00 3F 9A 99 19 3F 33 33 00 00 0A D7 23 3C "
                                       "41");
                       expect_too_many(node, "00 C8 00 0A", kReadPositionSet,
                                       "00 C8 00 0A CD CC CC 3D CD CC 4C 3E 9A 99 99 3E CD CC CC "
                                       "3E 00 00 00 00 00 3F 9A 99 19 3F 33 33 33 3F CD CC 4C 3F "
                                       "00 00 CD CC CC BD 00 00 0A D7 23 3C 80");
                     },
                     kFresh)),
    variant("c", programming(
                     "7 of the second, after one of the first.",
                     [](NodeBench& node) {
                       expect_too_many(node, kSevenOfSecond, kReadSpeedSet, kSevenReadBack);
                     },
                     kFresh)),
    variant("c.slowly", slowly([](NodeBench& node) {
              run_slow_loop(node);
              expect_mixed(node, kSevenOfSecond, kReadSpeedSet, kSevenReadBack);
              node.send(kDisable);
            })),
    variant("f", programming(
                     "5 of the third: the gain of the integrator comes twice.",
                     [](NodeBench& node) {
                       expect_too_many(node, "00 C8 00 00 00 05", kReadPositionSet,
                                       "00 C8 00 00 00 05 CD CC CC BD CD CC 4C BE 9A 99 99 BE CD "
                                       "CC CC BE 0A D7 23 3C 0A D7 23 3C 32");
                     },
                     kFresh)),

    must("morap.checksum.wrong", "A wrong checksum makes the status 3.",
         "document, checksum; vector 31"),
    programming("One less.",
                [](NodeBench& node) {
                  program(node, kGood, " A8");
                  node.expect_programming(kFailure);
                }),
    variant("any", programming("All but the right one.", on<expect_no_other_checksum>)),

    must("morap.checksum.wrong-unused", "Parameters with a wrong checksum are not used.",
         "vector 31", Profiles::kFirmware),
    programming("One less, and a tick.", [](NodeBench& node) { expect_unused(node, " A8"); }),

    must("morap.checksum.complement",
         "The sum itself, without the complement, is a wrong checksum.", "document, checksum"),
    programming("Example 15 with its sum.",
                [](NodeBench& node) {
                  program(node, kGood, " 56");
                  node.expect_programming(kFailure);
                }),

    must("morap.checksum.fold", "The carry of the sum is added to it again.",
         "document, checksum; reference, example 1"),
    programming("Example 15 without and with it.",
                [](NodeBench& node) {
                  // The bytes add up to 353; without the carry the checksum would be AC.
                  expect_failure_then_success(node, " AC");
                }),

    must("morap.checksum.fold-twice", "So is the carry that this may give.",
         "document, checksum; reference, example 14"),
    programming("A sum of 2FF.",
                [](NodeBench& node) {
                  // Without coefficients, 200 Hz; the bytes add up to 2FF, then 101, then 2.
                  program(node, "00 C8 00 00 00 00 FF FF 39 00 FD");
                  node.expect_programming(kSuccess);
                }),

    must("morap.checksum.integral", "The checksum includes the gain of the integrator.",
         "document, checksum"),
    programming(
        "Another gain with the checksum for 0.",
        [](NodeBench& node) {
          // A9 is right for an integral gain of 0.
          program(
              node,
              "00 90 01 02 00 00 80 3F 00 00 00 40 02 00 00 80 3F 00 00 00 40 01 00 00 00 BF 00 "
              "00 80 3E A9");
          node.expect_programming(kFailure);
        }),

    must("morap.checksum.zero", "The checksum of nothing but zeros is FF.",
         "reference, example 7; recording static-program-checksum", Profiles::kFirmware),
    programming(
        "Example 7 with 00 and with FF.",
        [](NodeBench& node) {
          node.needs_emulation();  // a rate of 0 is not for a motor
          program(node, kZeros, " 00");
          node.expect_programming(kFailure);
          program(node, kZeros, " FF");
          node.expect_programming(kSuccess);
        },
        kFresh),

    must("morap.program.truncated", "A message that ends early does not make the status 2.",
         "vector 35"),
    programming("Cut in each of its parts.",
                [](NodeBench& node) {
                  for (const std::size_t bytes : {1U, 3U, 4U, 8U, 12U, 30U}) {
                    node.about(fmt::format("the first {} bytes", bytes));
                    program(node, kGood.substr(0, 3 * bytes - 1));
                    const auto status = node.read(kReadProgrammingStatus, 1);
                    node.expect_true(status[0] != std::byte{2}, "another programming status than 2",
                                     "2");
                  }
                }),

    must("morap.program.truncated-unchanged",
         "A message that ends early leaves the status as it was.", "vector 36"),
    programming("After 1, and after a success.",
                [](NodeBench& node) {
                  program(node, kGood);
                  node.expect_programming(kNothing);
                  program(node, good());
                  node.settle();
                  program(node, kSpeedSet.substr(0, 29));
                  node.expect_programming(kSuccess);
                }),

    must("morap.program.truncated-unused", "Parameters of a message that ends early are not used.",
         "recording static-program-truncated", Profiles::kFirmware),
    programming("All but the checksum.", [](NodeBench& node) { expect_unused(node, ""); }),

    must("morap.program.starts-anew",
         "Each message begins again, whatever the one before left open.", "vector 38"),
    programming("Half of example 11, then example 15.",
                [](NodeBench& node) {
                  program(node, kSpeedSet.substr(0, 29));
                  program(node, good());
                  node.expect_programming(kSuccess);
                }),

    must("morap.program.surplus", "Bytes after the checksum change nothing of a good message.",
         "vector 37"),
    programming("Three bytes more.",
                [](NodeBench& node) {
                  program(node, good(), " 00 00 00");
                  node.expect_programming(kSuccess);
                }),

    variant("wrong-then-right", programming("After a wrong checksum the right one.",
                                            [](NodeBench& node) {
                                              program(node, kGood, " A8 A9 A9 A9");
                                              node.expect_programming(kFailure);
                                            })),

    must("morap.program.status-stays", "The programming status stays however often it is read.",
         "firmware, programming status"),
    programming("Four reads.",
                [](NodeBench& node) {
                  program(node, good());
                  for (int i = 0; i < 4; ++i) node.expect_programming(kSuccess);
                }),

    variant("failure", programming("Four reads after a refused message.",
                                   [](NodeBench& node) {
                                     program(node, kGood, " A8");
                                     for (int i = 0; i < 4; ++i) node.expect_programming(kFailure);
                                   })),

    must("morap.program.status-over-commands", "Other commands leave the programming status alone.",
         "firmware, programming status"),
    programming("Commands of other sorts.",
                [](NodeBench& node) {
                  program(node, good());
                  node.send(kCalibrateZero);
                  node.send(kPosition, 0.0F);
                  node.send(kDisable);
                  node.send(kBrake14);
                  node.expect_programming(kSuccess);
                }),

    must("morap.program.after-failure", "After a refused message a good one is taken.",
         "recording static-program-checksum"),
    programming("A bad one, then a good one.",
                [](NodeBench& node) { expect_failure_then_success(node, " A8"); }),

    must("morap.program.other-kind",
         "A message of another kind than 0 and 1 makes the status 2 and is used nowhere.",
         "vector 39", Profiles::kFirmware),
    programming("Example 10.",
                [](NodeBench& node) {
                  const auto position_before = node.read(kReadPositionSet, 31);
                  const auto speed_before = node.read(kReadSpeedSet, 31);
                  program(node, kOtherKind);
                  node.expect_programming(kSuccess);
                  node.settle();
                  node.expect_programming(kSuccess);
                  node.expect_same(node.read(kReadPositionSet, 31), position_before);
                  node.expect_same(node.read(kReadSpeedSet, 31), speed_before);
                }),

    Requirement{"morap.program.zero-rate", Level::kMay, "A rate of 0 is taken.",
                "reference, contradiction 13", Profiles::kFirmware},
    programming(
        "0 Hz, never run.", [](NodeBench& node) { expect_of_zero_rate(node, kSuccess); }, kFresh),

    Requirement{"morap.program.two-in-one-tick", Level::kMay,
                "Of two messages inside one tick only the last is used.", "vector 40",
                Profiles::kFirmware},
    programming(
        "A position and a speed controller.",
        [](NodeBench& node) {
          node.tick();
          expect_last_in_use(node);
        },
        kFresh),
    variant("slowly", slowly([](NodeBench& node) {
              run_slow_loop(node);
              expect_last_in_use(node);
            })),
};

}  // namespace

Chapter program_chapter() { return chapter("Programming", kProgramClauses); }

}  // namespace armjig::morap::conformance
