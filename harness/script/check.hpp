// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "harness/script/program.hpp"
#include "harness/script/schedule.hpp"

namespace armjig::script {

/// What is worth saying about a program before it runs, in the order of lines: what its reader
/// remarked; what the commander would stumble over; arguments without effect; a gripper that is
/// not waited for. `Severity::kError` if it cannot run to its end.
[[nodiscard]] std::vector<Diagnostic> check(const Program& program);

/// The same of its moves: singularities on the way, an end before the end. A note at the program's
/// last line says how long it takes.
[[nodiscard]] std::vector<Diagnostic> check(const Program& program, const Schedule& schedule);

}  // namespace armjig::script
