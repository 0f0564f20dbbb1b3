// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr auto kChoice = "document is silent; our choice";

constexpr Requirement kRequirements[] = {
    {"kinovazed.line.padded", Level::kMust,
     "A line that is longer than one read of 128 bytes is served as a whole.",
     "server, recording framing-long-padded-1023", Profiles::kFirmware},
    {"kinovazed.line.long-unknown", Level::kMust,
     "A long line that is no command is passed over, and the next command served.",
     "server, recording framing-long-junk-200", Profiles::kFirmware},
    {"kinovazed.line.longest", Level::kMust, "Lines of up to 1152 bytes with their LF are served.",
     "server, transcript T76", Profiles::kFirmware},
    {"kinovazed.line.longest-documented", Level::kShould,
     "A line of 1024 bytes leaves the connection open, and a longer one closes it.", kChoice,
     Profiles::kDocumented, "kinovazed.line.longest"},
    {"kinovazed.line.endless", Level::kMust, "The 1152nd byte without an LF closes the connection.",
     "server, transcript T77"},
    {"kinovazed.line.too-long", Level::kMust,
     "A line of more than 1152 bytes closes the connection, also if its LF comes with it.",
     "server, recording framing-long-padded-1152"},
    {"kinovazed.line.behind-endless", Level::kMust,
     "Behind a line that was too long the next client is served from its first line on.",
     "server, recording framing-endless-line"},
    {"kinovazed.line.lf-alone", Level::kMust,
     "An LF in a segment of its own is passed over, and the command behind it served.",
     "server, recording framing-empty-lf-alone"},
    {"kinovazed.line.lf-first", Level::kMust,
     "An LF that comes first in a read takes the byte behind it along, if that was read with it.",
     "server, transcripts T71, T72 and T74", Profiles::kFirmware, "kinovazed.line.lf-harmless"},
    {"kinovazed.line.lf-harmless", Level::kShould, "An LF in front of a command costs nothing.",
     kChoice, Profiles::kDocumented, "kinovazed.line.lf-first"},
    {"kinovazed.line.lf-boundary", Level::kMust,
     "The LF behind a line of 128 bytes takes the byte behind it along, if that was read with it.",
     "server; reference 2.12", Profiles::kFirmware, "kinovazed.line.lf-boundary-harmless"},
    {"kinovazed.line.lf-boundary-harmless", Level::kShould,
     "A line of 128 bytes costs the next command nothing.", kChoice, Profiles::kDocumented,
     "kinovazed.line.lf-boundary"},
    {"kinovazed.line.beside-boundary", Level::kMust,
     "A line of 127 or 129 bytes costs the next command nothing.", "server; reference 2.12"},
    {"kinovazed.line.boundary-alone", Level::kMust,
     "A line of 128 bytes costs a command that comes later nothing.",
     "server, recording framing-boundary-alone"},
    {"kinovazed.line.carry-over", Level::kMust,
     "Whole pieces of 128 bytes that a client left without an LF spoil the next client's first "
     "line, and only that.",
     "server, transcript S1", Profiles::kFirmware, "kinovazed.line.no-carry-over"},
    {"kinovazed.line.no-carry-over", Level::kShould,
     "128 bytes that a client left without an LF do not spoil the next client's first line.",
     kChoice, Profiles::kDocumented, "kinovazed.line.carry-over"},
    {"kinovazed.line.carry-over-short", Level::kMust,
     "127 bytes that a client left without an LF leave no trace.", "server, transcript S1"},
    {"kinovazed.line.carry-over-counts", Level::kMust,
     "What was carried over counts for the length of the next client's first line.",
     "server; reference 2.15", Profiles::kFirmware},
};

}  // namespace

std::span<const Requirement> long_line_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
