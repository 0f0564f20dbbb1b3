// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/chapters.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"morap.bus.poke-harmless", Level::kMust, "A write of nothing changes nothing.",
     "firmware, vector 24"},
    {"morap.bus.reserved", Level::kMust, "A node acknowledges no reserved address, 78 to 7F.",
     "I2C; firmware: one address"},
    {"morap.bus.general-call", Level::kMust, "A node does not acknowledge the general call.",
     "firmware, slave configuration, vector B2"},
    {"morap.bus.other-node", Level::kMust,
     "What is written to the address of another node does not reach this one.",
     "document, addresses; recording bus-three-nodes"},
    {"morap.bus.seven-bits", Level::kMust, "A node compares all seven bits of an address.",
     "document, addresses; recording bus-scan"},
    {"morap.bus.acknowledges", Level::kMust, "A node acknowledges every byte of a command.",
     "firmware: its hardware does"},
    {"morap.bus.acknowledges-float", Level::kMust,
     "A node acknowledges the last byte of a command with a number.", "firmware"},
    {"morap.bus.acknowledges-tune", Level::kMust,
     "A node acknowledges the last byte of a tuning message, before it computes.",
     "firmware, vector B8"},
    {"morap.bus.acknowledges-unknown", Level::kMust,
     "A node acknowledges identifiers that it does not know, and all that follows them.",
     "recording static-unknown-ids"},
    {"morap.bus.acknowledges-surplus", Level::kMust,
     "A node acknowledges bytes behind a complete command.", "recording static-overlong-writes"},
    {"morap.bus.acknowledges-refused", Level::kMust,
     "A node acknowledges all of a parameter message that it refuses; only its status tells.",
     "firmware; recording static-program-limits"},
    {"morap.bus.repeated-start", Level::kMust,
     "A repeated start between choosing and reading does the same as a stop and a start.",
     "recording static-repeated-start"},
    {"morap.bus.without-stop", Level::kMust,
     "A command acts with its last byte; a repeated start in place of the stop takes nothing away.",
     "firmware, vector B4"},
    {"morap.bus.restart-cuts", Level::kMust,
     "A repeated start inside a command cuts it off, and another one begins.",
     "recording static-repeated-start"},
    {"morap.bus.clock-while-tuning", Level::kShould,
     "A node holds the clock for at most 5 ms, also while it computes parameters.",
     "reference: about 1 ms is estimated, and a master has to bear 5"},
    {"morap.bus.clock-before-read", Level::kShould,
     "A node holds the clock for at most 5 ms before the first byte of an answer.",
     "reference: about 0.1 ms is estimated, and a master has to bear 5"},
    {"morap.bus.long-unknown", Level::kMust,
     "59 bytes that begin with an unknown identifier change nothing.", "firmware, vector B9"},
    {"morap.bus.write-wraps", Level::kMay,
     "Byte 256 of one write is an identifier again, for bytes are counted in eight bits.",
     "arithmetic", Profiles::kFirmware},
};

}  // namespace

std::span<const Requirement> bus_requirements() noexcept { return kRequirements; }

}  // namespace armjig::morap::conformance
