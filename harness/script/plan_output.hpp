// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "harness/report/report.hpp"
#include "harness/script/schedule.hpp"

namespace armjig::script {

/// One line a move of the schedule: what it is, when, how far and how fast.
[[nodiscard]] Table moves_table(const Program& program, const Schedule& schedule);

/// A line for each frame, behind one with the names of the columns: frame, time, line of the
/// program, command code, positions and speeds as sent, places of the joints in degrees, and of the
/// tool in mm and degrees, oriented as the commander displays it.
[[nodiscard]] std::string to_csv(const Program& program, const Schedule& schedule);

/// One JSON object of docs/schemas/plan.schema.json, "armjig.plan/1". `file` is the program's name.
[[nodiscard]] std::string to_json(const Program& program, const Schedule& schedule,
                                  std::string_view file);

/// The schedule as a report: its moves, position, speed and acceleration of each joint, the tool's
/// path, and the arm in motion.
[[nodiscard]] Report to_report(const Program& program, const Schedule& schedule,
                               std::string_view file);

}  // namespace armjig::script
