// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"kinovazed.death.hang", Level::kMust,
     "With its supervision dead the server keeps its connections, and sends nothing any "
     "more.",
     "server, recording fault-unplug-idle", Profiles::kFirmware, "kinovazed.death.repairs"},
    {"kinovazed.death.repairs", Level::kShould,
     "An arm that was unplugged and is back leaves the server in emergencyStopped, and it "
     "answers.",
     "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.hang"},
    {"kinovazed.death.velocity", Level::kMust, "A velocity that cannot be read hangs the server.",
     "server; reference 11.2", Profiles::kFirmware, "kinovazed.death.no-velocity"},
    {"kinovazed.death.no-velocity", Level::kShould,
     "A velocity that cannot be read leaves the server answering.",
     "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.velocity"},
    {"kinovazed.death.current", Level::kMust,
     "More than 4.5 A of all joints together hang the server.", "server; reference 11.2",
     Profiles::kFirmware, "kinovazed.death.no-current"},
    {"kinovazed.death.no-current", Level::kShould,
     "More than 4.5 A of all joints together leave the server answering.",
     "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.current"},
    {"kinovazed.death.mode-write", Level::kMust,
     "A control type that cannot be written hangs the server, behind Accepted.",
     "server; reference 11.2", Profiles::kFirmware, "kinovazed.death.no-mode-write"},
    {"kinovazed.death.no-mode-write", Level::kShould,
     "A control type that cannot be written leaves the server answering.",
     "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.mode-write"},
    {"kinovazed.death.later-point", Level::kMust,
     "A way-point outside 0.8 m in x, 0.85 m in y or 1.15 m in z hangs the server, if it "
     "is not the first one.",
     "server, transcript S9", Profiles::kFirmware, "", Role::kDevice,
     "no way of published objectives leads there, and no client can place the arm"},
    {"kinovazed.death.process", Level::kMust,
     "Some errors end the process: its clients see the end of their connections.",
     "server; reference 11.3", Profiles::kFirmware, "", Role::kDevice,
     "the errors that do so have requirements of their own"},
    {"kinovazed.death.first-point", Level::kMust,
     "A first way-point outside the same limits ends the process.", "server; reference 11.3",
     Profiles::kFirmware, "", Role::kDevice,
     "it needs a file of objectives that no client can give"},
    {"kinovazed.death.objective-missing", Level::kMust,
     "An objective that the file does not have ends the process.", "server, transcript S12",
     Profiles::kFirmware, "", Role::kDevice,
     "it needs a file of objectives that no client can give"},
    {"kinovazed.death.objective-position", Level::kMust,
     "GetObjectivePosition outside the same limits, in the frame of the objective, ends "
     "the process.",
     "server; reference 5.3", Profiles::kFirmware, "kinovazed.death.no-objective-position"},
    {"kinovazed.death.no-objective-position", Level::kShould,
     "GetObjectivePosition never ends the process.", "document is silent; our choice",
     Profiles::kDocumented, "kinovazed.death.objective-position"},
    {"kinovazed.death.retract-read", Level::kMust,
     "A mode that cannot be read in Retract ends the process.", "server; reference 11.3",
     Profiles::kFirmware, "kinovazed.death.no-retract-read"},
    {"kinovazed.death.no-retract-read", Level::kShould,
     "A mode that cannot be read in Retract leaves the server answering.",
     "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.retract-read"},
    {"kinovazed.death.mode-release", Level::kMust,
     "A release that fails in SetJoystickMode ends the process.", "server; reference 11.3",
     Profiles::kFirmware, "kinovazed.death.no-mode-release"},
    {"kinovazed.death.no-mode-release", Level::kShould,
     "A release that fails in SetJoystickMode leaves the server answering.",
     "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.mode-release"},
    {"kinovazed.death.accept-reset", Level::kMust,
     "A client that resets while it waits ends the process when its turn comes.",
     "server; reference 1.7", Profiles::kFirmware, "kinovazed.death.no-accept-reset"},
    {"kinovazed.death.no-accept-reset", Level::kShould,
     "A client that resets while it waits does no harm.", "document is silent; our choice",
     Profiles::kDocumented, "kinovazed.death.accept-reset"},
    {"kinovazed.death.mute", Level::kMust,
     "A write that fails while another message waits behind it mutes the server for good: "
     "Freeze and a reset do.",
     "server, transcript S11", Profiles::kFirmware, "kinovazed.death.no-mute"},
    {"kinovazed.death.no-mute", Level::kShould, "Freeze and a reset do no harm.",
     "document is silent; our choice", Profiles::kDocumented, "kinovazed.death.mute"},
};

}  // namespace

std::span<const Requirement> death_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
