// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
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

/// What a program sends, and all that is to be said about it, in the order of lines but for what
/// its moves give rise to.
struct Inspection {
  std::optional<Schedule> schedule;  ///< none: there is an error
  std::vector<Diagnostic> found;
};
[[nodiscard]] Inspection inspect(const Program& program, const InterpreterSettings& settings,
                                 const parol6::JointSteps& from);

/// Where the guard before a device that is not emulated would end it, if the arm follows as it
/// should. `homed`: the flag byte of telemetry.
[[nodiscard]] std::optional<Diagnostic> check_guarded(const Program& program,
                                                      const Schedule& schedule,
                                                      const parol6::JointSteps& from,
                                                      std::uint8_t homed);

}  // namespace armjig::script
