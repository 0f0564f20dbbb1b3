// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

using enum ProgrammingStatus;

// Messages without their identifier, from the reference's worked examples.
constexpr std::string_view kGood =
    "00 90 01 02 00 00 80 3F 00 00 00 40 02 00 00 80 3F 00 00 00 40 01 00 00 00 BF 00 00 00 00";
constexpr std::string_view kGoodSum = " A9";
constexpr std::string_view kSpeedSet =
    "01 40 01 01 00 00 00 3F 01 00 00 00 3F 01 00 00 00 BF 00 00 80 3E BD";
constexpr std::string_view kOfFour =
    "00 71 02 04 CD CC CC 3D CD CC 4C 3E 9A 99 99 3E CD CC CC 3E 04 00 00 00 3F 9A 99 19 3F 33 33 "
    "33 3F CD CC 4C 3F 04 CD CC CC BD CD CC 4C BE 9A 99 99 BE CD CC CC BE 0A D7 23 3C 7B";
constexpr std::string_view kOfThree =
    "00 90 01 03 00 00 80 3F 00 00 00 C0 00 00 80 3F 02 00 00 40 40 00 00 80 BF 02 00 00 80 3E 00 "
    "00 00 BF 00 00 00 00 E7";
constexpr std::string_view kOfNone = "00 C8 00 00 00 00 00 00 00 00";
constexpr std::string_view kZeros = "00 00 00 00 00 00 00 00 00 00";
constexpr std::string_view kOtherKind =
    "02 71 02 01 00 00 80 3F 01 00 00 80 3F 01 00 00 00 00 00 00 00 00 08";

void program(NodeBench& node, std::string_view set, std::string_view checksum = "") {
  node.send_bytes(fmt::format("20 {}{}", set, checksum));
}
std::string good() { return std::string{kGood}.append(kGoodSum); }

void status_at_boot(NodeBench& node) { node.expect_programming(kNothing); }

void success(NodeBench& node) {
  program(node, good());
  node.expect_programming(kSuccess);
}

void at_the_byte(NodeBench& node) {
  node.send_bytes(fmt::format("20 {}", good()), BusBench::End::kOpen);
  node.expect_programming(kSuccess);
}

/// Programmed, and read back when it is in use.
void expect_kept(NodeBench& node, CommandId selector, std::string_view set) {
  program(node, set);
  node.settle();
  node.expect_bytes(selector, set);
}

void position(NodeBench& node) { expect_kept(node, kReadPositionSet, good()); }
void speed(NodeBench& node) { expect_kept(node, kReadSpeedSet, kSpeedSet); }

void other_untouched(NodeBench& node) {
  const auto position_before = node.read(kReadPositionSet, 31);
  program(node, kSpeedSet);
  node.settle();
  node.expect_same(node.read(kReadPositionSet, 31), position_before);
  const auto speed_before = node.read(kReadSpeedSet, 23);
  program(node, good());
  node.settle();
  node.expect_same(node.read(kReadSpeedSet, 23), speed_before);
}

void at_tick(NodeBench& node) {
  node.tick();
  program(node, "00 C8 00 01 00 00 20 41 01 00 00 20 41 01 00 00 00 00 00 00 00 00 71");
  const auto before = node.read(kReadPositionSet, 4);
  node.expect_true(before[1] != std::byte{0xC8}, "the parameters before, before the tick",
                   "the new ones");
  node.tick();
  node.expect_bytes(kReadPositionSet, "00 C8 00 01");
}

void four(NodeBench& node) {
  program(node, kOfFour);
  node.expect_programming(kSuccess);
}
void four_kept(NodeBench& node) { expect_kept(node, kReadPositionSet, kOfFour); }
void uneven(NodeBench& node) { expect_kept(node, kReadPositionSet, kOfThree); }

void none(NodeBench& node) {
  program(node, kOfNone, " 37");
  node.expect_programming(kSuccess);
}

void any_bits(NodeBench& node) {
  expect_kept(node, kReadSpeedSet,
              "01 90 01 02 00 00 00 00 00 00 00 80 02 01 02 80 7F 00 00 80 FF 01 00 00 00 00 00 00 "
              "00 00 64");
}

void too_many_d(NodeBench& node) { expect_outcome(node, "20 00 C8 00 05", kFailure); }
void too_many_c(NodeBench& node) { expect_outcome(node, "20 00 C8 00 00 05", kFailure); }
void too_many_f(NodeBench& node) { expect_outcome(node, "20 00 C8 00 00 00 FF", kFailure); }

void too_many_rest(NodeBench& node) {
  // Behind the refused count all of a good message.
  node.send_bytes(fmt::format("20 00 C8 00 05 20 {}", good()));
  node.expect_programming(kFailure);
}

