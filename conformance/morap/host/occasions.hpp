// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// What a master has to do before it can break some of the requirements.
namespace armjig::morap::programs::occasion {

inline constexpr std::string_view kCalibration = "a calibration";
inline constexpr std::string_view kNode = "a message to a node";
inline constexpr std::string_view kNumber = "a reference or an angle";
inline constexpr std::string_view kPen = "a message to the pen";
inline constexpr std::string_view kProgram = "a message that changes parameters";
inline constexpr std::string_view kRead = "a read of a node";
inline constexpr std::string_view kReference = "a reference";
inline constexpr std::string_view kSet = "a parameter message";
inline constexpr std::string_view kTuning = "a tuning message";
inline constexpr std::string_view kTwoPens = "two messages to the pen";
inline constexpr std::string_view kTwoPrograms = "two messages that change parameters";

}  // namespace armjig::morap::programs::occasion
