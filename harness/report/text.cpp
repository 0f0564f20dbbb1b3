// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "harness/report/failures.hpp"
#include "harness/report/report.hpp"
#include "harness/report/wording.hpp"

namespace armjig {
namespace {

constexpr auto kFaint = "2";
constexpr auto kBold = "1";

/// The parameter of an ANSI colour sequence.
constexpr std::string_view colour_of(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kPass:
      return "32";
    case Verdict::kFail:
    case Verdict::kFlaky:
      return "1;31";
    case Verdict::kError:
      return "1;35";
    case Verdict::kSkipped:
      return kFaint;
    case Verdict::kDeviation:
    case Verdict::kInconclusive:
      break;
  }
  return "33";
}

std::string painted(std::string_view text, std::string_view colour, Style style) {
  if (style == Style::kPlain) return std::string{text};
  return fmt::format("\x1b[{}m{}\x1b[0m", colour, text);
}

constexpr std::string_view word_of(Verdict verdict) noexcept {
  constexpr std::array<std::string_view, kVerdictCount> kWords{
      "PASS", "DEVIATION", "FAIL", "FLAKY", "SKIPPED", "INCONCLUSIVE", "ERROR"};
  return kWords[static_cast<std::size_t>(verdict)];
}

std::string padded(std::string_view printable, std::size_t width) {
  const auto used = wording::width_of(printable);
  return std::string{printable} + std::string(width > used ? width - used : 0, ' ');
}

std::string painted_word(Verdict verdict, Style style) {
  return painted(padded(word_of(verdict), 9), colour_of(verdict), style);
}

using Cells = std::vector<std::string>;

/// Without a line feed.
std::string table_line(const Cells& cells, const std::vector<std::size_t>& widths) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    text += (i == 0 ? "  " : "   ") + padded(wording::line(cells[i]), widths[i]);
  }
  return text.erase(text.find_last_not_of(' ') + 1);
}

std::string table_text(const Table& table, Style style) {
  if (table.columns.empty() && table.rows.empty()) return {};
  std::vector<std::size_t> widths;
  const auto widen = [&widths](const Cells& cells) {
    widths.resize(std::max(widths.size(), cells.size()));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      widths[i] = std::max(widths[i], wording::width_of(wording::line(cells[i])));
    }
  };
  widen(table.columns);
  std::ranges::for_each(table.rows, widen);
  auto text = painted(table_line(table.columns, widths), kFaint, style) + '\n';
  for (const auto& row : table.rows) text += table_line(row, widths) + '\n';
  return text;
}

}  // namespace

std::string counts_line(const Report& report, Style style) {
  std::string line;
  const auto say = [&](Verdict verdict) {
    const auto count = report.count(verdict);
    const auto words = wording::counted(count, verdict);
    if (!line.empty()) line += ", ";
    line += count > 0 ? painted(words, colour_of(verdict), style) : words;
  };
  say(Verdict::kPass);
  say(Verdict::kFail);
  for (const auto verdict : {Verdict::kFlaky, Verdict::kDeviation, Verdict::kSkipped,
                             Verdict::kInconclusive, Verdict::kError}) {
    if (report.count(verdict) > 0) say(verdict);
  }
  return line;
}

std::string to_text(const Coverage& coverage) {
  // Rounded down: only all of them are 100 %.
  const auto percent = [](std::size_t part, std::size_t whole) {
    return whole == 0 ? 100 : part * 100 / whole;
  };
  return fmt::format(
      "{} of {} must requirements ({} %); of the {} within reach of this run {} ({} %)",
      coverage.judged, coverage.all, percent(coverage.judged, coverage.all), coverage.within,
      coverage.judged_within, percent(coverage.judged_within, coverage.within));
}

std::string failures_text(const Report& report, Style style) {
  constexpr std::size_t kRoom = 100;
  std::string text;
  for (const auto& row : report.rows) {
    if (!wording::is_finding(row.verdict) && row.verdict != Verdict::kError) continue;
    auto wrong = wording::expected_and_actual(row);
    if (wording::width_of(wrong) > kRoom) wrong = wording::cut(wrong, kRoom - 4) + " ...";
    text += fmt::format("{} {} {}\n", painted_word(row.verdict, style),
                        padded(wording::line(row.name), 36), wrong);
  }
  return text;
}

std::string to_text(const ReportRow& row, Style style) {
  auto text = fmt::format("{} {} {}\n", painted_word(row.verdict, style),
                          padded(wording::line(row.name), 36), wording::line(row.summary));
  if (row.verdict != Verdict::kPass) text += wording::details_text(row, "          ");
  return text;
}

std::string to_text(const ReportSection& section, Style style) {
  auto text = painted(wording::line(section.title), kBold, style) + '\n';
  if (!section.text.empty()) text += wording::lines(section.text) + '\n';
  text += table_text(section.table, style);
  for (const auto& plot : section.plots) {
    text += fmt::format("  plot: {}\n", wording::line(plot.title));
  }
  return text;
}

std::string to_text(const Report& report, Style style) {
  auto text = painted(wording::line(report.title), kBold, style) + '\n';
  for (const auto& [name, value] : report.facts) {
    text += fmt::format("  {} {}\n", padded(wording::line(name), 12), wording::line(value));
  }
  if (!report.rows.empty()) text += '\n';
  for (const auto& row : report.rows) text += to_text(row, style);
  for (const auto& section : report.sections) text += '\n' + to_text(section, style);
  return text + '\n' + counts_line(report, style) + '\n';
}

}  // namespace armjig
