// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/report/report.hpp"
#include "harness/report/wording.hpp"

namespace armjig {
namespace {

using Json = nlohmann::ordered_json;

constexpr auto kReportSchema = "armjig.report/1";
constexpr auto kRowSchema = "armjig.report-row/1";

/// Bytes that are no UTF-8 become U+FFFD; other than in the forms for people, control characters
/// stay what they are.
std::string dump(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + '\n';
}

Json facts_json(const Report& report) {
  Json facts = Json::object();
  for (const auto& [name, value] : report.facts) facts[name] = value;
  return facts;
}

Json counts_json(const Report& report) {
  Json json;
  const auto counts = report.counts();
  for (std::size_t v = 0; v < kVerdictCount; ++v) {
    json[std::string{to_string(Verdict(v))}] = counts[v];
  }
  return json;
}

void add_row(Json& json, const ReportRow& row) {
  const auto add = [&json](const char* key, std::string_view value) {
    if (!value.empty()) json[key] = value;
  };
  json["verdict"] = to_string(row.verdict);
  json["name"] = row.name;
  json["summary"] = row.summary;
  add("requirement", row.requirement);
  add("level", row.requirement.empty() ? "" : to_string(row.level));
  add("demand", row.demand);
  add("source", row.source);
  add("expected", row.expected);
  add("actual", row.actual);
  add("margin", row.margin);
  add("evidence", row.evidence);
  add("repeat", row.repeat);
  if (row.duration != Duration{}) json["duration_s"] = wording::seconds(row.duration);
}

/// JSON has no infinities; a gap is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string_view name_of(Shape shape) noexcept {
  constexpr std::array<std::string_view, 4> kNames{"line", "steps", "bars", "dots"};
  return kNames[static_cast<std::size_t>(shape)];
}

Json axis_json(const Axis& axis) {
  return {{"label", axis.label}, {"scale", axis.scale == Scale::kLog ? "log" : "linear"}};
}

Json plot_json(const Plot& plot) {
  Json json{{"title", plot.title}, {"x", axis_json(plot.x)}, {"y", axis_json(plot.y)}};
  json["series"] = Json::array();
  for (const auto& series : plot.series) {
    Json points = Json::array();
    for (const auto& [x, y] : series.points) points.push_back(Json::array({number(x), number(y)}));
    json["series"].push_back(
        {{"name", series.name}, {"shape", name_of(series.shape)}, {"points", std::move(points)}});
  }
  return json;
}

Json section_json(const ReportSection& section) {
  Json json{{"title", section.title}};
  if (!section.text.empty()) json["text"] = section.text;
  if (!section.table.columns.empty() || !section.table.rows.empty()) {
    json["table"] = {{"columns", section.table.columns}, {"rows", section.table.rows}};
  }
  if (!section.plots.empty()) json["plots"] = Json::array();
  for (const auto& plot : section.plots) json["plots"].push_back(plot_json(plot));
  return json;
}

Json event(const char* name) { return {{"schema", kRowSchema}, {"event", name}}; }

void add_start(Json& json, const Report& report) {
  json["title"] = report.title;
  if (report.started) json["started"] = wording::iso_time(*report.started) + 'Z';
  json["facts"] = facts_json(report);
}

void add_end(Json& json, const Report& report) {
  json["conclusion"] = to_string(conclusion_of(report));
  json["counts"] = counts_json(report);
  if (const auto& coverage = report.coverage) {
    json["coverage"] = {{"all", coverage->all},
                        {"judged", coverage->judged},
                        {"within", coverage->within},
                        {"judged_within", coverage->judged_within}};
  }
}

void add_sections(Json& json, const Report& report) {
  if (!report.sections.empty()) json["sections"] = Json::array();
  for (const auto& section : report.sections) json["sections"].push_back(section_json(section));
}

}  // namespace

std::string to_json(const Report& report) {
  Json json{{"schema", kReportSchema}};
  add_start(json, report);
  add_end(json, report);
  json["rows"] = Json::array();
  for (const auto& row : report.rows) add_row(json["rows"].emplace_back(Json::object()), row);
  add_sections(json, report);
  return dump(json, 2);
}

std::string to_jsonl_start(const Report& report) {
  auto json = event("start");
  add_start(json, report);
  return dump(json, -1);
}

std::string to_jsonl(const ReportRow& row) {
  auto json = event("row");
  add_row(json, row);
  return dump(json, -1);
}

std::string to_jsonl_end(const Report& report) {
  auto json = event("end");
  add_end(json, report);
  add_sections(json, report);
  return dump(json, -1);
}

}  // namespace armjig
