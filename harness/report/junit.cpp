// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <initializer_list>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <string_view>

#include "harness/report/report.hpp"
#include "harness/report/wording.hpp"

namespace armjig {
namespace {

using pugi::xml_node;
using wording::Rows;

/// XML has no escapes for what `wording::line` replaces.
void set(xml_node node, const char* name, std::string_view text) {
  node.append_attribute(name).set_value(wording::line(text).c_str());
}

void set_time(xml_node node, Duration time) {
  set(node, "time", fmt::format("{:.3f}", wording::seconds(time)));
}

std::string count(const Rows& rows, std::initializer_list<Verdict> verdicts) {
  return std::to_string(std::ranges::count_if(rows, [&](const ReportRow* row) {
    return std::ranges::find(verdicts, row->verdict) != verdicts.end();
  }));
}

/// The attributes that a suite and the whole have in common.
void set_counts(xml_node node, const Rows& rows) {
  Duration time{};
  for (const auto* row : rows) time += row->duration;
  set(node, "tests", std::to_string(rows.size()));
  set(node, "failures", count(rows, {Verdict::kFail, Verdict::kFlaky}));
  set(node, "errors", count(rows, {Verdict::kError}));
  set_time(node, time);
}

void set_text(xml_node node, std::string_view summary, const ReportRow& row) {
  const auto text = fmt::format("{}\n{}", summary, wording::details_text(row, ""));
  node.text().set(text.c_str());
}

void add_problem(xml_node one, const char* name, const ReportRow& row) {
  auto node = one.append_child(name);
  const auto message = wording::expected_and_actual(row);
  set(node, "type", to_string(row.verdict));
  set(node, "message", message.empty() ? row.summary : message);
  set_text(node, wording::line(row.summary), row);
}

/// What stands inside a test case: nothing says that it passed.
void add_outcome(xml_node one, const ReportRow& row) {
  switch (row.verdict) {
    case Verdict::kFail:
    case Verdict::kFlaky:
      return add_problem(one, "failure", row);
    case Verdict::kError:
      return add_problem(one, "error", row);
    case Verdict::kSkipped:
    case Verdict::kInconclusive:
      return set(one.append_child("skipped"), "message",
                 fmt::format("{}: {}", to_string(row.verdict), row.actual));
    case Verdict::kDeviation:
      return set_text(one.append_child("system-out"),
                      "known deviation: " + wording::line(row.summary), row);
    case Verdict::kPass:
      break;
  }
}

void add_case(xml_node suite, const ReportRow& row, std::string_view topic) {
  auto one = suite.append_child("testcase");
  set(one, "classname", topic);
  set(one, "name", row.name);
  set_time(one, row.duration);
  add_outcome(one, row);
}

void add_suite(xml_node all, const Report& report, const wording::Topic& topic) {
  auto suite = all.append_child("testsuite");
  set(suite, "name", topic.name);
  set_counts(suite, topic.rows);
  set(suite, "skipped", count(topic.rows, {Verdict::kSkipped, Verdict::kInconclusive}));
  if (report.started) set(suite, "timestamp", wording::iso_time(*report.started));
  if (!report.facts.empty()) suite.append_child("properties");
  for (const auto& [name, value] : report.facts) {
    auto property = suite.child("properties").append_child("property");
    set(property, "name", name);
    set(property, "value", value);
  }
  for (const auto* row : topic.rows) add_case(suite, *row, topic.name);
}

}  // namespace

std::string to_junit(const Report& report) {
  Rows rows;
  for (const auto& row : report.rows) rows.push_back(&row);
  pugi::xml_document document;
  auto declaration = document.append_child(pugi::node_declaration);
  set(declaration, "version", "1.0");
  set(declaration, "encoding", "UTF-8");
  auto all = document.append_child("testsuites");
  set(all, "name", report.title);
  set_counts(all, rows);
  for (const auto& topic : wording::topics_of(report)) add_suite(all, report, topic);
  std::ostringstream out;
  document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  return std::move(out).str();
}

}  // namespace armjig
