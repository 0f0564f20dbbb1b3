// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"parol6.jog.own-joint", Level::kMust,
     "In a jog the speed field of a joint drives that joint and no other.",
     "document, packet table; firmware"},
    {"parol6.jog.all-together", Level::kMust,
     "In a jog all joints run at once, each at its own speed.", "firmware"},
    {"parol6.jog.forward", Level::kMust, "A positive jog speed counts the position up.",
     "firmware"},
    {"parol6.jog.backward", Level::kMust, "A negative jog speed counts the position down.",
     "firmware"},
    {"parol6.jog.speed", Level::kMust,
     "A joint jogs at the commanded steps/s, its interval cut to whole microseconds and rounded "
     "up to whole passes of the loop.",
     "firmware; arithmetic"},
    {"parol6.jog.slow", Level::kMust, "Speeds down to a few steps/s are kept too.",
     "firmware: intervals have 32 bits"},
    {"parol6.jog.fast", Level::kMust,
     "A joint jogs as fast as the GUI's tables have it, to within the length of a pass.",
     "firmware; GUI, table of jog speeds"},
    {"parol6.jog.no-ramp", Level::kMust,
     "A jog has its full speed from the first step on, without a ramp.", "firmware"},
    {"parol6.jog.first-step", Level::kMust,
     "The first step of a jog comes at once if the last one is longer ago than its interval.",
     "firmware: intervals count from the last step"},
    {"parol6.jog.zero", Level::kMust, "A joint whose jog speed is 0 stands still.", "firmware"},
    {"parol6.jog.reported", Level::kMust, "In a jog telemetry reports the commanded speeds.",
     "firmware"},
    {"parol6.jog.change", Level::kMust, "Another speed during a jog takes effect with its frame.",
     "firmware"},
    {"parol6.jog.reverse", Level::kMust,
     "The opposite speed during a jog turns the joint round at once.", "firmware"},
    {"parol6.jog.ignores-positions", Level::kMust, "The position fields of a jog change nothing.",
     "firmware: only go-to uses them"},
    {"parol6.jog.keeps-homed", Level::kMust, "A jog leaves the homed bits as they are.",
     "firmware"},
    {"parol6.jog.clamp", Level::kMust,
     "A speed beyond 50,000 steps/s is reduced to it, with its sign.", "firmware, vector B14",
     Profiles::kFirmware, "parol6.jog.clamp-of-table"},
    {"parol6.jog.clamp-of-table", Level::kMust,
     "A speed beyond the joint's maximum in the GUI's table is reduced to it.",
     "document: maxima of the GUI", Profiles::kDocumented, "parol6.jog.clamp"},
    {"parol6.jog.unlimited", Level::kMust,
     "A jog drives a homed joint beyond its range without stopping.",
     "firmware: it knows no joint limits"},
    {"parol6.step.no-catch-up", Level::kMust,
     "Steps that were not made while a joint was not run are not made up for.",
     "firmware: an interval counts from the moment of the last step"},
    {"parol6.step.same-speed-keeps-direction", Level::kMust,
     "Setting the speed that is set already changes nothing, not even a direction that does not "
     "fit its sign.",
     "firmware", Profiles::kFirmware},
    {"parol6.step.single-precision", Level::kMust,
     "Ramp state is single precision, formulas double, conversions cut off toward zero, nothing is "
     "fused.",
     "firmware", Profiles::kFirmware, "", Role::kDevice,
     "the differences are single microseconds in an interval; recordings judge them"},
};

}  // namespace

std::span<const Requirement> jog_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6::conformance
