// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
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
  /// Whether more wants to run on this machine than it has processors for, so that anything may
  /// fail once, and a moment be missed twice, without anybody's fault. Never if empty.
  std::function<bool()> is_busy{};
  /// Opens an emulated device that obeys, on a link of the same kind as the target's, to tell what
  /// comes from link and machine. What it gives is none if that cannot be had. Empty: the link adds
  /// nothing, as in virtual time.
  std::function<std::shared_ptr<Bench>()> reference{};
  /// How much of the must requirements within reach has to be judged; less is a failure.
  double required_share = 0.95;
  std::string target{};   ///< as the user wrote it, for the report
  std::string command{};  ///< the command line, without filter, that does the same again
  /// Asked before each case and after it: cases from then on are skipped, and so is one during
  /// which it came.
  MustStop must_stop = [] { return false; };
  /// Whether that is because the time for the run is up.
  std::function<bool()> is_time_up = [] { return false; };
  /// Told what is done next and may take its time; nobody is if empty.
  std::function<void(std::string_view what)> on_wait{};
};

/// Runs the selected cases and calls `on_row` after each. The device is asked for a sign of life
/// first, last and when it fails by silence: one that answers no more is a `kError` row of its own
/// and not a failure of the case. Cases that could not run because of it are `kSkipped`.
///
/// What was found while this process was stopped, or had no time, is not counted as a run of a
/// case: it starts again, and after some such starts it is inconclusive.
///
/// A row of its own fails if less was judged than is required; not if the rig stood in the way.
///
/// A case of a documented requirement that fails, while those of the firmware's requirement about
/// the same thing pass, is a `kDeviation`.
[[nodiscard]] Report run_suite(const Suite& suite, Bench& bench, const RunOptions& options,
                               const std::function<void(const ReportRow&)>& on_row);

}  // namespace armjig
