// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "conformance/selection.hpp"
#include "conformance/suite.hpp"
#include "conformance/waivers.hpp"
#include "harness/report/report.hpp"
#include "harness/rig/guard.hpp"
#include "harness/rig/stoppable_ports.hpp"

namespace armjig {

/// How a suite is run.
struct RunOptions {
  Profile profile = Profile::kFirmware;  ///< whose expectations
  Selection selection{};
  Permissions permissions{};  ///< cases that need more are skipped
  std::uint64_t seed = 1;
  int repeat = 1;  ///< runs of each case, at least 1; different verdicts make it flaky
  bool stops_at_first_failure = false;
  std::vector<Waiver> waivers{};
  /// How long in all this process did not run although it should have; nobody asks if empty. A case
  /// that did not pass while that grew is started again.
  std::function<Duration()> missed{};
  std::string target{};   ///< as the user wrote it, for the report
  std::string command{};  ///< the command line, without filter, that does the same again
  /// Asked before each case and after it: cases from then on are skipped, and so is one during
  /// which it came.
  MustStop must_stop = [] { return false; };
};

/// Runs the selected cases and calls `on_row` after each. The device is asked for a sign of life
/// first, last and when it fails by silence: one that answers no more is a `kError` row of its own
/// and not a failure of the case. Cases that could not run because of it are `kSkipped`.
///
/// What was found while this process was stopped, or had no time, is not counted as a run of a
/// case: it starts again, and after some such starts it is inconclusive.
///
/// A case of a documented requirement that fails, while those of the firmware's requirement about
/// the same thing pass, is a `kDeviation`.
[[nodiscard]] Report run_suite(const Suite& suite, Bench& bench, const RunOptions& options,
                               const std::function<void(const ReportRow&)>& on_row);

}  // namespace armjig
