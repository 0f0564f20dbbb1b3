// SPDX-License-Identifier: Apache-2.0
#include "harness/report/diff.hpp"

#include <fmt/core.h>

#include <map>
#include <nlohmann/json.hpp>

#include "harness/core/nesting.hpp"
#include "harness/report/wording.hpp"

namespace armjig {
namespace {

using Json = nlohmann::ordered_json;
using Verdicts = std::map<std::string, std::string>;

Outcome<Verdicts> read(std::string_view text, const std::string& name) {
  const auto not_a_report = [&name] {
    return problem(ErrorCode::kMalformed, name, "it is no armjig.report/1, which --json writes");
  };
  if (is_too_deep(text)) return problem(ErrorCode::kMalformed, name, std::string{kTooDeep});
  const auto json = Json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("schema", Json{}) != "armjig.report/1") {
    return not_a_report();
  }
  const auto rows = json.find("rows");
  if (rows == json.end() || !rows->is_array()) return not_a_report();
  Verdicts verdicts;
  for (const auto& row : *rows) {
    if (!row.is_object()) return not_a_report();
    const auto id = row.value("name", Json{});
    const auto verdict = row.value("verdict", Json{});
    if (!id.is_string() || !verdict.is_string()) return not_a_report();
    verdicts[id] = verdict;
  }
  return verdicts;
}

bool passes(std::string_view verdict) { return verdict == "pass" || verdict == "deviation"; }
bool fails(std::string_view verdict) {
  return verdict == "fail" || verdict == "flaky" || verdict == "error";
}

std::string verdict_in(const Verdicts& verdicts, const std::string& name) {
  const auto found = verdicts.find(name);
  return found == verdicts.end() ? std::string{} : found->second;
}

std::string lines(std::string_view word, const std::vector<VerdictChange>& changes) {
  std::string text;
  const auto said = [](const std::string& verdict) {
    return verdict.empty() ? std::string{"absent"} : wording::line(verdict);
  };
  for (const auto& [name, before, after] : changes) {
    text +=
        fmt::format("{:<7} {} ({} -> {})\n", word, wording::line(name), said(before), said(after));
  }
  return text;
}

}  // namespace

Outcome<ReportDiff> compare_reports(std::string_view before, const std::string& before_name,
                                    std::string_view after, const std::string& after_name) {
  const auto old_verdicts = read(before, before_name);
  if (!old_verdicts) return tl::unexpected{old_verdicts.error()};
  const auto new_verdicts = read(after, after_name);
  if (!new_verdicts) return tl::unexpected{new_verdicts.error()};
  ReportDiff diff;
  for (const auto& [name, now] : *new_verdicts) {
    const VerdictChange change{name, verdict_in(*old_verdicts, name), now};
    if (fails(now)) {
      if (!fails(change.before)) diff.broken.push_back(change);
    } else if (change.before.empty()) {
      diff.added.push_back(change);
    } else if (passes(now) && fails(change.before)) {
      diff.fixed.push_back(change);
    }
  }
  for (const auto& [name, was] : *old_verdicts) {
    const auto now = verdict_in(*new_verdicts, name);
    if (passes(was) && !passes(now) && !fails(now)) diff.lost.push_back({name, was, now});
  }
  return diff;
}

std::string to_text(const ReportDiff& diff) {
  return lines("fixed", diff.fixed) + lines("broken", diff.broken) + lines("new", diff.added) +
         lines("not run", diff.lost) +
         fmt::format("{} fixed, {} broken, {} new, {} not run any more\n", diff.fixed.size(),
                     diff.broken.size(), diff.added.size(), diff.lost.size());
}

}  // namespace armjig
