// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "conformance/run.hpp"
#include "conformance/suite.hpp"

namespace armjig {

/// What one or several runs of a case came to.
struct CaseResult {
  Judgement judgement;
  std::string evidence;
  Duration duration{};
};

/// Tells a failure of the device from one of the link or the machine: it counts if an emulated
/// device on a link of the same kind does not fail, and a moment that was missed, or anything on a
/// busy machine, only if it is missed again. Without `RunOptions::reference` all of them count.
class Doubt {
 public:
  /// `run` runs a case on the device of `bench` once. All outlive this.
  Doubt(Bench& bench, const RunOptions& options, std::function<CaseResult(const Case&)> run);

  /// Finds out how late answers come, and which part of that is the link's.
  void measure_link();
  /// How late answers of an emulated device come on such a link; none if that is not known.
  [[nodiscard]] std::optional<Duration> link() const noexcept { return link_; }

  /// Whether the machine has more to do than it has processors.
  [[nodiscard]] bool is_busy() const;
  /// Whether it may have come of time that link or machine took.
  [[nodiscard]] bool may_be_late(const Judgement& judgement) const;

  /// Runs a case as often as it takes to be sure. Once a case `has_failed` for good, a busy machine
  /// excuses nothing but moments: a device with many faults would take many runs for each.
  [[nodiscard]] CaseResult settle(const Case& one, bool has_failed);

 private:
  [[nodiscard]] bool is_moment(const Judgement& judgement) const noexcept;
  [[nodiscard]] bool must_fail_again(const CaseResult& result, bool has_failed) const;
  [[nodiscard]] bool is_over() const;
  CaseResult doubt_moment(const Case& one, CaseResult result);
  CaseResult compare(const Case& one, CaseResult result, int tries);
  [[nodiscard]] std::shared_ptr<Bench> open_reference() const;

  Bench& bench_;
  const RunOptions& options_;
  std::function<CaseResult(const Case&)> run_;
  std::optional<Duration> link_;
};

}  // namespace armjig
