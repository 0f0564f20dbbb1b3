// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"parol6.home.idle-speeds-ignored", Level::kMust,
     "Speeds in idle frames do not disturb homing.", "firmware: 255 leaves them alone"},
    {"parol6.home.goes-on-when-repeated", Level::kMust,
     "A home command that comes again while the arm homes goes on with it.", "firmware"},
    {"parol6.home.paused", Level::kMust,
     "A code without a meaning pauses homing, and the next idle frame resumes it.",
     "firmware, vector B9"},
    {"parol6.home.ended-by-enable", Level::kMust,
     "Enable ends homing: idle frames do not resume it.", "firmware"},
    {"parol6.home.ended-by-disable", Level::kMust,
     "Disable ends homing: idle frames do not resume it, also not after enable.", "firmware"},
    {"parol6.home.ended-by-clear", Level::kMust,
     "Clear error ends homing: idle frames do not resume it.", "firmware"},
    {"parol6.home.ended-by-jog", Level::kMust, "A jog ends homing: idle frames do not resume it.",
     "firmware"},
    {"parol6.home.ended-by-go-to", Level::kMust,
     "A go-to ends homing: idle frames do not resume it.", "firmware"},
    {"parol6.home.bits-stay-away", Level::kMust,
     "Homed bits that a run took back do not return when the run is ended.", "firmware"},
    {"parol6.home.bits-stay", Level::kMust,
     "Enable, disable and clear error leave the homed bits as they are.", "firmware"},
    {"parol6.home.begins-anew", Level::kMust,
     "After enable a home command begins with the seek speeds again.", "firmware"},
    {"parol6.home.begins-anew-after-clear", Level::kMust,
     "After clear error a home command begins with the seek speeds again.", "firmware"},
    {"parol6.home.interrupted", Level::kMust,
     "A jog or go-to keeps the stage of homing: the next home command goes on in it, at the speed "
     "that the jog left.",
     "firmware", Profiles::kFirmware, "parol6.home.afresh"},
    {"parol6.home.afresh", Level::kShould,
     "After any interruption the next home command begins with the seek speeds again.",
     "document is silent; our choice", Profiles::kDocumented, "parol6.home.interrupted"},
    {"parol6.home.seen-stays", Level::kMust,
     "After enable a joint that had seen its switch skips its seek in the next run.", "firmware",
     Profiles::kFirmware, "parol6.home.seen-forgotten"},
    {"parol6.home.seen-forgotten", Level::kShould,
     "After enable every joint seeks its switch in the next run.", "document is silent; our choice",
     Profiles::kDocumented, "parol6.home.seen-stays"},
    {"parol6.home.pressed-at-start", Level::kMust,
     "A switch that is pressed already when homing begins counts at once.", "firmware"},
    {"parol6.home.no-timeout", Level::kMust, "A switch that never closes is sought for ever.",
     "firmware: nothing times out"},
    {"parol6.home.again", Level::kMust, "A homed arm can be homed again.", "firmware"},
    {"parol6.home.held", Level::kMust, "A home command held until homing ends starts the next run.",
     "firmware, vector B11", Profiles::kFirmware, "parol6.home.held-once"},
    {"parol6.home.held-once", Level::kShould,
     "A home command held until homing ends has no further effect.",
     "document is silent; our choice", Profiles::kDocumented, "parol6.home.held"},
    {"parol6.home.conditions", Level::kMust,
     "The stages are conditions tried in a fixed order in every pass, and each that holds acts.",
     "firmware", Profiles::kFirmware, "", Role::kDevice,
     "in a clean run the conditions exclude each other, and what an interrupted one shows depends "
     "on the arm; recordings judge it"},
    {"parol6.home.idle-after", Level::kMust,
     "The first idle pass after homing only drops the request; idle speeds count from the next "
     "pass on.",
     "firmware", Profiles::kFirmware, "", Role::kDevice,
     "one pass is shorter than anything a host can time"},
};

}  // namespace

std::span<const Requirement> home_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6::conformance
