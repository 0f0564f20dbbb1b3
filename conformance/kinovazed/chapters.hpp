// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/suite.hpp"

/// The chapters of the KinovaZED suite, a file each in chapters/.
namespace armjig::kinovazed::conformance {

[[nodiscard]] Chapter state_chapter();
[[nodiscard]] Chapter connection_chapter();
[[nodiscard]] Chapter line_chapter();
[[nodiscard]] Chapter long_line_chapter();
[[nodiscard]] Chapter reply_chapter();
[[nodiscard]] Chapter interrupt_chapter();
[[nodiscard]] Chapter beat_chapter();
[[nodiscard]] Chapter mode_chapter();
[[nodiscard]] Chapter joystick_chapter();
[[nodiscard]] Chapter objective_chapter();
[[nodiscard]] Chapter arm_chapter();
[[nodiscard]] Chapter robust_chapter();
[[nodiscard]] Chapter death_chapter();

}  // namespace armjig::kinovazed::conformance
