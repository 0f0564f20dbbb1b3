// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "harness/drive/parol6/drive.hpp"
#include "harness/report/report.hpp"
#include "harness/script/program_run.hpp"

namespace armjig::script {

/// A line a move: the joint that was farthest off on the way, and at the end.
[[nodiscard]] Table results_table(const Program& program, const ProgramRun& run);

/// What a run is told apart by, besides its moves.
struct RunFacts {
  std::string_view file;
  std::string_view target;
  bool ran_to_end{};
  parol6::JointSteps position{};  ///< of the last telemetry
  const parol6::drive::DriveStatistics& link;
};

/// One JSON object of docs/schemas/run.schema.json, "armjig.run/1".
[[nodiscard]] std::string to_json(const Program& program, const ProgramRun& run,
                                  const RunFacts& facts);

/// Over time, for each joint that moved: place, and place minus set-point.
struct RunPlots {
  Plot position;
  Plot error;
};
/// Of the samples that the run has kept.
[[nodiscard]] RunPlots run_plots(const ProgramRun& run);

}  // namespace armjig::script
