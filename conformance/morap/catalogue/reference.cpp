// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/chapters.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"morap.reference.position", Level::kMust,
     "The position reference is read back as it was written, bit for bit.",
     "document; recording static-reference-readback"},
    {"morap.reference.speed", Level::kMust,
     "The speed reference is read back as it was written, bit for bit.", "vector 17"},
    {"morap.reference.any-bits", Level::kMust,
     "References of any bits are kept, those that are no numbers among them.", "vector 16",
     Profiles::kFirmware},
    {"morap.reference.apart", Level::kMust,
     "A speed reference leaves the position reference alone, and the other way round.",
     "vector 17"},
    {"morap.reference.voltage-apart", Level::kMust, "A drive voltage leaves both references alone.",
     "firmware, commands"},
    {"morap.reference.last", Level::kMust, "Of several references the last one counts.",
     "firmware, commands"},
    {"morap.reference.over-disable", Level::kMust, "Disabling keeps the references.", "vector 18"},
    {"morap.reference.over-forgetting", Level::kMust, "Forgetting the calibration keeps them.",
     "firmware, commands"},
    {"morap.reference.over-calibration", Level::kMust, "Calibrating keeps them as well.",
     "firmware, commands"},
    {"morap.write.short-float", Level::kMust,
     "A reference with fewer than four bytes leaves the one before in place.", "vector 15"},
    {"morap.write.short-mode", Level::kMust,
     "A reference with fewer than four bytes enables nothing.",
     "firmware: an older one changed the mode at the identifier"},
    {"morap.write.short-joined", Level::kMust,
     "What a transaction leaves open the next one does not complete.",
     "recording static-partial-writes"},
    {"morap.write.payload-no-command", Level::kMust,
     "Behind a command without payload nothing more is done in that write.",
     "firmware: one write, one command"},
    {"morap.calibrate.zero", Level::kMust, "Identifier 16 makes the present angle 0.",
     "document; recording static-calibrate-angle"},
    {"morap.calibrate.angle", Level::kMust,
     "Identifier 17 makes the present angle the given one, but for a count.", "document; vector 8"},
    {"morap.calibrate.truncates", Level::kMust,
     "The given angle is cut to whole counts, towards zero.", "vectors 8 and 10",
     Profiles::kFirmware},
    {"morap.calibrate.truncates-negative", Level::kMust,
     "A negative angle is cut towards zero as well.", "vector 9", Profiles::kFirmware},
    {"morap.calibrate.large", Level::kMust, "An angle of many turns is kept in the same scale.",
     "recording static-calibrate-angle"},
    {"morap.angle.scale", Level::kMust,
     "A count is 2 pi through four times the pulses of the encoder and the gear ratio.",
     "vector 13; recording stim-encoder-angle"},
    {"morap.angle.sign", Level::kMust, "Counts downwards make the angle smaller.", "vector 13"},
    {"morap.angle.uncalibrated", Level::kMust, "The angle is read also without calibration.",
     "vector 12"},
    {"morap.angle.disabled", Level::kMust, "Counting goes on while the node is disabled.",
     "firmware, encoder"},
    {"morap.angle.over-disable", Level::kMust, "Disabling keeps the angle as it is.",
     "firmware, identifier 0"},
    {"morap.calibrate.zero-while-enabled", Level::kMust,
     "An enabled node is calibrated to 0 as well.", "recording loop-calibrate-moving"},
    {"morap.calibrate.angle-while-enabled", Level::kMust,
     "An enabled node is calibrated to an angle as well.", "recording loop-calibrate-moving"},
    {"morap.angle.over-forgetting", Level::kMust,
     "Forgetting the calibration keeps the angle as it is.", "firmware, identifier 31"},
};

}  // namespace

std::span<const Requirement> reference_requirements() noexcept { return kRequirements; }

}  // namespace armjig::morap::conformance
