// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/chapters.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"morap.read.first-mode", Level::kMust,
     "Before anything was chosen, a read answers with the angle.",
     "firmware, vector 1; the document is silent", Profiles::kFirmware},
    {"morap.read.angle-at-boot", Level::kMust, "At power-on the angle is 0.", "firmware, vector 1"},
    {"morap.read.voltage-at-boot", Level::kMust, "At power-on the applied voltage is 0.",
     "firmware, vector 6"},
    {"morap.read.position-at-boot", Level::kMust, "At power-on the position reference is 0.",
     "firmware, vector 6"},
    {"morap.read.speed-at-boot", Level::kMust, "At power-on the speed reference is 0.",
     "firmware, vector 6"},
    {"morap.read.address", Level::kMust, "Identifier 136 chooses the node's own seven-bit address.",
     "document; vectors 4 and 5"},
    {"morap.read.keeps-mode", Level::kMust,
     "What was chosen stays chosen over any number of reads.", "recording static-readmode-latch"},
    {"morap.read.mode-over-commands", Level::kMust, "Commands do not change what is chosen.",
     "recording static-readmode-latch"},
    {"morap.read.mode-over-brake", Level::kMust, "The brake commands do not change what is chosen.",
     "firmware"},
    {"morap.read.mode-over-unknown", Level::kMust,
     "Unknown identifiers do not change what is chosen.", "firmware, vector 23"},
    {"morap.read.surplus", Level::kMust, "A byte behind a choice is no choice itself.",
     "firmware, vector 21"},
    {"morap.read.short", Level::kMust,
     "Reading fewer bytes than there are does no harm: the next read begins anew.",
     "firmware, reading"},
    {"morap.read.little-endian", Level::kMust, "Numbers are sent least significant byte first.",
     "document; vectors 12 and 17"},
    {"morap.read.snapshot", Level::kMust,
     "The four bytes of a number are of one moment, that of the first.", "firmware, reading"},
    {"morap.read.wrap", Level::kMay,
     "Byte 256 of a read of a number begins it anew, with a new value.", "firmware, vector 68",
     Profiles::kFirmware},
    {"morap.read.byte-again", Level::kMust,
     "A reading of one byte is repeated for as long as the master reads.", "firmware, vector 20",
     Profiles::kFirmware},
    {"morap.read.set-filled", Level::kMust, "Behind a controller set zeros are read.",
     "firmware, vector 26", Profiles::kFirmware},
    {"morap.read.set-wrap", Level::kMay,
     "Byte 256 of a read of a controller set is its first again.", "recording static-read-wrap",
     Profiles::kFirmware},
    {"morap.read.set-checksum", Level::kMust,
     "A controller set is read with the checksum of its bytes.", "firmware, read-back",
     Profiles::kFirmware},
    {"morap.read.position-default", Level::kMust,
     "The position controller is the one in the EEPROM until it is programmed.",
     "vectors 26 and 28", Profiles::kFirmware},
    {"morap.read.speed-default", Level::kMust,
     "The speed controller is the one in the EEPROM until it is programmed.", "vectors 27 and 29",
     Profiles::kFirmware},
};

}  // namespace

std::span<const Requirement> reading_requirements() noexcept { return kRequirements; }

}  // namespace armjig::morap::conformance
