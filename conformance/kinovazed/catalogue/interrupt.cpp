// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"kinovazed.event.table", Level::kMust,
     "The arm's own ends act where they are awaited: folding ends in retracted, unfolding "
     "and initializing in idle.",
     "server; reference 6.4"},
    {"kinovazed.interrupt.retract", Level::kMust,
     "Retract ends a change of mode, whose JoystickModeSet never comes.", "server; reference 6.5"},
    {"kinovazed.interrupt.mode", Level::kMust,
     "SetJoystickMode ends a running objective, whose ObjectiveDone never comes.",
     "document; server, recording interrupt-objective-by-mode"},
    {"kinovazed.interrupt.objective", Level::kMust,
     "RunObjective replaces the objective that runs, and only the second one is done.",
     "server, recording interrupt-objective-by-objective"},
    {"kinovazed.interrupt.estop-initializing", Level::kMust,
     "EStop ends initializing, and Initialized never comes.", "document; server, transcript T12"},
    {"kinovazed.interrupt.estop-retracting", Level::kMust,
     "EStop ends retracting, and Retracted never comes.", "document; server, transcript T53"},
    {"kinovazed.interrupt.estop-unfolding", Level::kMust,
     "EStop ends unfolding, and Unfolded never comes.", "document; server; reference 6.5"},
    {"kinovazed.interrupt.estop-setting-mode", Level::kMust,
     "EStop ends a change of mode, and JoystickModeSet never comes.",
     "document; server, recording interrupt-setting-mode-by-estop"},
    {"kinovazed.interrupt.estop-objective", Level::kMust,
     "EStop ends an objective, and ObjectiveDone never comes.",
     "document; server, recording interrupt-objective-by-estop"},
    {"kinovazed.interrupt.late-mode", Level::kMust,
     "The end of a change of mode that EStop ended is not told after the next Initialize "
     "either.",
     "server; reference 8.3"},
    {"kinovazed.interrupt.half-way", Level::kMust,
     "Behind EStop on the way to the folded pose Initialize leads to ready.",
     "server, recording session-estop-mid-retract"},
    {"kinovazed.retract.from-anywhere", Level::kMust,
     "Retract with the arm elsewhere goes by way of the ready pose, and Retracted comes "
     "once.",
     "server, transcript S16"},
    {"kinovazed.retract.while-initializing", Level::kMust,
     "If the arm ends folded while it initializes, Retracted is sent and the server stays "
     "initializing.",
     "server, transcript S15", Profiles::kFirmware, "kinovazed.retract.goes-on"},
    {"kinovazed.retract.goes-on", Level::kMust,
     "An arm that ends folded while it initializes goes on to its ready pose.",
     "document: Retracted is the answer to Retract; our choice", Profiles::kDocumented,
     "kinovazed.retract.while-initializing"},
    {"kinovazed.initialize.again", Level::kMust,
     "Initialize in idle moves an arm that is elsewhere to its ready pose, and the server "
     "is initialized on the way.",
     "server; reference 6.6", Profiles::kFirmware, "kinovazed.initialize.recurring"},
    {"kinovazed.initialize.recurring", Level::kMust,
     "Initialize in idle is confirmed at once, wherever the arm is.",
     "document, recurring commands; our reading", Profiles::kDocumented,
     "kinovazed.initialize.again"},
};

}  // namespace

std::span<const Requirement> interrupt_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
