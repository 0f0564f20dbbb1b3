// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/cases.hpp"

namespace armjig::morap::conformance {
namespace {

void expect_own_address(NodeBench& node) {
  node.expect_same(node.read_on(1), std::vector{std::byte{node.address().value}});
}

void choose_status_at(NodeBench& node, BusAddress other) {
  std::ignore = node.write(other, std::vector{static_cast<std::byte>(kReadMotorStatus)});
}

/// Whether it is this node that answers there. Another one may be there, and happen to say the same
/// once, but it does not choose what this one is told to choose.
bool answers_at(NodeBench& node, BusAddress other) {
  for (const auto selector : {kReadAddress, kReadMotorStatus}) {
    const auto own = node.read(selector, 1);
    if (node.BusBench::read(other, 1) != own) return false;
  }
  return true;
}

void expect_all_bits_compared(NodeBench& node) {
  for (unsigned bit = 0; bit < 7; ++bit) {
    const BusAddress other{static_cast<std::uint8_t>(node.address().value ^ (1U << bit))};
    if (answers_at(node, other)) {
      node.fail(fmt::format("no answer of this node at {:02X}", other.value), "one");
    }
  }
}

/// How much longer a transaction takes than its bits at 100 kHz. In virtual time the first try
/// counts; in real time the best of some, for it may have been the machine that had no time.
template <class Transaction>
void expect_clock_time(NodeBench& node, Duration of_bits, Transaction transaction) {
  const int tries = node.noise() > Duration{} ? 5 : 1;
  constexpr auto kMost = NodeBench::kLongestHold;
  auto held = Duration::max();
  for (int i = 0; i < tries && held > kMost; ++i) {
    const auto begin = node.now();
    transaction();
    held = node.now() - begin - of_bits - node.link_noise();
    node.settle();
  }
  node.expect_in_time({std::max(milliseconds(held), 0.0), 0, milliseconds(kMost), "ms"},
                      "the clock held for 5 ms at most",
                      fmt::format("{} us", microseconds(at(held))));
}

constexpr Clause kBusClauses[] = {
    must("morap.bus.poke-harmless", "A write of nothing changes nothing.", "firmware, vector 24"),
    from(kUncalibrated, Hazard::kState, "The chosen status is still read after it.",
         [](NodeBench& node) {
           node.send(kReadMotorStatus);
           node.send_bytes("");
           node.expect_read_on("03");
         }),

    must("morap.bus.reserved", "A node acknowledges no reserved address, 78 to 7F.",
         "I2C; firmware: one address"),
    look("All of them are asked.",
         [](NodeBench& node) {
           for (std::uint8_t address = 0x78; address < 0x80; ++address)
             node.expect_absent({address});
         }),

    must("morap.bus.general-call", "A node does not acknowledge the general call.",
         "firmware, slave configuration, vector B2"),
    look("00 is asked.", [](NodeBench& node) { node.expect_absent({0}); }),

    must("morap.bus.other-node",
         "What is written to the address of another node does not reach this one.",
         "document, addresses; recording bus-three-nodes"),
    look("Choices made at other nodes leave its own alone.",
         [](NodeBench& node) {
           node.send(kReadAddress);
           for (std::uint8_t other = 0; other <= kLastDocumentedNode; ++other) {
             const BusAddress address{node_address(other)};
             if (address == node.address()) continue;
             choose_status_at(node, address);
             node.about(
                 fmt::format("its own address, after a choice made at {:02X}", address.value));
             expect_own_address(node);
           }
         }),

    must("morap.bus.seven-bits", "A node compares all seven bits of an address.",
         "document, addresses; recording bus-scan"),
    look("A choice at an address that differs in bit 6 leaves its own alone.",
         [](NodeBench& node) {
           node.send(kReadAddress);
           choose_status_at(node, {static_cast<std::uint8_t>(node.address().value ^ 0x40U)});
           expect_own_address(node);
         }),
    variant("each",
            look("It does not answer where one bit differs.", on<expect_all_bits_compared>)),

    must("morap.bus.acknowledges", "A node acknowledges every byte of a command.",
         "firmware: its hardware does"),
    from(kUncalibrated, Hazard::kState, "Commands without payload.",
         [](NodeBench& node) {
           for (const auto id : {kDisable, kCalibrationUnknown, kBrake14, kBrake15, kReadAngle}) {
             node.about(fmt::format("identifier {}", static_cast<int>(id)));
             node.send(id);
           }
         }),

    must("morap.bus.acknowledges-float",
         "A node acknowledges the last byte of a command with a number.", "firmware"),
    from(kUncalibrated, Hazard::kState, "A position reference, not calibrated.",
         [](NodeBench& node) { node.send_bytes("01 00 00 00 3F"); }),

    must("morap.bus.acknowledges-tune",
         "A node acknowledges the last byte of a tuning message, before it computes.",
         "firmware, vector B8"),
    from(kProgrammable, Hazard::kProgram, "A tuning message.",
         [](NodeBench& node) { node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1"); }),

    must("morap.bus.acknowledges-unknown",
         "A node acknowledges identifiers that it does not know, and all that follows them.",
         "recording static-unknown-ids"),
    from(kUncalibrated, Hazard::kState, "Some of all unknown identifiers.",
         [](NodeBench& node) {
           for (const auto* const write :
                {"06", "23 00 00", "7F 01 02 03", "8C", "FF FF FF FF FF FF"}) {
             node.send_bytes(write);
           }
         }),

    must("morap.bus.acknowledges-surplus", "A node acknowledges bytes after a complete command.",
         "recording static-overlong-writes"),
    from(kUncalibrated, Hazard::kState, "Surplus after commands that are safe with it.",
         [](NodeBench& node) {
           for (const auto* const write :
                {"00 00", "1F 01 02 03", "80 81", "83 00 00 00 00 00 00"}) {
             node.send_bytes(write);
           }
         }),

    must("morap.bus.acknowledges-refused",
         "A node acknowledges all of a parameter message that it refuses; only its status tells.",
         "firmware; recording static-program-limits"),
    from(kUncalibrated, Hazard::kState, "Five coefficients are too many.",
         [](NodeBench& node) { node.send_bytes("20 00 C8 00 05 00 00 00 00 00"); }),

    must("morap.bus.repeated-start",
         "A repeated start between choosing and reading does the same as a stop and a start.",
         "recording static-repeated-start"),
    from(kUncalibrated, Hazard::kState, "Status and address, chosen without a stop.",
         [](NodeBench& node) {
           node.send_bytes("83", BusBench::End::kOpen);
           node.expect_read_on("03");
           node.send_bytes("88", BusBench::End::kOpen);
           expect_own_address(node);
         }),

    must("morap.bus.without-stop",
         "A command acts with its last byte; a repeated start in place of the stop takes nothing "
         "away.",
         "firmware, vector B4"),
    from(kUncalibrated, Hazard::kState, "A reference without a stop is read back.",
         [](NodeBench& node) {
           node.send_bytes("01 00 00 80 3F", BusBench::End::kOpen);
           node.send_bytes("81");
           node.expect_read_on("00 00 80 3F");
         }),

    must("morap.bus.restart-cuts",
         "A repeated start inside a command cuts it off, and another one begins.",
         "recording static-repeated-start"),
    from(kUncalibrated, Hazard::kState, "Half a reference, and what would be its other half.",
         [](NodeBench& node) {
           node.send(kPosition, 0.0F);
           node.send_bytes("01 CD CC", BusBench::End::kOpen);
           node.send_bytes("4C 3E");  // would complete it, and is no command
           node.expect_bytes(kReadPositionReference, "00 00 00 00");
         }),

    should("morap.bus.clock-while-tuning",
           "A node holds the clock for at most 5 ms, also while it computes parameters.",
           "reference: about 1 ms is estimated, and a master has to bear 5"),
    from(kProgrammable, Hazard::kProgram, "A tuning message takes hardly longer than its bits.",
         [](NodeBench& node) {
           expect_clock_time(node, 1010us,
                             [&node] { node.send_bytes("22 00 CD CC 4C 3E 00 00 10 C1"); });
         }),
    variant("loading", from(kProgrammable, Hazard::kProgram,
                            "Loading the stored controllers takes hardly longer than its bits.",
                            [](NodeBench& node) {
                              expect_clock_time(node, 200us,
                                                [&node] { node.send(kDefaultControllers); });
                            })),

    should("morap.bus.clock-before-read",
           "A node holds the clock for at most 5 ms before the first byte of an answer.",
           "reference: about 0.1 ms is estimated, and a master has to bear 5"),
    look("A read takes hardly longer than its bits.",
         [](NodeBench& node) {
           expect_clock_time(node, 200us, [&node] { std::ignore = node.read_on(1); });
         }),

    must("morap.bus.long-unknown", "59 bytes that begin with an unknown identifier change nothing.",
         "firmware, vector B9"),
    from(kUncalibrated, Hazard::kState, "The chosen status is still read.",
         [](NodeBench& node) {
           node.send(kReadMotorStatus);
           std::vector<std::byte> bytes{std::byte{0x06}};
           while (bytes.size() < 59) bytes.push_back(static_cast<std::byte>(node.random()));
           node.send_bytes(bytes);
           node.expect_read_on("03");
         }),

    Requirement{
        "morap.bus.write-wraps", Level::kMay,
        "Byte 256 of one write is an identifier again, for bytes are counted in eight bits.",
        "arithmetic", Profiles::kFirmware},
    from(kFresh, Hazard::kState, "256 bytes that mean nothing, and a choice.",
         [](NodeBench& node) {
           node.needs_emulation();
           std::vector<std::byte> bytes(256, std::byte{0x06});
           bytes.push_back(static_cast<std::byte>(kReadMotorStatus));
           node.send_bytes(bytes);
           node.expect_read_on("03");
         }),
};

}  // namespace

Chapter bus_chapter() { return chapter("Bus", kBusClauses); }

}  // namespace armjig::morap::conformance
