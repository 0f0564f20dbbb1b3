// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6 {
namespace {

constexpr std::array kRequirements{
    Requirement{"parol6.frame.one-answer", Level::kMust,
                "Every good frame is answered with exactly one telemetry frame.",
                "firmware: one answer for each accepted frame"},
    Requirement{"parol6.frame.no-chatter", Level::kMust,
                "The board sends nothing that was not asked for.",
                "firmware: it only ever answers"},
    Requirement{"parol6.frame.split-anywhere", Level::kMust,
                "A frame may arrive in pieces, cut at any byte.",
                "arithmetic: a byte stream has no borders; the GUI writes a frame in 26 pieces"},
    Requirement{"parol6.frame.burst", Level::kMust,
                "Frames that arrive together are all answered, in order.",
                "firmware: all waiting bytes are read in one pass"},
    Requirement{"parol6.frame.noise", Level::kMust,
                "Bytes without a start pattern in front of a frame do no harm.",
                "firmware: the receiver looks for FF FF FF"},
    Requirement{"parol6.frame.wrong-end", Level::kMust,
                "A frame that does not end with 01 02 is not answered, and the next good one is.",
                "document, end bytes; firmware"},
    Requirement{"parol6.frame.recovers", Level::kMust,
                "After any garbage but a length of 0 the board answers again within six good "
                "frames.",
                "arithmetic: a length claims at most 255 bytes"},
    Requirement{"parol6.frame.check-ignored", Level::kMust,
                "The check byte of a frame is not looked at.", "firmware", Profiles::kFirmware},
};

}  // namespace

std::span<const Requirement> frame_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6
