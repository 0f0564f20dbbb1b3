// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"kinovazed.arm.silent-stop", Level::kMust,
     "A failure of the arm that can be repaired ends in emergencyStopped without a word; "
     "the next heartbeat shows it.",
     "server, recordings fault-status-*"},
    {"kinovazed.arm.recovers", Level::kMust,
     "Behind a repair QuitEStop and Initialize lead to idle as ever.", "server, transcript S6"},
    {"kinovazed.arm.position-read", Level::kMust,
     "One position that cannot be read changes nothing.", "server, recording fault-position-read"},
    {"kinovazed.arm.take-control", Level::kMust,
     "If control cannot be taken Initialize ends in emergencyStopped, and Initialized "
     "never comes.",
     "server, recording fault-take-control"},
    {"kinovazed.arm.button", Level::kMust,
     "If the home button cannot be pressed Initialize ends in emergencyStopped, and "
     "Initialized never comes.",
     "server, recording fault-button-initialize"},
    {"kinovazed.arm.erase", Level::kMust,
     "If a trajectory cannot be erased RunObjective ends in emergencyStopped, and "
     "ObjectiveDone never comes.",
     "server, recording fault-erase-objective"},
    {"kinovazed.arm.release", Level::kMust,
     "If the stick cannot be released Freeze is still confirmed, and ends in "
     "emergencyStopped.",
     "server, recording fault-release-freeze"},
    {"kinovazed.arm.move", Level::kMust,
     "If a deflection cannot be written the move is still Accepted, and ends in "
     "emergencyStopped.",
     "server, transcript S7"},
    {"kinovazed.arm.current-high", Level::kMust, "4 A of all joints together change nothing.",
     "server, recording fault-current-high"},
    {"kinovazed.arm.early-ready", Level::kMust,
     "An arm that reports ready while it initializes is initialized at once.",
     "server, recording fault-early-ready"},
    {"kinovazed.stop.no-release", Level::kMust,
     "A stop is erase, zero axes, release; failing axes leave out the release.",
     "server; reference 11.1", Profiles::kBoth, "", Role::kDevice,
     "what reaches the arm is not on the wire"},
};

}  // namespace

std::span<const Requirement> arm_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
