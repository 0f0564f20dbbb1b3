// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/chapters.hpp"

namespace armjig::parol6::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"parol6.home.once", Level::kMust,
     "One home command, followed by idle frames, homes the whole arm.",
     "document, home; firmware: 255 goes on with homing"},
    {"parol6.home.order", Level::kMust,
     "J1 to J3 home together, then J4, then J6 parks, then J5 homes while J6 returns.", "firmware"},
    {"parol6.home.bits", Level::kMust,
     "While the arm homes its homed bits go 03, E3, F3, FF and nothing else.",
     "firmware; recordings"},
    {"parol6.home.bits-taken-back", Level::kMust,
     "The first pass of a run of homing takes all homed bits back.", "firmware"},
    {"parol6.home.seek-speeds", Level::kMust,
     "The first pass of a run sets the seek speeds of all six joints, also of those whose turn "
     "comes later: -2050, -2550, -2550, 5550, -5050, -9550.",
     "firmware; recordings"},
    {"parol6.home.seek-motion", Level::kMust,
     "J1, J2 and J3 seek their switches downward at 2050, 2550 and 2550 steps/s.", "firmware"},
    {"parol6.home.waits-for-turn", Level::kMust,
     "J4, J5 and J6 stand still until their turn in homing has come.", "firmware"},
    {"parol6.home.zero-at-switch", Level::kMust,
     "A joint that reaches its switch counts 0 there and stands with speed 0 until the others of "
     "its block are there.",
     "firmware"},
    {"parol6.home.back-off", Level::kMust,
     "J1, J2 and J3 back off from their switches to 850, 1050 and 1050.", "firmware"},
    {"parol6.home.back-off-speeds", Level::kMust,
     "J2 and J3 back off at 2050; J1 backs off forward too although its speed is reported as "
     "-2050.",
     "firmware: only the magnitude matters there"},
    {"parol6.home.slow-speeds", Level::kMust,
     "J1, J2 and J3 seek their switches a second time at -750.", "firmware"},
    {"parol6.home.final-j1-j3", Level::kMust,
     "J1, J2 and J3 end at 13500, 19588 and 23020 from their switches and wait there.", "firmware"},
    {"parol6.home.ramp-j1-j3", Level::kMust,
     "The final moves of J1, J2 and J3 accelerate with 4500, 3000 and 5000 steps/s^2.",
     "firmware, vectors S1 to S3"},
    {"parol6.home.speeds-j4", Level::kMust,
     "J4 seeks at 5550, backs off with -4050, seeks again at 4050.", "firmware"},
    {"parol6.home.back-off-j4", Level::kMust, "J4 backs off to -1550.", "firmware"},
    {"parol6.home.final-j4", Level::kMust,
     "J4 ends at -10200 from its switch and waits there; its homed bit comes with that.",
     "firmware"},
    {"parol6.home.ramp-j4", Level::kMust, "The final move of J4 accelerates with 5500 steps/s^2.",
     "firmware, vector S4"},
    {"parol6.home.speeds-j6", Level::kMust,
     "J6 seeks at -9550, backs off with 4050, seeks again at -8050.", "firmware"},
    {"parol6.home.back-off-j6", Level::kMust, "J6 backs off to 1550.", "firmware"},
    {"parol6.home.parks-j6", Level::kMust,
     "J6 parks at 15900 from its switch, without its homed bit, while J5 seeks.", "firmware"},
    {"parol6.home.ramp-j6", Level::kMust, "J6 accelerates with 10500 steps/s^2 on its way to park.",
     "firmware, vector S5"},
    {"parol6.home.speeds-j5", Level::kMust,
     "J5 seeks at -5050, backs off with 4050, seeks again at -4050.", "firmware"},
    {"parol6.home.back-off-j5", Level::kMust, "J5 backs off to 1550.", "firmware"},
    {"parol6.home.ramp-j5", Level::kMust,
     "The final moves of J5 and of J6 on its return accelerate with 5500 steps/s^2.",
     "firmware, vectors S6 and S7"},
    {"parol6.home.returns-j6", Level::kMust,
     "J6 returns from its parking position while J5 makes its final move.", "firmware"},
    {"parol6.home.last-bits", Level::kMust,
     "The homed bits of J5 and J6 come together, when both have arrived.", "firmware"},
    {"parol6.home.counters", Level::kMust,
     "At the end of homing the counters are set to 10240, -32000, 57905, 0, 0, 32000.", "firmware"},
    {"parol6.home.rests", Level::kMust, "After homing all speeds are 0 and no joint moves.",
     "firmware"},
    {"parol6.home.final-j5-j6", Level::kMust,
     "J5 ends at 8900 from its switch and waits there for J6, which ends at 0.", "firmware"},
};

}  // namespace

std::span<const Requirement> home_run_requirements() noexcept { return kRequirements; }

}  // namespace armjig::parol6::conformance