void wrong(NodeBench& node) {
  program(node, kGood, " A8");
  node.expect_programming(kFailure);
}

/// Programmed, but not in use.
void expect_unused(NodeBench& node, std::string_view checksum) {
  const auto before = node.read(kReadPositionSet, 31);
  program(node, kGood, checksum);
  node.settle();
  node.expect_same(node.read(kReadPositionSet, 31), before);
}

void wrong_unused(NodeBench& node) { expect_unused(node, " A8"); }

void complement(NodeBench& node) {
  program(node, kGood, " 56");
  node.expect_programming(kFailure);
}

void expect_failure_then_success(NodeBench& node, std::string_view wrong_checksum) {
  program(node, kGood, wrong_checksum);
  node.expect_programming(kFailure);
  program(node, good());
  node.expect_programming(kSuccess);
}

void fold(NodeBench& node) {
  // The bytes add up to 353; without the carry the checksum would be AC.
  expect_failure_then_success(node, " AC");
}

void fold_twice(NodeBench& node) {
  // Without coefficients, 200 Hz; the bytes add up to 2FF, then 101, then 2.
  program(node, "00 C8 00 00 00 00 FF FF 39 00 FD");
  node.expect_programming(kSuccess);
}

void integral(NodeBench& node) {
  // A9 is right for an integral gain of 0.
  program(node,
          "00 90 01 02 00 00 80 3F 00 00 00 40 02 00 00 80 3F 00 00 00 40 01 00 00 00 BF 00 "
          "00 80 3E A9");
  node.expect_programming(kFailure);
}

void zero(NodeBench& node) {
  node.needs_emulation();  // a rate of 0 is not for a motor
  program(node, kZeros, " 00");
  node.expect_programming(kFailure);
  program(node, kZeros, " FF");
  node.expect_programming(kSuccess);
}

void truncated(NodeBench& node) {
  for (const std::size_t bytes : {1U, 3U, 4U, 8U, 12U, 30U}) {
    node.about(fmt::format("the first {} bytes", bytes));
    program(node, kGood.substr(0, 3 * bytes - 1));
    const auto status = node.read(kReadProgrammingStatus, 1);
    node.expect_true(status[0] != std::byte{2}, "another programming status than 2", "2");
  }
}

void truncated_unchanged(NodeBench& node) {
  program(node, kGood);
  node.expect_programming(kNothing);
  program(node, good());
  node.settle();
  program(node, kSpeedSet.substr(0, 29));
  node.expect_programming(kSuccess);
}

void truncated_unused(NodeBench& node) { expect_unused(node, ""); }

void starts_anew(NodeBench& node) {
  program(node, kSpeedSet.substr(0, 29));
  program(node, good());
  node.expect_programming(kSuccess);
}

void surplus(NodeBench& node) {
  program(node, good(), " 00 00 00");
  node.expect_programming(kSuccess);
}

void status_stays(NodeBench& node) {
  program(node, good());
  for (int i = 0; i < 4; ++i) node.expect_programming(kSuccess);
}

void status_over_commands(NodeBench& node) {
  program(node, good());
  node.send(kCalibrateZero);
  node.send(kPosition, 0.0F);
  node.send(kDisable);
  node.send(kBrake14);
  node.expect_programming(kSuccess);
}

void after_failure(NodeBench& node) { expect_failure_then_success(node, " A8"); }

void other_kind(NodeBench& node) {
  const auto position_before = node.read(kReadPositionSet, 31);
  const auto speed_before = node.read(kReadSpeedSet, 31);
  program(node, kOtherKind);
  node.expect_programming(kSuccess);
  node.settle();
  node.expect_same(node.read(kReadPositionSet, 31), position_before);
  node.expect_same(node.read(kReadSpeedSet, 31), speed_before);
}

void zero_rate(NodeBench& node) { expect_of_zero_rate(node, kSuccess); }

void two_in_one_tick(NodeBench& node) {
  node.tick();
  const auto before = node.read(kReadPositionSet, 4);
  program(node, "00 C8 00 00 00 00 00 00 00 00", " 37");
  program(node, "01 C8 00 00 00 00 00 00 00 00", " 36");
  node.ticks(2);
  node.expect_same(node.read(kReadPositionSet, 4), before);
  node.expect_bytes(kReadSpeedSet, "01 C8 00 00");
}

void defaults_status(NodeBench& node) {
  program(node, good());
  node.settle();
  node.send(kDefaultControllers);
  node.expect_programming(kNothing);
}

/// Programmed, then loaded again.
void expect_back(NodeBench& node, CommandId selector, std::string_view set) {
  const auto before = node.read(selector, 31);
  program(node, set);
  node.settle();
  node.send(kDefaultControllers);
  node.settle();
  node.expect_same(node.read(selector, 31), before);
}

