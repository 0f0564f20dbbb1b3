// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "harness/report/report.hpp"

namespace armjig {

/// For the end of a run: a line for each row that failed, is flaky or was in the way of the rig,
/// with what is wrong as far as a line has room for it. Empty if there is none.
[[nodiscard]] std::string failures_text(const Report& report, Style style = Style::kPlain);

}  // namespace armjig
