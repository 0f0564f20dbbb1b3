// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string_view>
#include <vector>

#include "harness/report/report.hpp"

namespace armjig::cli {

/// Adds an option with a file for each form of a report but `except`, and answers them.
std::vector<CLI::Option*> add_report_files(CLI::App& command, ReportFiles& files,
                                           std::string_view except = {});

}  // namespace armjig::cli
