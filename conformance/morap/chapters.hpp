// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/suite.hpp"

/// The chapters of the MORAP suite, a file each in chapters/.
namespace armjig::morap::conformance {

[[nodiscard]] Chapter bus_chapter();
[[nodiscard]] Chapter reading_chapter();
[[nodiscard]] Chapter status_chapter();
[[nodiscard]] Chapter reference_chapter();
[[nodiscard]] Chapter output_chapter();
[[nodiscard]] Chapter program_chapter();
[[nodiscard]] Chapter stored_chapter();
[[nodiscard]] Chapter tune_chapter();
[[nodiscard]] Chapter loop_chapter();
[[nodiscard]] Chapter loop_mode_chapter();
[[nodiscard]] Chapter motion_chapter();
[[nodiscard]] Chapter documented_chapter();
[[nodiscard]] Chapter pen_chapter();

}  // namespace armjig::morap::conformance
