// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_map>

#include "harness/core/version.hpp"
#include "harness/report/report.hpp"
#include "harness/report/wording.hpp"

namespace armjig {
namespace {

using Json = nlohmann::ordered_json;

std::string_view level_of(Level level) noexcept {
  switch (level) {
    case Level::kMust:
      return "error";
    case Level::kShould:
      return "warning";
    case Level::kMay:
      break;
  }
  return "note";
}

/// A known difference is worth a note, whatever the requirement says.
std::string_view level_of(const ReportRow& row) noexcept {
  return row.verdict == Verdict::kDeviation ? "note" : level_of(row.level);
}

std::string_view rule_id(const ReportRow& row) noexcept {
  return row.requirement.empty() ? row.name : row.requirement;
}

/// Where rows without a document point to: code scanning refuses results without a file.
constexpr std::string_view kReport = "armjig.sarif";

Json place_of(const ReportRow& row) {
  const auto uri = row.document.empty() ? kReport : std::string_view{row.document};
  return {{"artifactLocation", {{"uri", uri}}},
          {"region", {{"startLine", std::max(row.line, 1U)}}}};
}

std::string help_of(const ReportRow& row) {
  auto help = "Source: " + row.source;
  if (row.line > 0) help += fmt::format(" ({}, line {})", row.document, row.line);
  return help;
}

Json message(std::string_view text) { return {{"text", text}}; }

/// The requirements of all rows, passed ones too, each once.
class Rules {
 public:
  explicit Rules(const Report& report) {
    for (const auto& row : report.rows) add(row);
  }

  [[nodiscard]] std::size_t index_of(const ReportRow& row) const {
    return indices_.at(rule_id(row));
  }
  [[nodiscard]] const Json& json() const noexcept { return json_; }

 private:
  void add(const ReportRow& row) {
    const bool is_rig = row.verdict == Verdict::kError && row.requirement.empty();
    if (is_rig) return;
    const auto id = rule_id(row);
    if (!indices_.emplace(id, json_.size()).second) return;
    Json rule{{"id", id},
              {"shortDescription", message(row.demand.empty() ? row.summary : row.demand)},
              {"defaultConfiguration", {{"level", level_of(row.level)}}}};
    if (!row.source.empty()) rule["help"] = message(help_of(row));
    if (!row.requirement.empty()) rule["properties"]["level"] = to_string(row.level);
    json_.push_back(std::move(rule));
  }

  std::unordered_map<std::string_view, std::size_t> indices_;  ///< points into the report
  Json json_ = Json::array();
};

Json result(const ReportRow& row, std::size_t rule_index) {
  const auto what = wording::expected_and_actual(row);
  const auto text = wording::line(row.summary) + (what.empty() ? "" : " (" + what + ")");
  Json json{{"ruleId", rule_id(row)},
            {"ruleIndex", rule_index},
            {"level", level_of(row)},
            {"message", message(text)}};
  Json location{{"physicalLocation", place_of(row)}};
  location["logicalLocations"] =
      Json::array({Json{{"fullyQualifiedName", row.name}, {"kind", "case"}}});
  json["locations"] = Json::array({std::move(location)});
  json["partialFingerprints"]["armjigCase/v1"] = row.name;
  auto& properties = json["properties"];
  properties["verdict"] = to_string(row.verdict);
  const auto add = [&properties](const char* key, std::string_view value) {
    if (!value.empty()) properties[key] = value;
  };
  add("expected", row.expected);
  add("actual", row.actual);
  add("evidence", row.evidence);
  add("repeat", row.repeat);
  return json;
}

Json invocation(const Report& report) {
  Json json{{"executionSuccessful", report.count(Verdict::kError) == 0},
            {"exitCode", static_cast<int>(conclusion_of(report))}};
  if (report.started) json["startTimeUtc"] = wording::iso_time(*report.started) + 'Z';
  json["toolExecutionNotifications"] = Json::array();
  for (const auto& row : report.rows) {
    if (row.verdict != Verdict::kError) continue;
    const auto text = fmt::format("{}: {} ({})", wording::line(row.name),
                                  wording::line(row.summary), wording::expected_and_actual(row));
    json["toolExecutionNotifications"].push_back({{"level", "error"}, {"message", message(text)}});
  }
  return json;
}

}  // namespace

std::string to_sarif(const Report& report) {
  const Rules rules{report};
  Json results = Json::array();
  for (const auto& row : report.rows) {
    const bool is_result = wording::is_finding(row.verdict) || row.verdict == Verdict::kDeviation;
    if (is_result) results.push_back(result(row, rules.index_of(row)));
  }
  Json run;
  run["tool"]["driver"] = {{"name", "armjig"}, {"version", kVersion}, {"rules", rules.json()}};
  run["invocations"] = Json::array({invocation(report)});
  run["results"] = std::move(results);
  run["properties"]["title"] = report.title;
  for (const auto& [name, value] : report.facts) run["properties"]["facts"][name] = value;
  const Json json{{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                  {"version", "2.1.0"},
                  {"runs", Json::array({std::move(run)})}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace armjig
