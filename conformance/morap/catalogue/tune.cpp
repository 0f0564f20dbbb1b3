// SPDX-License-Identifier: Apache-2.0
#include "conformance/morap/chapters.hpp"

namespace armjig::morap::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"morap.tune.success", Level::kMust,
     "A tuning message with sound figures makes the programming status 2.",
     "document, tuning; vector 42"},
    {"morap.tune.at-the-byte", Level::kMust,
     "The result is there with the tenth byte, before the stop.", "firmware, tuner"},
    {"morap.tune.pd", Level::kMust,
     "Kind 0 gives the PD position controller of those poles, byte for byte.",
     "vectors 42 and 45; recording static-tune-pd", Profiles::kFirmware},
    {"morap.tune.pid", Level::kMust,
     "Kind 1 gives the PID position controller of those poles, byte for byte.",
     "vectors 44 and 46; recording static-tune-pid", Profiles::kFirmware},
    {"morap.tune.pi", Level::kMust,
     "Kind 2 gives the PI speed controller of those poles, byte for byte.",
     "vectors 43 and 47; recording static-tune-pi-speed", Profiles::kFirmware},
    {"morap.tune.position-rate", Level::kMust,
     "A tuned position controller runs at 625 Hz with a light load and at 400 Hz with a heavy one.",
     "reference, tuner", Profiles::kFirmware},
    {"morap.tune.speed-rate", Level::kMust,
     "A tuned speed controller runs at 625, 400 or 320 Hz, the slower the heavier its load.",
     "reference, tuner", Profiles::kFirmware},
    {"morap.tune.pole-of-motor", Level::kMust,
     "A pole faster than the motor's own is replaced by that.", "vector 51; reference, tuner",
     Profiles::kFirmware},
    {"morap.tune.at-tick", Level::kMust,
     "Tuned parameters are in use from the next tick on and not before.", "firmware, tuner",
     Profiles::kFirmware},
    {"morap.tune.positive-pole", Level::kMust, "A positive pole makes the status 3.",
     "document: poles are negative; vector 48"},
    {"morap.tune.fast-pole", Level::kMust, "A pole below -200 makes the status 3.", "vector 52"},
    {"morap.tune.fastest-pole", Level::kMust, "A pole of -200 is taken.", "vector 51"},
    {"morap.tune.heavy", Level::kMust, "An inertia above 10 makes the status 3.", "vector 49"},
    {"morap.tune.heaviest", Level::kMust, "An inertia of 10 is taken.",
     "recording static-tune-edges"},
    {"morap.tune.negative-inertia", Level::kMust, "A negative inertia makes the status 3.",
     "recording static-tune-fail"},
    {"morap.tune.unknown-kind", Level::kMust, "A kind above 2 makes the status 3.", "vector 50"},
    {"morap.tune.failure-unused", Level::kMust,
     "A refused tuning message leaves both controllers as they are.", "recording static-tune-fail",
     Profiles::kFirmware},
    {"morap.tune.short", Level::kMust, "A tuning message of nine bytes does nothing.", "vector 53"},
    {"morap.tune.surplus", Level::kMust, "An eleventh byte does no harm.", "vector 54"},
    {"morap.tune.pieces", Level::kMust, "A tuning message cannot be sent in two writes.",
     "recording static-tune-partial"},
    {"morap.tune.zero-pole", Level::kMust, "A pole of 0 is taken.", "recording static-tune-edges",
     Profiles::kFirmware},
    {"morap.tune.no-inertia", Level::kMay, "An inertia of 0 is taken, though no number comes out.",
     "reference, tuner", Profiles::kFirmware},
};

}  // namespace

std::span<const Requirement> tune_requirements() noexcept { return kRequirements; }

}  // namespace armjig::morap::conformance
