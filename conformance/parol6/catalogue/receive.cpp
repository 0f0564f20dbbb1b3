// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"parol6.receive.any-length", Level::kMust,
     "Any byte after three start bytes is believed to be the length, FF included, and a frame of "
     "any length from 2 on is accepted if it ends with 01 02.",
     "firmware, vectors R4 to R7", Profiles::kFirmware, "parol6.receive.one-length"},
    {"parol6.receive.one-length", Level::kMust,
     "A frame with another length than 52 is not answered.", "document, length byte",
     Profiles::kDocumented, "parol6.receive.any-length"},
    {"parol6.receive.shortest", Level::kMust,
     "The six bytes FF FF FF 02 01 02 are a complete poll, answered with the echo of the command "
     "before.",
     "firmware, vector R4", Profiles::kFirmware},
    {"parol6.receive.store-stays", Level::kMust,
     "What a short frame does not bring is what earlier frames left in the store.", "firmware",
     Profiles::kFirmware},
    {"parol6.receive.dropped-stays", Level::kMust,
     "Also a frame that is dropped for its end bytes leaves its payload in the store.", "firmware",
     Profiles::kFirmware},
    {"parol6.receive.end-in-field", Level::kMust,
     "The end bytes of a short frame stand in the store too, as part of whatever field is there.",
     "firmware, vector R5", Profiles::kFirmware},
    {"parol6.receive.long-tail", Level::kMust,
     "Of a frame longer than 52 the first 50 payload bytes count and the rest is passed over.",
     "firmware, vector R7", Profiles::kFirmware},
    {"parol6.receive.length-zero", Level::kMust,
     "After a length of 0 the store is filled to its end, the 256th byte becomes the new length, "
     "and reception goes on at the beginning of the store.",
     "firmware as built by the vendor; undefined behaviour", Profiles::kFirmware,
     "parol6.receive.length-zero-harmless"},
    {"parol6.receive.length-zero-harmless", Level::kShould,
     "A length of 0 is no frame, and the good frame directly behind it is answered.",
     "document is silent; our choice", Profiles::kDocumented, "parol6.receive.length-zero"},
    {"parol6.receive.length-one", Level::kMust,
     "A frame of length 1 is never accepted, and the next good frame is answered.",
     "firmware as built by the vendor, vector R12; undefined behaviour", Profiles::kFirmware},
    {"parol6.receive.stray-start", Level::kMust,
     "One start byte directly in front of a good frame costs that frame and the next four.",
     "firmware: the third start byte becomes a length of 255; vector R3", Profiles::kFirmware,
     "parol6.receive.resync"},
    {"parol6.receive.resync", Level::kShould,
     "Of a run of start bytes the last three count, so that a stray one in front of a frame costs "
     "nothing.",
     "document is silent; our choice", Profiles::kDocumented, "parol6.receive.stray-start"},
    {"parol6.receive.cut-short", Level::kMust,
     "A frame cut short is completed from the next one, which is lost with it; the one after that "
     "is answered.",
     "firmware, vector R9", Profiles::kFirmware, "parol6.receive.cut-harmless"},
    {"parol6.receive.cut-harmless", Level::kShould,
     "A frame cut short does not take the next one with it.", "document is silent; our choice",
     Profiles::kDocumented, "parol6.receive.cut-short"},
};

}  // namespace

std::span<const Requirement> receive_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6::conformance
