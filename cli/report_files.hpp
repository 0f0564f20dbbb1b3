// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/outputs.hpp"
#include "harness/report/report.hpp"

namespace armjig::cli {

/// Adds an option with a file for each form of a report but `except`, and answers them.
std::vector<CLI::Option*> add_report_files(CLI::App& command, ReportFiles& files,
                                           std::string_view except = {});

/// The files of a report, opened before the run that it is about.
class ReportOutputs {
 public:
  /// `claimed` is the option that has standard output for itself, if there is one. Problems: as for
  /// `open_output`.
  [[nodiscard]] static Outcome<ReportOutputs> open(const ReportFiles& files,
                                                   std::string_view claimed = {});

  /// What cannot be written is said at the end of the program.
  void put(const Report& report) const;
  [[nodiscard]] bool is_empty() const noexcept { return files_.empty(); }

 private:
  std::vector<std::pair<const ReportForm*, Output>> files_;
};

}  // namespace armjig::cli