void defaults_position(NodeBench& node) { expect_back(node, kReadPositionSet, good()); }
void defaults_speed(NodeBench& node) { expect_back(node, kReadSpeedSet, kSpeedSet); }

void defaults_while_enabled(NodeBench& node) {
  const auto before = node.read(kReadPositionSet, 31);
  program(node, good());
  node.settle();
  node.send(kVoltage, 0.0F);
  node.send(kDefaultControllers);
  node.settle();
  node.send(kDisable);
  node.expect_same(node.read(kReadPositionSet, 31), before);
}

void defaults_at_tick(NodeBench& node) {
  const auto before = node.read(kReadPositionSet, 4);
  program(node, "00 C8 00 00 00 00 00 00 00 00", " 37");
  node.ticks(2);
  node.send(kDefaultControllers);
  node.expect_bytes(kReadPositionSet, "00 C8 00 00");
  node.tick();
  node.expect_same(node.read(kReadPositionSet, 4), before);
}

constexpr Case kCases[] = {
    programming("morap.program.status-at-boot", "It is read first.", on<status_at_boot>, kFresh),
    programming("morap.program.success", "Example 15.", on<success>),
    programming("morap.program.at-the-byte", "Example 15, with a repeated start.", on<at_the_byte>),
    programming("morap.program.position", "Example 15, read back.", on<position>),
    programming("morap.program.speed", "Example 11, read back.", on<speed>),
    programming("morap.program.other-untouched", "Each kind in turn.", on<other_untouched>),
    programming("morap.program.at-tick", "Read before and behind the tick.", on<at_tick>, kFresh),
    programming("morap.program.four", "Example 9.", on<four>),
    programming("morap.program.four-kept", "Example 9, read back.", on<four_kept>),
    programming("morap.program.uneven", "Example 13, read back.", on<uneven>),
    programming("morap.program.none", "None in any filter.", on<none>),
    programming("morap.program.any-bits", "Not a number and infinity, never run.", on<any_bits>),
    programming("morap.program.too-many-d", "5.", on<too_many_d>),
    programming("morap.program.too-many-c", "5.", on<too_many_c>),
    programming("morap.program.too-many-f", "255.", on<too_many_f>),
    programming("morap.program.too-many-rest", "All of a good message behind it.",
                on<too_many_rest>),
    programming("morap.checksum.wrong", "One less.", on<wrong>),
    programming("morap.checksum.wrong-unused", "One less, and a tick.", on<wrong_unused>),
    programming("morap.checksum.complement", "Example 15 with its sum.", on<complement>),
    programming("morap.checksum.fold", "Example 15 without and with it.", on<fold>),
    programming("morap.checksum.fold-twice", "A sum of 2FF.", on<fold_twice>),
    programming("morap.checksum.integral", "Another gain with the checksum for 0.", on<integral>),
    programming("morap.checksum.zero", "Example 7 with 00 and with FF.", on<zero>, kFresh),
    programming("morap.program.truncated", "Cut in each of its parts.", on<truncated>),
    programming("morap.program.truncated-unchanged", "Behind 1, and behind a success.",
                on<truncated_unchanged>),
    programming("morap.program.truncated-unused", "All but the checksum.", on<truncated_unused>),
    programming("morap.program.starts-anew", "Half of example 11, then example 15.",
                on<starts_anew>),
    programming("morap.program.surplus", "Three bytes more.", on<surplus>),
    programming("morap.program.status-stays", "Four reads.", on<status_stays>),
    programming("morap.program.status-over-commands", "Commands of other sorts.",
                on<status_over_commands>),
    programming("morap.program.after-failure", "A bad one, then a good one.", on<after_failure>),
    programming("morap.program.other-kind", "Example 10.", on<other_kind>),
    programming("morap.program.zero-rate", "0 Hz, never run.", on<zero_rate>, kFresh),
    programming("morap.program.two-in-one-tick", "A position and a speed controller.",
                on<two_in_one_tick>, kFresh),
    programming("morap.defaults.status", "Behind a success.", on<defaults_status>),
    programming("morap.defaults.position", "Programmed and loaded.", on<defaults_position>),
    programming("morap.defaults.speed", "Programmed and loaded.", on<defaults_speed>),
    programming("morap.defaults.while-enabled", "Programmed, then 0 V, then loaded.",
                on<defaults_while_enabled>),
    programming("morap.defaults.at-tick", "Read before and behind the tick.", on<defaults_at_tick>,
                kFresh),
};

}  // namespace

std::span<const Case> program_cases() noexcept { return kCases; }

}  // namespace armjig::morap::conformance
