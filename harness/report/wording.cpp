// SPDX-License-Identifier: Apache-2.0
#include "harness/report/wording.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <utf8.h>

#include <algorithm>
#include <array>
#include <kainjow/mustache.hpp>

namespace armjig::wording {
namespace {

/// Controls, C1 too, which some terminals obey, and the two characters that XML forbids.
bool is_forbidden(char32_t character) noexcept {
  return character < 0x20 || (character >= 0x7F && character <= 0x9F) || character == 0xFFFE ||
         character == 0xFFFF;
}

std::string escaped(std::string_view bytes) {
  std::string out;
  for (const char c : bytes) {
    switch (c) {
      case '\n':
        out += "\\n";
        break;
      case '\r':
        out += "\\r";
        break;
      case '\t':
        out += "\\t";
        break;
      default:
        out += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
    }
  }
  return out;
}

enum class Breaks : std::uint8_t { kShown, kKept };

std::string printable(std::string_view text, Breaks breaks) {
  std::string out;
  out.reserve(text.size());
  const auto* place = text.begin();
  while (place != text.end()) {
    const auto* const bad = utf8::find_invalid(place, text.end());
    while (place != bad) {
      const auto* const begin = place;
      const auto character = utf8::unchecked::next(place);
      const bool is_break = character == '\n' || character == '\t';
      const bool is_kept = is_break ? breaks == Breaks::kKept : !is_forbidden(character);
      out += is_kept ? std::string{begin, place} : escaped({begin, place});
    }
    if (bad != text.end()) out += escaped({place++, 1});
  }
  return out;
}

std::string_view topic_of(const ReportRow& row) noexcept {
  if (!row.topic.empty()) return row.topic;
  const std::string_view name = row.name;
  const auto first = name.find('.');
  if (first == std::string_view::npos) return name;
  const auto second = name.find('.', first + 1);
  return name.substr(0, second == std::string_view::npos ? first : second);
}

}  // namespace

std::string line(std::string_view text) { return printable(text, Breaks::kShown); }

std::string lines(std::string_view text) { return printable(text, Breaks::kKept); }

std::size_t width_of(std::string_view printable) noexcept {
  return static_cast<std::size_t>(utf8::unchecked::distance(printable.begin(), printable.end()));
}

std::string cut(std::string_view printable, std::size_t width) {
  const auto* end = printable.begin();
  for (; width > 0 && end != printable.end(); --width) utf8::unchecked::next(end);
  return {printable.begin(), end};
}

std::string html(std::string_view text) { return kainjow::mustache::html_escape(lines(text)); }

std::string counted(std::size_t count, Verdict verdict) {
  constexpr std::array<std::string_view, kVerdictCount> kWords{
      "passed", "deviated", "failed", "flaky", "skipped", "inconclusive", "error"};
  const bool has_plural = verdict == Verdict::kError && count != 1;
  return fmt::format("{} {}{}", count, kWords[static_cast<std::size_t>(verdict)],
                     has_plural ? "s" : "");
}

bool is_finding(Verdict verdict) noexcept {
  return verdict == Verdict::kFail || verdict == Verdict::kFlaky;
}

bool is_reason(Verdict verdict) noexcept {
  return verdict == Verdict::kSkipped || verdict == Verdict::kInconclusive;
}

std::vector<Topic> topics_of(const Report& report) {
  std::vector<Topic> topics;
  for (const auto& row : report.rows) {
    const auto name = topic_of(row);
    auto topic = std::ranges::find(topics, name, &Topic::name);
    if (topic == topics.end()) topic = topics.insert(topic, Topic{name, {}});
    topic->rows.push_back(&row);
  }
  return topics;
}

std::vector<Detail> details_of(const ReportRow& row) {
  std::vector<Detail> details;
  const auto add = [&details](std::string_view label, std::string_view text) {
    if (!text.empty()) details.push_back({label, line(text)});
  };
  if (!row.requirement.empty()) {
    add("requirement",
        fmt::format("{} ({}): {}", row.requirement, armjig::to_string(row.level), row.demand));
  }
  add("source", row.source);
  add("expected", row.expected);
  add(is_reason(row.verdict) ? "reason" : "got", row.actual);
  add("margin", row.margin);
  return details;
}

std::string details_text(const ReportRow& row, std::string_view margin) {
  std::string text;
  const auto add = [&](std::string_view label, std::string_view content) {
    text += fmt::format("{}{:<12} {}\n", margin, label, content);
  };
  for (const auto& [label, content] : details_of(row)) add(label, content);
  if (!row.evidence.empty()) text += fmt::format("{}last exchange\n", margin);
  const auto evidence = lines(row.evidence);
  for (std::string_view rest = evidence; !rest.empty();) {
    const auto end = std::min(rest.find('\n'), rest.size());
    text += fmt::format("{}  {}\n", margin, rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (!row.repeat.empty()) add("again", line(row.repeat));
  return text;
}

std::string expected_and_actual(const ReportRow& row) {
  if (row.expected.empty()) return line(row.actual);
  if (row.actual.empty()) return fmt::format("expected {}", line(row.expected));
  return fmt::format("expected {}; got {}", line(row.expected), line(row.actual));
}

std::string iso_time(std::chrono::sys_seconds time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(time.time_since_epoch().count()));
}

double seconds(Duration duration) noexcept {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace armjig::wording
