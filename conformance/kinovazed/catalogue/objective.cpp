// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"kinovazed.objective.current", Level::kMust,
     "Current is done at once, for it moves to where the arm is.",
     "document; server, recording objectives-current"},
    {"kinovazed.objective.home", Level::kMust, "Home runs and is done.",
     "document; server, recording objectives-absolute"},
    {"kinovazed.objective.handle", Level::kMust, "Handle runs and is done.",
     "document; server, recording objectives-absolute"},
    {"kinovazed.objective.suck-door", Level::kMust, "SuckDoor runs and is done.",
     "document; server, recording objectives-absolute"},
    {"kinovazed.objective.antenna", Level::kMust, "Antenna runs and is done.",
     "document; server; reference 9.3"},
    {"kinovazed.objective.open-door", Level::kMust, "OpenDoor can be run at the end of Handle.",
     "document; server; reference 9.6"},
    {"kinovazed.objective.pull-door", Level::kMust, "PullDoor can be run at the end of Handle.",
     "document; server; reference 9.6"},
    {"kinovazed.objective.find-bottle", Level::kMust, "FindBottle runs and is done.",
     "server; reference 9.3", Profiles::kFirmware, "kinovazed.objective.seven"},
    {"kinovazed.objective.place-bottle", Level::kMust, "PlaceBottle runs and is done.",
     "server; reference 9.3", Profiles::kFirmware, "kinovazed.objective.seven"},
    {"kinovazed.objective.seven", Level::kMust,
     "FindBottle and PlaceBottle, which came later, are Rejected.", "document: seven objectives",
     Profiles::kDocumented, "kinovazed.objective.find-bottle"},
    {"kinovazed.objective.takes-its-time", Level::kMust,
     "ObjectiveDone does not come before the arm can be near its target.", "server; reference 9.2"},
    {"kinovazed.objective.reached", Level::kMust,
     "An objective whose target is reached already is done at once.", "server; reference 9.2"},
    {"kinovazed.objective.all-points", Level::kMust,
     "Every way-point of an objective is visited, in order.", "server; reference 9.2"},
    {"kinovazed.objective.all-points-of-bottles", Level::kMust,
     "Both way-points of FindBottle and of PlaceBottle are visited.", "server; reference 9.3",
     Profiles::kFirmware},
    {"kinovazed.objective.one-word", Level::kMust,
     "Nothing is sent between the way-points of an objective.", "server, transcript T41"},
    {"kinovazed.objective.ends-idle", Level::kMust,
     "An objective that began in steering ends in idle.", "server, transcript T42"},
    {"kinovazed.objective.hijack", Level::kMust,
     "SetActiveObjective replaces the objective that runs.", "server, transcript S14",
     Profiles::kFirmware, "kinovazed.objective.no-hijack"},
    {"kinovazed.objective.no-hijack", Level::kMust,
     "SetActiveObjective leaves the objective that runs alone.", "document: how-to; our reading",
     Profiles::kDocumented, "kinovazed.objective.hijack"},
    {"kinovazed.objective.near", Level::kMust,
     "A way-point is reached within 0.05 m and 0.25 rad in each component; then the arm is "
     "stopped, and the next one sent.",
     "server; reference 9.2", Profiles::kBoth, "", Role::kDevice,
     "no message tells where the arm is"},
    {"kinovazed.objective.still-arm", Level::kMust,
     "Only a reading that differs from the one before by 0.00001 somewhere can reach a "
     "way-point.",
     "server, transcript S10", Profiles::kFirmware, "", Role::kDevice,
     "an arm that stands without any noise cannot be had on the wire"},
    {"kinovazed.objective.no-wrap", Level::kMust, "Angles are compared as plain numbers.",
     "server; reference 9.2", Profiles::kBoth, "", Role::kDevice,
     "no published objective ends at the seam"},
    {"kinovazed.objective.no-timeout", Level::kMust,
     "A target that is never reached ends by EStop, SetJoystickMode or another objective "
     "only.",
     "server; reference 9.2", Profiles::kBoth, "", Role::kDevice,
     "there is no limit of time after which one would know"},
};

}  // namespace

std::span<const Requirement> objective_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
