// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"parol6.frame.one-answer", Level::kMust,
     "Every good frame is answered with exactly one telemetry frame.",
     "firmware: one answer for each accepted frame"},
    {"parol6.frame.no-chatter", Level::kMust,
     "The board sends nothing that was not asked for, also not at power-up.",
     "firmware: it only ever answers"},
    {"parol6.frame.split-anywhere", Level::kMust,
     "A frame may arrive in pieces, cut at any byte, with any pauses between them.",
     "arithmetic: a byte stream has no borders; the GUI writes a frame in 26 pieces"},
    {"parol6.frame.burst", Level::kMust, "Frames that arrive together are all answered, in order.",
     "firmware: all waiting bytes are read in one pass"},
    {"parol6.frame.rate", Level::kMust,
     "A frame every 10 ms is answered before the next one comes, for as long as it lasts.",
     "document: 100 Hz; firmware"},
    {"parol6.frame.rate-beyond", Level::kShould,
     "A frame every millisecond is answered as well as one every 10 ms.",
     "firmware: frames are answered in the pass that reads them"},
    {"parol6.frame.start-inside", Level::kMust,
     "Start bytes inside a payload do not begin another frame.",
     "arithmetic: nothing is escaped, so the position -1 is FF FF FF"},
    {"parol6.frame.noise", Level::kMust,
     "Bytes without a start pattern in front of a frame do no harm.",
     "firmware: the receiver looks for FF FF FF"},
    {"parol6.frame.two-starts", Level::kMust,
     "Two start bytes begin no frame: one that lost its first byte is not answered, the next is.",
     "document, start bytes; firmware, vector R10"},
    {"parol6.frame.interrupted-start", Level::kMust,
     "Start bytes count only in a row; another byte between them begins the count anew.",
     "firmware, vector R8"},
    {"parol6.frame.wrong-end", Level::kMust,
     "A frame that does not end with 01 02 is not answered, and the next good one is.",
     "document, end bytes; firmware, vector R2"},
    {"parol6.frame.recovers", Level::kMust,
     "After any garbage but a length of 0 the board answers again within six good frames.",
     "arithmetic: a length claims at most 255 bytes"},
    {"parol6.frame.long-noise", Level::kMust,
     "Kilobytes of noise without start bytes leave the receiver ready for the next frame.",
     "firmware: such bytes are dropped one by one"},
    {"parol6.frame.random-noise", Level::kMust,
     "After random bytes, start bytes among them, the board answers within six good frames.",
     "arithmetic: a length claims at most 255 bytes"},
    {"parol6.frame.check-ignored", Level::kMust, "The check byte of a frame is not looked at.",
     "firmware, vector R1", Profiles::kFirmware, "parol6.frame.check-demanded"},
    {"parol6.frame.check-demanded", Level::kMust,
     "A frame whose check byte is not 212 is dropped, and the next good one is answered.",
     "document, check byte", Profiles::kDocumented, "parol6.frame.check-ignored"},
    {"parol6.frame.prompt", Level::kMust,
     "At 100 Hz most answers come before the next frame is due.",
     "firmware: a frame is answered in the pass that reads it"},
};

}  // namespace

std::span<const Requirement> frame_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6::conformance
