// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <kainjow/mustache.hpp>
#include <string>
#include <vector>

#include "harness/core/version.hpp"
#include "harness/report/page.hpp"
#include "harness/report/report.hpp"
#include "harness/report/wording.hpp"

namespace armjig {
namespace {

using kainjow::mustache::data;
using kainjow::mustache::list;
using kainjow::mustache::mustache;
using wording::line;
using wording::lines;

/// Evidence of more lines than a screen has is folded away.
constexpr std::ptrdiff_t kShortEvidence = 24;

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string sentence(const Report& report) {
  switch (conclusion_of(report)) {
    case Conclusion::kPassed:
      return "Passed";
    case Conclusion::kFindings:
      return counted(report.count(Verdict::kFail) + report.count(Verdict::kFlaky), "finding",
                     "findings");
    case Conclusion::kRig:
      return report.count(Verdict::kError) > 0 ? "The rig got in the way" : "Nothing was shown";
    case Conclusion::kNothing:
      break;
  }
  return "Nothing ran";
}

/// The verdict whose colour the whole has.
Verdict colour_of(const Report& report) {
  switch (conclusion_of(report)) {
    case Conclusion::kPassed:
      return Verdict::kPass;
    case Conclusion::kFindings:
      return Verdict::kFail;
    case Conclusion::kRig:
      return Verdict::kError;
    case Conclusion::kNothing:
      break;
  }
  return Verdict::kSkipped;
}

std::string time_text(Duration duration) {
  const double seconds = wording::seconds(duration);
  if (duration == Duration{}) return {};
  if (seconds < 1e-3) return fmt::format("{:.0f} µs", seconds * 1e6);
  return seconds < 1 ? fmt::format("{:.0f} ms", seconds * 1e3) : fmt::format("{:.2f} s", seconds);
}

data text_data(const char* key, std::string_view text) {
  data entry;
  entry.set(key, lines(text));
  return entry;
}

data evidence_data(const std::string& evidence) {
  auto entry = text_data("text", evidence);
  const auto count = std::ranges::count(evidence, '\n') + (evidence.ends_with('\n') ? 0 : 1);
  entry.set("lines", counted(static_cast<std::size_t>(count), "line", "lines"));
  entry.set("is_short", count <= kShortEvidence);
  return entry;
}

/// Whether somebody has to look at it.
bool is_open(const ReportRow& row) {
  return wording::is_finding(row.verdict) || row.verdict == Verdict::kError;
}

data row_data(const ReportRow& row) {
  list details;
  for (const auto& [label, text] : wording::details_of(row)) {
    auto& entry = details.emplace_back();
    entry.set("label", std::string{label});
    entry.set("text", text);
  }
  data entry;
  entry.set("verdict", std::string{to_string(row.verdict)});
  entry.set("name", line(row.name));
  entry.set("summary", line(row.summary));
  const bool has_reason = wording::is_reason(row.verdict) && !row.actual.empty();
  entry.set("reason", has_reason ? text_data("text", row.actual) : data{false});
  entry.set("time", time_text(row.duration));
  entry.set("is_open", is_open(row));
  entry.set("has_details", !details.empty());
  entry.set("details", details);
  entry.set("evidence", row.evidence.empty() ? data{false} : evidence_data(row.evidence));
  entry.set("repeat", row.repeat.empty() ? data{false} : text_data("text", row.repeat));
  return entry;
}

data topic_data(const wording::Topic& topic) {
  const auto passed = std::ranges::count(topic.rows, Verdict::kPass,
                                         [](const ReportRow* row) { return row->verdict; });
  list rows;
  for (const auto* row : topic.rows) rows.push_back(row_data(*row));
  data entry;
  entry.set("name", line(topic.name));
  entry.set("counts", fmt::format("{} of {} passed", passed, topic.rows.size()));
  entry.set("rows", rows);
  return entry;
}

/// What somebody has to look at comes first, of topics and of the rows in each.
std::vector<wording::Topic> sorted_topics(const Report& report) {
  auto topics = wording::topics_of(report);
  const auto is_open_row = [](const ReportRow* row) { return is_open(*row); };
  for (auto& topic : topics) std::ranges::stable_partition(topic.rows, is_open_row);
  std::ranges::stable_partition(
      topics, [&](const wording::Topic& topic) { return is_open_row(topic.rows.front()); });
  return topics;
}

list shares_data(const Report& report) {
  list shares;
  for (const auto verdict :
       {Verdict::kFail, Verdict::kFlaky, Verdict::kError, Verdict::kInconclusive,
        Verdict::kDeviation, Verdict::kSkipped, Verdict::kPass}) {
    const auto count = report.count(verdict);
    if (count == 0) continue;
    auto& share = shares.emplace_back();
    share.set("verdict", std::string{to_string(verdict)});
    share.set("count", std::to_string(count));
    share.set("counted", wording::counted(count, verdict));
  }
  return shares;
}

/// Numbers are read from the right.
bool is_number_column(const Table& table, std::size_t column) {
  const auto is_number = [column](const auto& cells) {
    if (column >= cells.size() || cells[column].empty()) return true;
    const auto first = cells[column].find_first_of("0123456789");
    return first == cells[column].find_first_not_of("+-.<>~");
  };
  return !table.rows.empty() && std::ranges::all_of(table.rows, is_number);
}

list cells_data(const Table& table, const std::vector<std::string>& cells) {
  list entries;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    auto entry = text_data("cell", cells[i]);
    entry.set("is_number", is_number_column(table, i));
    entries.push_back(entry);
  }
  return entries;
}

data section_data(const ReportSection& section, std::size_t number) {
  list plots;
  for (const auto& line : section.timelines) plots.emplace_back().set("figure", to_figure(line));
  for (const auto& scene : section.scenes) plots.emplace_back().set("figure", to_figure(scene));
  for (const auto& plot : section.plots) plots.emplace_back().set("figure", to_figure(plot));
  list table_lines;
  for (const auto& cells : section.table.rows) {
    auto& entry = table_lines.emplace_back();
    entry.set("cells", cells_data(section.table, cells));
    entry.set("id", section.table.name.empty()
                        ? data{false}
                        : data{fmt::format("{}-{}", section.table.name, table_lines.size())});
  }
  data entry;
  entry.set("number", std::to_string(number));
  entry.set("title", line(section.title));
  entry.set("text", section.text.empty() ? data{false} : text_data("text", section.text));
  entry.set("has_table", !section.table.columns.empty() || !table_lines.empty());
  entry.set("columns", cells_data(section.table, section.table.columns));
  entry.set("lines", table_lines);
  entry.set("plots", plots);
  return entry;
}

}  // namespace

