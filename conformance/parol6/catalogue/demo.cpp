// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"parol6.demo", Level::kMust,
     "Code 69 drives all joints out to 6179, -22222, 49812, 0, 4059, 46075 and back to their "
     "standby positions.",
     "firmware", Profiles::kFirmware, "parol6.demo.unknown"},
    {"parol6.demo.unknown", Level::kMust, "Code 69 has no meaning and moves nothing.",
     "document: not among its codes", Profiles::kDocumented, "parol6.demo"},
    {"parol6.demo.disabled", Level::kMust, "The demonstration also runs while disabled.",
     "firmware: not guarded by the flag", Profiles::kFirmware},
    {"parol6.demo.sleeps", Level::kMust,
     "Between its two legs the board sleeps for 2 s, and answers afterwards what came meanwhile.",
     "firmware", Profiles::kFirmware},
    {"parol6.demo.ramp", Level::kMust,
     "The demonstration drives J1 with at most 6000 steps/s and 6000 steps/s^2.",
     "firmware, vector S8", Profiles::kFirmware},
    {"parol6.demo.once", Level::kMust,
     "A demonstration that has ended does not begin again until an idle frame has reset it.",
     "firmware", Profiles::kFirmware},
    {"parol6.demo.interrupted", Level::kMust,
     "Another code than idle pauses the demonstration, and 69 goes on with it.", "firmware",
     Profiles::kFirmware},
    {"parol6.demo.lowers-maximum", Level::kMust,
     "The maximum speeds of the demonstration, 6000, 4000, 3500, 3500, 3500, 7500, stay in force "
     "until power-off.",
     "firmware", Profiles::kFirmware},
    {"parol6.demo.pauses-homing", Level::kMust, "Code 69 pauses homing and runs the demonstration.",
     "firmware", Profiles::kFirmware},
    {"parol6.demo.disabled-interrupted", Level::kMust,
     "A demonstration of a disabled board stands still while another code comes.", "firmware",
     Profiles::kFirmware},
};

}  // namespace

std::span<const Requirement> demo_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6::conformance
