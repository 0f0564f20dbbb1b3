// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/chapters.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"morap.motion.sense", Level::kMust, "A positive voltage makes the angle larger.",
     "reference, encoder; recording loop-voltage"},
    {"morap.motion.sense-negative", Level::kMust, "A negative voltage makes the angle smaller.",
     "reference, encoder; recording loop-voltage"},
    {"morap.motion.position", Level::kMust,
     "With the stored controller a free shaft comes to its position reference.",
     "document, position; recording loop-position-default"},
    {"morap.motion.speed", Level::kMust,
     "With the stored controller a free shaft comes to its speed reference.",
     "document, speed; recording loop-speed-default"},
    {"morap.motion.holds", Level::kMust, "At its position reference a shaft stays.",
     "document, position; recording loop-position-default"},
    {"morap.motion.disabled", Level::kMust, "A disabled shaft is driven no further.",
     "document; recording loop-disable-coast"},
    {"morap.motion.latched", Level::kMust,
     "A reference to an uncalibrated node does not move the shaft.",
     "document, motor status; recording loop-uncalibrated"},
    {"morap.motion.current", Level::kMust,
     "While it starts a current is read, which is never negative.",
     "document, current; recording loop-voltage"},
    {"morap.brake.no-effect", Level::kMust, "Identifier 15 does not brake a disabled shaft.",
     "recording loop-disable-coast", Profiles::kFirmware},
    {"morap.brake.release", Level::kMust, "Behind identifier 14 a disabled shaft turns freely.",
     "document, brake; recording loop-disable-coast"},
};

}  // namespace

std::span<const Requirement> motion_requirements() noexcept { return kRequirements; }

}  // namespace armjig::morap::conformance
