// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// What a program has to do before it can break some of the requirements.
namespace armjig::parol6::programs::occasion {

inline constexpr std::string_view kCommand = "a command other than idle";
inline constexpr std::string_view kEstop = "a press of the emergency stop";
inline constexpr std::string_view kGoTo = "a go-to";
inline constexpr std::string_view kGripperClear = "a clear-error of the gripper";
inline constexpr std::string_view kGripperMode = "a calibration or clear-error of the gripper";
inline constexpr std::string_view kGripperMove = "another position for the gripper";
inline constexpr std::string_view kHome = "a home command";
inline constexpr std::string_view kHomedGoTo = "a go-to of a homed arm";
inline constexpr std::string_view kHomedJog = "a jog of a homed arm";
inline constexpr std::string_view kJog = "a jog";
inline constexpr std::string_view kMotion = "a frame that has joints move";
inline constexpr std::string_view kMove = "a home, jog or go-to";
inline constexpr std::string_view kSecond = "frames for a second";

}  // namespace armjig::parol6::programs::occasion
