// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>

#include "harness/report/report.hpp"
#include "harness/report/wording.hpp"

namespace armjig {
namespace {

using wording::Rows;

std::string attribute(std::string_view text) { return wording::xml(wording::line(text)); }

std::ptrdiff_t count(const Rows& rows, std::initializer_list<Verdict> verdicts) {
  return std::ranges::count_if(rows, [&](const ReportRow* row) {
    return std::ranges::find(verdicts, row->verdict) != verdicts.end();
  });
}

/// The attributes that a suite and the whole have in common.
std::string counts_of(const Rows& rows) {
  Duration time{};
  for (const auto* row : rows) time += row->duration;
  return fmt::format(R"(tests="{}" failures="{}" errors="{}" time="{:.3f}")", rows.size(),
                     count(rows, {Verdict::kFail, Verdict::kFlaky}), count(rows, {Verdict::kError}),
                     wording::seconds(time));
}

/// What stands inside a test case: nothing says that it passed.
std::string outcome_of(const ReportRow& row) {
  const auto element = [&row](const char* name) {
    auto message = wording::expected_and_actual(row);
    if (message.empty()) message = wording::line(row.summary);
    return fmt::format("      <{0} type=\"{1}\" message=\"{2}\">{3}\n{4}</{0}>\n", name,
                       to_string(row.verdict), attribute(message), attribute(row.summary),
                       wording::xml(wording::details_text(row, "")));
  };
  switch (row.verdict) {
    case Verdict::kFail:
    case Verdict::kFlaky:
      return element("failure");
    case Verdict::kError:
      return element("error");
    case Verdict::kSkipped:
    case Verdict::kInconclusive:
      return fmt::format("      <skipped message=\"{}: {}\"/>\n", to_string(row.verdict),
                         attribute(row.actual));
    case Verdict::kDeviation:
      return fmt::format("      <system-out>known deviation: {}\n{}</system-out>\n",
                         attribute(row.summary), wording::xml(wording::details_text(row, "")));
    case Verdict::kPass:
      break;
  }
  return {};
}

std::string case_xml(const ReportRow& row, std::string_view topic) {
  const auto outcome = outcome_of(row);
  const auto head =
      fmt::format(R"(    <testcase classname="{}" name="{}" time="{:.3f}")", attribute(topic),
                  attribute(row.name), wording::seconds(row.duration));
  return outcome.empty() ? head + "/>\n" : head + ">\n" + outcome + "    </testcase>\n";
}

std::string suite_xml(const Report& report, const wording::Topic& topic) {
  auto text = fmt::format(R"(  <testsuite name="{}" {} skipped="{}")", attribute(topic.name),
                          counts_of(topic.rows),
                          count(topic.rows, {Verdict::kSkipped, Verdict::kInconclusive}));
  if (report.started) text += fmt::format(R"( timestamp="{}")", wording::iso_time(*report.started));
  text += ">\n";
  if (!report.facts.empty()) {
    text += "    <properties>\n";
    for (const auto& [name, value] : report.facts) {
      text += fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", attribute(name),
                          attribute(value));
    }
    text += "    </properties>\n";
  }
  for (const auto* row : topic.rows) text += case_xml(*row, topic.name);
  return text + "  </testsuite>\n";
}

}  // namespace

std::string to_junit(const Report& report) {
  Rows all;
  for (const auto& row : report.rows) all.push_back(&row);
  auto text =
      fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"{}\" {}>\n",
                  attribute(report.title), counts_of(all));
  for (const auto& topic : wording::topics_of(report)) text += suite_xml(report, topic);
  return text + "</testsuites>\n";
}

}  // namespace armjig
