// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "harness/core/error.hpp"

namespace armjig {

/// A row whose verdict is another one than in the report before. An empty verdict: not in it.
struct VerdictChange {
  std::string name;
  std::string before;
  std::string after;
};

/// What is different between two reports, row by row. Passing means pass or deviation as known,
/// failing means fail, flaky or error; the rest did not run, which is neither.
struct ReportDiff {
  std::vector<VerdictChange> fixed;   ///< failed, and passes
  std::vector<VerdictChange> broken;  ///< fails, and did not before
  std::vector<VerdictChange> added;   ///< not in the report before, and does not fail
  std::vector<VerdictChange> lost;    ///< passed, and did not run
};

/// Reads two reports as `to_json` writes them. Problems: `kMalformed` with the name of the one
/// that is no such report.
[[nodiscard]] Outcome<ReportDiff> compare_reports(std::string_view before,
                                                  const std::string& before_name,
                                                  std::string_view after,
                                                  const std::string& after_name);

/// A line for each change, then a line of counts.
[[nodiscard]] std::string to_text(const ReportDiff& diff);

}  // namespace armjig
