// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// What a client has to do before it can break some of the requirements. Those about a state
/// become possible with the state; then the checker names the requirement itself.
namespace armjig::kinovazed::programs::occasion {

inline constexpr std::string_view kActiveObjective = "SetActiveObjective";
inline constexpr std::string_view kEstop = "EStop";
inline constexpr std::string_view kFold = "an arm that initializes, folds or unfolds";
inline constexpr std::string_view kFreeze = "a frozen arm";
inline constexpr std::string_view kIdle = "an idle arm";
inline constexpr std::string_view kJoystick = "MoveJoystick";
inline constexpr std::string_view kJoystickLeft = "a client that steers and leaves";
inline constexpr std::string_view kLeft = "a client that leaves";
inline constexpr std::string_view kMode = "SetJoystickMode";
inline constexpr std::string_view kObjective = "a command with an objective";
inline constexpr std::string_view kObjectivePosition = "GetObjectivePosition";
inline constexpr std::string_view kRetracted = "a retracted arm";
inline constexpr std::string_view kRuns = "an objective that runs";
inline constexpr std::string_view kSilence = "a server that was silent for three seconds";
inline constexpr std::string_view kSteering = "a joystick mode that was set";
inline constexpr std::string_view kSettling = "a joystick mode that is being set";
inline constexpr std::string_view kStop = "an emergency stop";
inline constexpr std::string_view kTwoModes = "two joystick modes";
inline constexpr std::string_view kUnasked = "an emergency stop that the client did not ask for";

}  // namespace armjig::kinovazed::programs::occasion
