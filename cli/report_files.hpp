// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <array>

#include "harness/report/report.hpp"

namespace armjig::cli {

/// Adds `--json`, `--html`, `--junit` and `--sarif`, each with a file, and answers them.
std::array<CLI::Option*, 4> add_report_files(CLI::App& command, ReportFiles& files);

}  // namespace armjig::cli