std::string to_html(const Report& report) {
  data view;
  view.set("style", std::string{page::kStyle});
  view.set("script", std::string{page::kScript});
  view.set("script_hash", std::string{page::kScriptHash});
  view.set("version", kVersion);
  view.set("title", line(report.title));
  view.set("headline", report.rows.empty() ? std::string{} : sentence(report) + " - ");
  view.set("conclusion", sentence(report));
  view.set("outcome", std::string{to_string(colour_of(report))});
  view.set("counts", counts_line(report));
  view.set("shares", shares_data(report));
  if (report.started) view.set("started", wording::iso_time(*report.started));
  list facts;
  for (const auto& [name, value] : report.facts) {
    auto& fact = facts.emplace_back();
    fact.set("name", line(name));
    fact.set("value", line(value));
  }
  view.set("facts", facts);
  view.set("has_rows", !report.rows.empty());
  list topics;
  for (const auto& topic : sorted_topics(report)) topics.push_back(topic_data(topic));
  view.set("topics", topics);
  list sections;
  for (const auto& section : report.sections) {
    sections.push_back(section_data(section, sections.size() + 1));
  }
  view.set("has_jumps", sections.size() + (report.rows.empty() ? 0 : 1) > 1);
  view.set("sections", sections);
  mustache page{page::kTemplate};
  return page.render(view);
}

}  // namespace armjig
