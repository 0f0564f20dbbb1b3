// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"kinovazed.beat.period", Level::kMust, "The next heartbeat comes 1 s after the one before.",
     "server, recording heartbeat-period"},
    {"kinovazed.beat.single", Level::kMust, "There is one heartbeat in each second, and no other.",
     "server, recording heartbeat-period"},
    {"kinovazed.beat.values", Level::kMust,
     "Whatever happens, a heartbeat is one of 1, 3, 5, 13, 21, 37, 69 and 133.",
     "document; server; reference 7"},
    {"kinovazed.beat.decimal", Level::kMust,
     "The number of a heartbeat is decimal, without sign and padding.", "document; server"},
    {"kinovazed.beat.during-commands", Level::kMust, "Commands do not hold heartbeats up.",
     "server; reference 2.1"},
    {"kinovazed.beat.stopped", Level::kMust, "In emergencyStopped the heartbeat is 3.",
     "document; server, recording heartbeat-values-resting"},
    {"kinovazed.beat.off", Level::kMust, "In poweredOff the heartbeat is 1.",
     "document; server, recording heartbeat-values-resting"},
    {"kinovazed.beat.initializing", Level::kMust,
     "While the arm initializes behind an emergency stop the heartbeat is 1.",
     "document; server, state-command-matrix"},
    {"kinovazed.beat.initializing-again", Level::kMust,
     "While the arm initializes again from idle the heartbeat is 5.", "server; reference 7",
     Profiles::kFirmware},
    {"kinovazed.beat.idle", Level::kMust, "In idle the heartbeat is 21.",
     "document; server, recording heartbeat-values-resting"},
    {"kinovazed.beat.retracting", Level::kMust, "In retracting the heartbeat is 5.",
     "document; server, state-command-matrix"},
    {"kinovazed.beat.retracted", Level::kMust, "In retracted the heartbeat is 133.",
     "document; server, recording heartbeat-values-resting"},
    {"kinovazed.beat.unfolding", Level::kMust, "In unfolding the heartbeat is 5.",
     "document; server, state-command-matrix"},
    {"kinovazed.beat.setting-mode", Level::kMust, "In settingMode the heartbeat is 5.",
     "document; server, state-command-matrix"},
    {"kinovazed.beat.steering", Level::kMust, "In steering the heartbeat is 69.",
     "document; server, recording heartbeat-values-resting"},
    {"kinovazed.beat.running", Level::kMust, "In runningSequence the heartbeat is 37.",
     "document; server, state-command-matrix"},
    {"kinovazed.beat.frozen", Level::kMust, "In frozen the heartbeat is 13.",
     "document; server, recording heartbeat-values-resting"},
    {"kinovazed.beat.initialized", Level::kMust,
     "EStop clears the bit isInitialized, and only Initialized sets it again.",
     "document; server, recording heartbeat-initialised-bit"},
    {"kinovazed.beat.lost-arm", Level::kMust,
     "While the arm is lost no heartbeat comes, and never one without bit 0.",
     "server, recording fault-outage-idle", Profiles::kFirmware, "kinovazed.beat.shows-lost-arm"},
    {"kinovazed.beat.shows-lost-arm", Level::kMust,
     "While the arm is lost heartbeats go on, without bit 0.", "document: isConnected; our reading",
     Profiles::kDocumented, "kinovazed.beat.lost-arm"},
};

}  // namespace

std::span<const Requirement> beat_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
