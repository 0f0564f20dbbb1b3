// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/chapters.hpp"

namespace armjig::kinovazed::conformance {
namespace {

constexpr Requirement kRequirements[] = {
    {"kinovazed.state.start", Level::kMust,
     "A server that was just started is in emergencyStopped.", "server; reference 6.1"},
    {"kinovazed.state.table", Level::kMust,
     "Commands act by the state alone, whatever their arguments: every mode and every "
     "objective is refused where one is.",
     "server; reference 6.2"},
    {"kinovazed.state.stopped.estop", Level::kMust, "In emergencyStopped EStop stays there.",
     "server, state-command-matrix"},
    {"kinovazed.state.stopped.quit-estop", Level::kMust,
     "In emergencyStopped QuitEStop leads to poweredOff.", "server, state-command-matrix"},
    {"kinovazed.state.stopped.refused", Level::kMust,
     "In emergencyStopped all commands but EStop and QuitEStop are Rejected and change "
     "nothing.",
     "server, state-command-matrix"},
    {"kinovazed.state.off.estop", Level::kMust, "In poweredOff EStop leads to emergencyStopped.",
     "server, state-command-matrix"},
    {"kinovazed.state.off.quit-estop", Level::kMust, "In poweredOff QuitEStop stays there.",
     "server, state-command-matrix"},
    {"kinovazed.state.off.initialize", Level::kMust,
     "In poweredOff Initialize leads by way of initializing to idle.",
     "server, state-command-matrix"},
    {"kinovazed.state.off.refused", Level::kMust,
     "In poweredOff all commands but EStop, QuitEStop and Initialize are Rejected and "
     "change nothing.",
     "server, state-command-matrix"},
    {"kinovazed.state.initializing.estop", Level::kMust,
     "In initializing EStop leads to emergencyStopped.", "server, state-command-matrix"},
    {"kinovazed.state.initializing.refused", Level::kMust,
     "In initializing all commands but EStop are Rejected, and Initialized still comes.",
     "server, state-command-matrix"},
    {"kinovazed.state.idle.estop", Level::kMust, "In idle EStop leads to emergencyStopped.",
     "server, state-command-matrix"},
    {"kinovazed.state.idle.initialize", Level::kMust,
     "In idle Initialize leads by way of initializing back to idle.",
     "server, state-command-matrix"},
    {"kinovazed.state.idle.retract", Level::kMust, "In idle Retract leads to retracting.",
     "server, state-command-matrix"},
    {"kinovazed.state.idle.freeze", Level::kMust, "In idle Freeze leads to frozen.",
     "server, state-command-matrix"},
    {"kinovazed.state.idle.mode", Level::kMust, "In idle SetJoystickMode leads to settingMode.",
     "server, state-command-matrix"},
    {"kinovazed.state.idle.objective", Level::kMust,
     "In idle RunObjective leads to runningSequence.", "server, state-command-matrix"},
    {"kinovazed.state.idle.refused", Level::kMust,
     "In idle Unfold, Unfreeze, MoveJoystick and QuitEStop are Rejected and change "
     "nothing.",
     "server, state-command-matrix"},
    {"kinovazed.state.retracting.estop", Level::kMust,
     "In retracting EStop leads to emergencyStopped.", "server, state-command-matrix"},
    {"kinovazed.state.retracting.refused", Level::kMust,
     "In retracting all commands but EStop are Rejected, and Retracted still comes.",
     "server, state-command-matrix"},
    {"kinovazed.state.retracted.estop", Level::kMust,
     "In retracted EStop leads to emergencyStopped.", "server, state-command-matrix"},
    {"kinovazed.state.retracted.unfold", Level::kMust, "In retracted Unfold leads to unfolding.",
     "server, state-command-matrix"},
    {"kinovazed.state.retracted.refused", Level::kMust,
     "In retracted all commands but EStop, Unfold and Retract are Rejected and change "
     "nothing.",
     "server, state-command-matrix"},
    {"kinovazed.state.unfolding.estop", Level::kMust,
     "In unfolding EStop leads to emergencyStopped.", "server, state-command-matrix"},
    {"kinovazed.state.unfolding.refused", Level::kMust,
     "In unfolding all commands but EStop are Rejected, and Unfolded still comes.",
     "server, state-command-matrix"},
    {"kinovazed.state.setting-mode.estop", Level::kMust,
     "In settingMode EStop leads to emergencyStopped.", "server, state-command-matrix"},
    {"kinovazed.state.setting-mode.retract", Level::kMust,
     "In settingMode Retract leads to retracting.", "server, state-command-matrix"},
    {"kinovazed.state.setting-mode.refused", Level::kMust,
     "In settingMode all commands but EStop and Retract are Rejected, and JoystickModeSet "
     "still comes.",
     "server, state-command-matrix"},
    {"kinovazed.state.steering.estop", Level::kMust, "In steering EStop leads to emergencyStopped.",
     "server, state-command-matrix"},
    {"kinovazed.state.steering.freeze", Level::kMust, "In steering Freeze leads to frozen.",
     "server, state-command-matrix"},
    {"kinovazed.state.steering.mode", Level::kMust,
     "In steering SetJoystickMode leads to settingMode.", "server, state-command-matrix"},
    {"kinovazed.state.steering.move", Level::kMust, "In steering MoveJoystick stays there.",
     "server, state-command-matrix"},
    {"kinovazed.state.steering.objective", Level::kMust,
     "In steering RunObjective leads to runningSequence.", "server, state-command-matrix"},
    {"kinovazed.state.steering.refused", Level::kMust,
     "In steering Initialize, Unfold, Retract, Unfreeze and QuitEStop are Rejected and "
     "change nothing.",
     "server, state-command-matrix"},
    {"kinovazed.state.running.estop", Level::kMust,
     "In runningSequence EStop leads to emergencyStopped.", "server, state-command-matrix"},
    {"kinovazed.state.running.mode", Level::kMust,
     "In runningSequence SetJoystickMode leads to settingMode.", "server, state-command-matrix"},
    {"kinovazed.state.running.objective", Level::kMust,
     "In runningSequence RunObjective stays there.", "server, state-command-matrix"},
    {"kinovazed.state.running.refused", Level::kMust,
     "In runningSequence all commands but EStop, SetJoystickMode and RunObjective are "
     "Rejected, and ObjectiveDone still comes.",
     "server, state-command-matrix"},
    {"kinovazed.state.frozen.estop", Level::kMust, "In frozen EStop leads to emergencyStopped.",
     "server, state-command-matrix"},
    {"kinovazed.state.frozen.unfreeze", Level::kMust, "In frozen Unfreeze leads to idle.",
     "server, state-command-matrix"},
    {"kinovazed.state.frozen.refused", Level::kMust,
     "In frozen all commands but EStop, Unfreeze and Freeze are Rejected and change "
     "nothing.",
     "server, state-command-matrix"},
};

}  // namespace

std::span<const Requirement> state_requirements() noexcept { return kRequirements; }

}  // namespace armjig::kinovazed::conformance
