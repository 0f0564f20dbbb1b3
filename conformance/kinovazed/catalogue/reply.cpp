// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"kinovazed.reply.words", Level::kMust,
     "All that the server sends are its nine words and heartbeats, each with CR LF.",
     "document; server"},
    {"kinovazed.reply.one", Level::kMust,
     "Every command that is understood gets one Accepted or Rejected, in the order of the "
     "commands.",
     "server, state-command-matrix"},
    {"kinovazed.reply.accepted-first", Level::kMust,
     "Commands with an event of their own are Accepted before it.", "server, state-command-matrix",
     Profiles::kFirmware, "kinovazed.reply.event-only"},
    {"kinovazed.reply.event-only", Level::kMust,
     "Commands with an event of their own get the event only.",
     "document: one positive answer to each command; our reading", Profiles::kDocumented,
     "kinovazed.reply.accepted-first"},
    {"kinovazed.reply.prompt", Level::kMust,
     "Freezed follows its Accepted at once, with nothing in between.", "server; reference 6.5",
     Profiles::kFirmware},
    {"kinovazed.reply.prompt-unfreezed", Level::kMust,
     "Unfreezed follows its Accepted at once, with nothing in between.", "server; reference 6.5",
     Profiles::kFirmware},
    {"kinovazed.reply.race", Level::kMay,
     "If an action is over the moment it is asked for, its event may come before Accepted.",
     "server, recording repeat-initialize-swapped", Profiles::kFirmware},
    {"kinovazed.reply.once", Level::kMust, "An event is told once.", "server"},
    {"kinovazed.reply.recurring", Level::kMust,
     "A command that has led to a resting state, given again there, gets its event again.",
     "document, recurring commands; our reading", Profiles::kDocumented,
     "kinovazed.reply.not-recurring"},
    {"kinovazed.reply.not-recurring", Level::kMust,
     "Retract in retracted and Freeze in frozen are Rejected.", "server, recording repeat-retract",
     Profiles::kFirmware, "kinovazed.reply.recurring"},
    {"kinovazed.reply.recurring-idle", Level::kMust,
     "Unfold and Unfreeze, given again in the idle state to which they led, get their events "
     "again.",
     "document, recurring commands; our reading", Profiles::kDocumented,
     "kinovazed.reply.not-recurring-idle"},
    {"kinovazed.reply.not-recurring-idle", Level::kMust,
     "Unfold and Unfreeze are Rejected in idle, also if they led there.",
     "server, recording repeat-unfreeze", Profiles::kFirmware, "kinovazed.reply.recurring-idle"},
    {"kinovazed.reply.recurring-mode", Level::kMust,
     "The mode that is set already is confirmed at once.",
     "document, recurring commands; our reading", Profiles::kDocumented,
     "kinovazed.reply.not-recurring-mode"},
    {"kinovazed.reply.not-recurring-mode", Level::kMust,
     "The mode that is set already goes through the whole change again.",
     "server, recording repeat-mode", Profiles::kFirmware, "kinovazed.reply.recurring-mode"},
    {"kinovazed.reply.initialize-again", Level::kMust,
     "Initialize in idle at the ready pose is over at once.",
     "server, recording repeat-initialize"},
    {"kinovazed.time.answer", Level::kMust, "A command is answered within half a second.",
     "server; reference 14.3: 110 ms at most on a real arm"},
    {"kinovazed.time.turn", Level::kMust,
     "Every command, also a rejected one, waits for its turn with the arm.",
     "server; reference 6.3", Profiles::kBoth, "", Role::kDevice,
     "how long that takes depends on the arm; the answer within half a second is checked"},
    {"kinovazed.console.silent", Level::kMust,
     "SetActiveObjective, GetObjectivePosition and GetAbsolutePosition are never answered.",
     "server, recording service-commands-silent"},
    {"kinovazed.console.harmless", Level::kMust, "The three console commands change no state.",
     "server, recording service-commands-silent"},
    {"kinovazed.console.log", Level::kMust,
     "Positions go to the server's log as one JSON object, metres and radians.", "document",
     Profiles::kBoth, "", Role::kDevice, "the log is not on the wire"},
};

}  // namespace

std::span<const Requirement> reply_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
