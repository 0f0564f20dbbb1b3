// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <string>
#include <vector>

#include "conformance/morap/chapters.hpp"
#include "conformance/morap/node_bench.hpp"

namespace armjig::morap {
namespace {

using namespace std::chrono_literals;
using enum CommandId;

void poke_is_harmless(NodeBench& node) {
  node.send(kReadMotorStatus);
  node.send_bytes("");
  node.expect_read_on("03");
}

void reserved(NodeBench& node) {
  for (std::uint8_t address = 0x78; address < 0x80; ++address) node.expect_absent({address});
}

void general_call(NodeBench& node) { node.expect_absent({0}); }

void other_node(NodeBench& node) {
  node.send(kReadAddress);
  const std::vector status{static_cast<std::byte>(kReadMotorStatus)};
  for (std::uint8_t other = 0; other <= kLastDocumentedNode; ++other) {
    const BusAddress address{node_address(other)};
    if (address == node.address()) continue;
    std::ignore = node.write(address, status);
    node.about(fmt::format("its own address, behind a choice made at {:02X}", address.value));
    node.expect_same(node.read_on(1), std::vector{std::byte{node.address().value}});
  }
}

void seven_bits(NodeBench& node) {
  node.send(kReadAddress);
  const BusAddress other{static_cast<std::uint8_t>(node.address().value ^ 0x40U)};
  std::ignore = node.write(other, std::vector{static_cast<std::byte>(kReadMotorStatus)});
  node.expect_same(node.read_on(1), std::vector{std::byte{node.address().value}});
}

void acknowledges(NodeBench& node) {
  for (const auto id : {kDisable, kCalibrationUnknown, kBrake14, kBrake15, kReadAngle}) {
    node.about(fmt::format("identifier {}", static_cast<int>(id)));
    node.send(id);
  }
}

void acknowledges_float(NodeBench& node) { node.send_bytes("01 00 00 00 3F"); }

void acknowledges_tune(NodeBench& node) { node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1"); }

void acknowledges_unknown(NodeBench& node) {
  for (const auto* const write : {"06", "23 00 00", "7F 01 02 03", "8C", "FF FF FF FF FF FF"}) {
    node.send_bytes(write);
  }
}

void acknowledges_surplus(NodeBench& node) {
  for (const auto* const write : {"00 00", "1F 01 02 03", "80 81", "83 00 00 00 00 00 00"}) {
    node.send_bytes(write);
  }
}

void acknowledges_refused(NodeBench& node) { node.send_bytes("20 00 C8 00 05 00 00 00 00 00"); }

void repeated_start(NodeBench& node) {
  node.send_bytes("83", BusBench::End::kOpen);
  node.expect_read_on("03");
  node.send_bytes("88", BusBench::End::kOpen);
  node.expect_same(node.read_on(1), std::vector{std::byte{node.address().value}});
}

void without_stop(NodeBench& node) {
  node.send_bytes("01 00 00 80 3F", BusBench::End::kOpen);
  node.send_bytes("81");
  node.expect_read_on("00 00 80 3F");
}

void restart_cuts(NodeBench& node) {
  node.send(kPosition, 0.0F);
  node.send_bytes("01 CD CC", BusBench::End::kOpen);
  node.send_bytes("4C 3E");  // would complete it, and is no command
  node.expect_bytes(kReadPositionReference, "00 00 00 00");
}

/// How much longer a transaction takes than its bits at 100 kHz. In virtual time the first try
/// counts; in real time the best of some, for it may have been the machine that had no time.
template <class Transaction>
void expect_clock_time(NodeBench& node, Duration of_bits, Transaction transaction) {
  const int tries = node.noise() > Duration{} ? 5 : 1;
  constexpr Duration kMost = 5ms;
  auto held = Duration::max();
  for (int i = 0; i < tries && held > kMost; ++i) {
    const auto begin = node.now();
    transaction();
    held = node.now() - begin - of_bits - node.noise();
    node.settle();
  }
  node.expect_true(held <= kMost, "the clock held for 5 ms at most",
                   fmt::format("{} us", microseconds(at(held))));
}

void clock_while_tuning(NodeBench& node) {
  expect_clock_time(node, 1010us, [&node] { node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1"); });
}

void clock_before_read(NodeBench& node) {
  expect_clock_time(node, 200us, [&node] { std::ignore = node.read_on(1); });
}

void long_unknown(NodeBench& node) {
  node.send(kReadMotorStatus);
  std::vector<std::byte> bytes{std::byte{0x06}};
  while (bytes.size() < 59) bytes.push_back(static_cast<std::byte>(node.random()));
  node.send_bytes(bytes);
  node.expect_read_on("03");
}

void write_wraps(NodeBench& node) {
  node.needs_emulation();
  std::vector<std::byte> bytes(256, std::byte{0x06});
  bytes.push_back(static_cast<std::byte>(kReadMotorStatus));
  node.send_bytes(bytes);
  node.expect_read_on("03");
}

constexpr Case kCases[] = {
    {.requirement = "morap.bus.poke-harmless",
     .rule = "The chosen status is still read behind it.",
     .run = on<poke_is_harmless>,
     .hazard = Hazard::kState,
     .start = kUncalibrated},
    {.requirement = "morap.bus.reserved", .rule = "All of them are asked.", .run = on<reserved>},
    {.requirement = "morap.bus.general-call", .rule = "00 is asked.", .run = on<general_call>},
    {.requirement = "morap.bus.other-node",
     .rule = "Choices made at other nodes leave its own alone.",
     .run = on<other_node>},
    {.requirement = "morap.bus.seven-bits",
     .rule = "A choice at an address that differs in bit 6 leaves its own alone.",
     .run = on<seven_bits>},
    {.requirement = "morap.bus.acknowledges",
     .rule = "Commands without payload.",
     .run = on<acknowledges>,
     .hazard = Hazard::kState,
     .start = kUncalibrated},
    {.requirement = "morap.bus.acknowledges-float",
     .rule = "A position reference, not calibrated.",
     .run = on<acknowledges_float>,
     .hazard = Hazard::kState,
     .start = kUncalibrated},
    {.requirement = "morap.bus.acknowledges-tune",
     .rule = "A tuning message.",
     .run = on<acknowledges_tune>,
     .hazard = Hazard::kProgram,
     .start = kProgrammable},
    {.requirement = "morap.bus.acknowledges-unknown",
     .rule = "Some of all unknown identifiers.",
     .run = on<acknowledges_unknown>,
     .hazard = Hazard::kState,
     .start = kUncalibrated},
    {.requirement = "morap.bus.acknowledges-surplus",
     .rule = "Surplus behind commands that are safe with it.",
     .run = on<acknowledges_surplus>,
     .hazard = Hazard::kState,
     .start = kUncalibrated},
    {.requirement = "morap.bus.acknowledges-refused",
     .rule = "Five coefficients are too many.",
     .run = on<acknowledges_refused>,
     .hazard = Hazard::kState,
     .start = kUncalibrated},
    {.requirement = "morap.bus.repeated-start",
     .rule = "Status and address, chosen without a stop.",
     .run = on<repeated_start>,
     .hazard = Hazard::kState,
     .start = kUncalibrated},
    {.requirement = "morap.bus.without-stop",
     .rule = "A reference without a stop is read back.",
     .run = on<without_stop>,
     .hazard = Hazard::kState,
     .start = kUncalibrated},
    {.requirement = "morap.bus.restart-cuts",
     .rule = "Half a reference, and what would be its other half.",
     .run = on<restart_cuts>,
     .hazard = Hazard::kState,
     .start = kUncalibrated},
    {.requirement = "morap.bus.clock-while-tuning",
     .rule = "A tuning message takes hardly longer than its bits.",
     .run = on<clock_while_tuning>,
     .hazard = Hazard::kProgram,
     .start = kProgrammable},
    {.requirement = "morap.bus.clock-before-read",
     .rule = "A read takes hardly longer than its bits.",
     .run = on<clock_before_read>},
    {.requirement = "morap.bus.long-unknown",
     .rule = "The chosen status is still read.",
     .run = on<long_unknown>,
     .hazard = Hazard::kState,
     .start = kUncalibrated},
    {.requirement = "morap.bus.write-wraps",
     .rule = "256 bytes that mean nothing, and a choice.",
     .run = on<write_wraps>,
     .hazard = Hazard::kState,
     .start = kFresh},
};

}  // namespace

std::span<const Case> bus_cases() noexcept { return kCases; }

}  // namespace armjig::morap
