// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "conformance/bench.hpp"
#include "harness/report/report.hpp"
#include "harness/rig/guard.hpp"
#include "harness/rig/target.hpp"

namespace armjig {

/// A sentence that a device has to obey. Ids are words, never renumbered and never used again.
struct Requirement {
  std::string_view id;
  Level level{};
  std::string_view text;
  std::string_view source;  ///< where it is written or seen
};

/// What a case found. `expected` and `actual` are sentences, empty for a pass.
struct Judgement {
  Verdict verdict{};
  std::string expected;
  std::string actual;
};

[[nodiscard]] inline Judgement pass() { return {Verdict::kPass, {}, {}}; }
[[nodiscard]] inline Judgement fail(std::string expected, std::string actual) {
  return {Verdict::kFail, std::move(expected), std::move(actual)};
}

/// A check of one requirement: data, and a short straight body.
struct Case {
  std::string_view id;  ///< begins with the id of its requirement
  std::string_view requirement;
  std::string_view rule;  ///< what happens, in one sentence
  Judgement (*run)(Bench& bench);
  Hazard hazard = Hazard::kObserve;  ///< what it does to a device
};

/// All that is known about one device.
struct Suite {
  std::string_view device;
  std::span<const Requirement> requirements;
  std::span<const Case> cases;
  /// Brings the device to where every case starts. False: it does not answer.
  bool (*prepare)(Bench& bench);
};

/// One for each device.
[[nodiscard]] std::span<const Suite> suites() noexcept;

/// The requirement of that id. Every case has one; a test proves it.
[[nodiscard]] const Requirement& requirement_of(const Suite& suite, const Case& one) noexcept;

/// Which cases to run, and how to say so on a command line.
struct Selection {
  std::string filter{};       ///< a piece of the case id; empty: all
  Permissions permissions{};  ///< cases with another hazard are skipped; emulated targets allow all
  std::string arguments{};    ///< more that a command line needs to do it again, blank in front
};

[[nodiscard]] bool is_selected(const Selection& selection, const Case& one) noexcept;

/// Runs the selected cases and calls `on_row` after each. The device is asked for a sign of life
/// first and last: one that never answers, or answers no more, is a `kError` row of its own and not
/// a failure of the cases. Cases that could not run because of it are `kSkipped`.
[[nodiscard]] Report run_suite(const Suite& suite, StreamPort& port, const Target& target,
                               const Selection& selection,
                               const std::function<void(const ReportRow&)>& on_row);

}  // namespace armjig
