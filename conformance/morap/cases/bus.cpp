// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

void poke_is_harmless(NodeBench& node) {
  node.send(kReadMotorStatus);
  node.send_bytes("");
  node.expect_read_on("03");
}

void reserved(NodeBench& node) {
  for (std::uint8_t address = 0x78; address < 0x80; ++address) node.expect_absent({address});
}

void general_call(NodeBench& node) { node.expect_absent({0}); }

void expect_own_address(NodeBench& node) {
  node.expect_same(node.read_on(1), std::vector{std::byte{node.address().value}});
}
void choose_status_at(NodeBench& node, BusAddress other) {
  std::ignore = node.write(other, std::vector{static_cast<std::byte>(kReadMotorStatus)});
}

void other_node(NodeBench& node) {
  node.send(kReadAddress);
  for (std::uint8_t other = 0; other <= kLastDocumentedNode; ++other) {
    const BusAddress address{node_address(other)};
    if (address == node.address()) continue;
    choose_status_at(node, address);
    node.about(fmt::format("its own address, behind a choice made at {:02X}", address.value));
    expect_own_address(node);
  }
}

void seven_bits(NodeBench& node) {
  node.send(kReadAddress);
  choose_status_at(node, {static_cast<std::uint8_t>(node.address().value ^ 0x40U)});
  expect_own_address(node);
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
  expect_own_address(node);
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
    from(kUncalibrated, Hazard::kState, "morap.bus.poke-harmless",
         "The chosen status is still read behind it.", on<poke_is_harmless>),
    {.requirement = "morap.bus.reserved", .rule = "All of them are asked.", .run = on<reserved>},
    {.requirement = "morap.bus.general-call", .rule = "00 is asked.", .run = on<general_call>},
    {.requirement = "morap.bus.other-node",
     .rule = "Choices made at other nodes leave its own alone.",
     .run = on<other_node>},
    {.requirement = "morap.bus.seven-bits",
     .rule = "A choice at an address that differs in bit 6 leaves its own alone.",
     .run = on<seven_bits>},
    from(kUncalibrated, Hazard::kState, "morap.bus.acknowledges", "Commands without payload.",
         on<acknowledges>),
    from(kUncalibrated, Hazard::kState, "morap.bus.acknowledges-float",
         "A position reference, not calibrated.", on<acknowledges_float>),
    from(kProgrammable, Hazard::kProgram, "morap.bus.acknowledges-tune", "A tuning message.",
         on<acknowledges_tune>),
    from(kUncalibrated, Hazard::kState, "morap.bus.acknowledges-unknown",
         "Some of all unknown identifiers.", on<acknowledges_unknown>),
    from(kUncalibrated, Hazard::kState, "morap.bus.acknowledges-surplus",
         "Surplus behind commands that are safe with it.", on<acknowledges_surplus>),
    from(kUncalibrated, Hazard::kState, "morap.bus.acknowledges-refused",
         "Five coefficients are too many.", on<acknowledges_refused>),
    from(kUncalibrated, Hazard::kState, "morap.bus.repeated-start",
         "Status and address, chosen without a stop.", on<repeated_start>),
    from(kUncalibrated, Hazard::kState, "morap.bus.without-stop",
         "A reference without a stop is read back.", on<without_stop>),
    from(kUncalibrated, Hazard::kState, "morap.bus.restart-cuts",
         "Half a reference, and what would be its other half.", on<restart_cuts>),
    from(kProgrammable, Hazard::kProgram, "morap.bus.clock-while-tuning",
         "A tuning message takes hardly longer than its bits.", on<clock_while_tuning>),
    {.requirement = "morap.bus.clock-before-read",
     .rule = "A read takes hardly longer than its bits.",
     .run = on<clock_before_read>},
    from(kUncalibrated, Hazard::kState, "morap.bus.long-unknown",
         "The chosen status is still read.", on<long_unknown>),
    from(kFresh, Hazard::kState, "morap.bus.write-wraps",
         "256 bytes that mean nothing, and a choice.", on<write_wraps>),
};

}  // namespace

std::span<const Case> bus_cases() noexcept { return kCases; }

}  // namespace armjig::morap::conformance
