// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/suite.hpp"

/// The chapters of the PAROL6 suite, a file each in chapters/.
namespace armjig::parol6::conformance {

[[nodiscard]] Chapter frame_chapter();
[[nodiscard]] Chapter receive_chapter();
[[nodiscard]] Chapter telemetry_chapter();
[[nodiscard]] Chapter io_chapter();
[[nodiscard]] Chapter command_chapter();
[[nodiscard]] Chapter jog_chapter();
[[nodiscard]] Chapter go_to_chapter();
[[nodiscard]] Chapter home_run_chapter();
[[nodiscard]] Chapter home_chapter();
[[nodiscard]] Chapter demo_chapter();
[[nodiscard]] Chapter gripper_chapter();
[[nodiscard]] Chapter set_point_chapter();

}  // namespace armjig::parol6::conformance
