// SPDX-License-Identifier: Apache-2.0
#include "conformance/suite.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "conformance/demo/suite.hpp"
#include "conformance/parol6/suite.hpp"
#include "harness/core/version.hpp"

namespace armjig {
namespace {

/// One run over a suite.
class Run {
 public:
  Run(const Suite& suite, StreamPort& port, const Target& target, const Selection& selection,
      const std::function<void(const ReportRow&)>& on_row)
      : suite_{suite},
        target_{target},
        selection_{selection},
        on_row_{on_row},
        bench_{port, dissector_of(suite)} {}

  Report all() {
    report_.title = fmt::format("Conformance of {}", suite_.device);
    report_.facts = {{"target", target_.text},
                     {"profile", "firmware"},
                     {"armjig", kVersion},
                     {"selected", selection_.filter.empty() ? "all cases" : selection_.filter}};
    bool is_alive = check_alive("before the first case");
    for (const auto& one : suite_.cases) {
      if (!is_selected(selection_, one)) continue;
      if (!is_permitted(one)) {
        skip(one, fmt::format("needs --allow {}", to_string(one.hazard)));
      } else if (!is_alive) {
        skip(one, "the target does not answer");
      } else {
        is_alive = run_case(one);
      }
    }
    if (is_alive) (void)check_alive("after the last case");
    return std::move(report_);
  }

 private:
  static const DissectorEntry& dissector_of(const Suite& suite) {
    return *std::ranges::find(dissectors(), suite.device, &DissectorEntry::device);
  }

  [[nodiscard]] bool is_permitted(const Case& one) const {
    return target_.is_emulated() || selection_.permissions.allow(one.hazard);
  }

  void skip(const Case& one, std::string reason) {
    add(row_of(one, {Verdict::kSkipped, {}, std::move(reason)}));
  }

  /// Runs one case. False if the target is gone.
  bool run_case(const Case& one) {
    bench_.forget_exchange();
    const auto start = bench_.now();
    auto judgement = one.run(bench_);
    if (bench_.error()) {
      judgement = {Verdict::kError, {}, std::string{describe(bench_.error()->code)}};
    }
    auto row = row_of(one, std::move(judgement));
    row.duration = bench_.now() - start;
    if (row.verdict != Verdict::kPass) row.evidence = bench_.last_exchange();
    add(std::move(row));
    return !bench_.error() && check_alive(fmt::format("after {}", one.id));
  }

  bool check_alive(std::string_view when) {
    bench_.forget_exchange();
    if (suite_.prepare(bench_)) return true;
    ReportRow row;
    row.verdict = Verdict::kError;
    row.name = fmt::format("{}.alive", suite_.device);
    row.summary = fmt::format("no sign of life {}", when);
    row.expected = "an answer to a good message";
    row.actual = bench_.error() ? std::string{describe(bench_.error()->code)} : "silence";
    row.evidence = bench_.last_exchange();
    add(std::move(row));
    return false;
  }

  [[nodiscard]] ReportRow row_of(const Case& one, Judgement judgement) const {
    const auto& requirement = requirement_of(suite_, one);
    ReportRow row;
    row.verdict = judgement.verdict;
    row.name = one.id;
    row.summary = one.rule;
    row.requirement = requirement.id;
    row.level = requirement.level;
    row.demand = requirement.text;
    row.source = requirement.source;
    row.expected = std::move(judgement.expected);
    row.actual = std::move(judgement.actual);
    row.repeat = fmt::format("armjig conformance {} --target '{}'{} --filter {}", suite_.device,
                             target_.text, selection_.arguments, one.id);
    return row;
  }

  void add(ReportRow row) {
    on_row_(row);
    report_.rows.push_back(std::move(row));
  }

  const Suite& suite_;
  const Target& target_;
  const Selection& selection_;
  const std::function<void(const ReportRow&)>& on_row_;
  Bench bench_;
  Report report_;
};

}  // namespace

std::span<const Suite> suites() noexcept {
  static const std::array kSuites{demo::suite(), parol6::suite()};
  return kSuites;
}

const Requirement& requirement_of(const Suite& suite, const Case& one) noexcept {
  return *std::ranges::find(suite.requirements, one.requirement, &Requirement::id);
}

bool is_selected(const Selection& selection, const Case& one) noexcept {
  return one.id.find(selection.filter) != std::string_view::npos;
}

Report run_suite(const Suite& suite, StreamPort& port, const Target& target,
                 const Selection& selection, const std::function<void(const ReportRow&)>& on_row) {
  return Run{suite, port, target, selection, on_row}.all();
}

}  // namespace armjig
