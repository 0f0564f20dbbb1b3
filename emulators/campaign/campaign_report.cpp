// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/campaign_report.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>

#include "emulators/campaign/cause.hpp"
#include "emulators/campaign/folder.hpp"

namespace armjig::campaign {
namespace {

double rate_of(const CampaignState& state) {
  const auto passed = std::chrono::duration<double>{state.passed}.count();
  return passed > 0 ? static_cast<double>(state.cases) / passed : 0;
}

/// The further ways, with the names that their files have.
std::string ways_of(const Cause& cause) {
  constexpr std::size_t kMostTold = 20;
  const auto count = cause.further.size();
  if (count == 0) return {};
  auto text = fmt::format("\nit showed in {} further way{}", count, count == 1 ? "" : "s");
  for (std::size_t i = 0; i < std::min(count, kMostTold); ++i) {
    text += fmt::format("\n  {} ({})", cause.further[i]->symptom.key(),
                        campaign::name_of(*cause.further[i]));
  }
  return count > kMostTold ? text + "\n  ..." : text;
}

ReportRow row_of(const std::string& device, const Cause& cause) {
  const auto& finding = *cause.finding;
  ReportRow row;
  row.verdict = finding.known.empty() ? Verdict::kFail : Verdict::kDeviation;
  row.name = fmt::format("{}.fuzz.{}", device, campaign::name_of(finding));
  row.summary = finding.sentence;
  row.expected = finding.symptom.expected;
  row.actual = finding.known.empty()
                   ? finding.symptom.actual
                   : fmt::format("{} (known: {})", finding.symptom.actual, finding.known);
  row.evidence = fmt::format(
      "symptom: {}\ncase {}, {:.1f} s after the beginning; {} records, {} after shrinking, "
      "and the harmless question{}",
      finding.symptom.key(), finding.case_number,
      std::chrono::duration<double>{finding.found_after}.count(), finding.found_size, finding.size,
      ways_of(cause));
  return row;
}

ReportRow row_of_cases(const std::string& device, const CampaignState& state) {
  ReportRow row;
  row.verdict = state.cases > 0 ? Verdict::kPass : Verdict::kSkipped;
  row.name = fmt::format("{}.fuzz.cases", device);
  row.summary = fmt::format("{} cases were played to the end.", state.cases);
  if (state.cases == 0) row.actual = "no case was played";
  return row;
}

ReportRow row_of_what_stays(const std::string& device, const CampaignState& state) {
  ReportRow row;
  row.verdict = Verdict::kInconclusive;
  row.name = fmt::format("{}.fuzz.stays", device);
  row.summary = "As long as nothing is done, the device is like the model.";
  row.actual = fmt::format("it is not, and nobody can start it again, so nothing is said of {}",
                           fmt::join(state.passed_over, "; "));
  return row;
}

}  // namespace

Report to_report(const std::string& device, const CampaignState& state,
                 const std::function<std::string(const Finding&)>& repeat_of) {
  Report report;
  report.title = fmt::format("fuzz campaign of {}", device);
  const auto causes = causes_of(state.findings);
  for (const auto& cause : causes) {
    report.rows.push_back(row_of(device, cause));
    report.rows.back().repeat = repeat_of(*cause.finding);
  }
  if (!state.passed_over.empty()) report.rows.push_back(row_of_what_stays(device, state));
  report.rows.push_back(row_of_cases(device, state));
  ReportSection shown{.title = "what the device showed"};
  shown.table.columns = {"what", "how many"};
  const auto add = [&shown](const char* what, std::string value) {
    shown.table.rows.push_back({what, std::move(value)});
  };
  add("cases", fmt::format("{}", state.cases));
  add("cases a second", fmt::format("{:.1f}", rate_of(state)));
  add("further ways in which findings showed",
      fmt::format("{}", state.findings.size() - causes.size()));
  add("states", fmt::format("{}", state.shown.states()));
  add("transitions", fmt::format("{}", state.shown.transitions()));
  add("distinct answers", fmt::format("{}", state.shown.answers()));
  add("cases kept because they showed something new", fmt::format("{}", state.worthy.size()));
  add("cases that the guard ended", fmt::format("{}", state.refused));
  if (!state.last_refusal.empty()) add("why it ended the last of them", state.last_refusal);
  add("symptoms that did not come again, or of the link", fmt::format("{}", state.unsettled));
  if (!state.last_unsettled.empty()) add("the last of them", state.last_unsettled);
  report.sections.push_back(std::move(shown));
  return report;
}

ReportRow row_of_end(const std::string& device, const Problem& problem) {
  ReportRow row;
  row.verdict = Verdict::kError;
  row.name = fmt::format("{}.fuzz.end", device);
  row.summary = "The campaign goes on until its time is over.";
  row.actual = fmt::format("it ended early: {}", describe(problem));
  return row;
}

std::string progress_line(const CampaignState& state) {
  const auto count = state.causes;
  return fmt::format(
      "{} cases, {:.1f} a second; {} states, {} transitions, {} answers; {} finding{}", state.cases,
      rate_of(state), state.shown.states(), state.shown.transitions(), state.shown.answers(), count,
      count == 1 ? "" : "s");
}

}  // namespace armjig::campaign
