// SPDX-License-Identifier: Apache-2.0
// Requirements that mutants asked for: nothing else could tell these boards from a sound one.
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6 {
namespace {

constexpr Requirement kRequirements[] = {
    {"parol6.frame.prompt", Level::kMust,
     "At 100 Hz most answers come before the next frame is due.",
     "firmware: a frame is answered in the pass that reads it"},
    {"parol6.command.disabled-keeps-speeds", Level::kMust,
     "While disabled, codes other than idle leave the reported speeds as they are, whatever speeds "
     "come with them.",
     "firmware"},
    {"parol6.home.final-j5-j6", Level::kMust,
     "J5 ends at 8900 from its switch and waits there for J6, which ends at 0.", "firmware"},
    {"parol6.demo.pauses-homing", Level::kMust, "Code 69 pauses homing and runs the demonstration.",
     "firmware", Profiles::kFirmware},
    {"parol6.demo.disabled-interrupted", Level::kMust,
     "A demonstration of a disabled board stands still while another code comes.", "firmware",
     Profiles::kFirmware},
};

}  // namespace

std::span<const Requirement> between_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6
