// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"
#include "harness/report/plot.hpp"
#include "harness/report/scene.hpp"
#include "harness/report/timeline.hpp"

namespace armjig {

/// How a check ended.
enum class Verdict : std::uint8_t {
  kPass,
  kDeviation,  ///< a known difference of the profile that was asked for
  kFail,
  kFlaky,         ///< not the same every time
  kSkipped,       ///< not run, for a reason
  kInconclusive,  ///< run, but it showed nothing
  kError,         ///< the rig, not the device
};
inline constexpr std::size_t kVerdictCount = 7;

[[nodiscard]] std::string_view to_string(Verdict verdict) noexcept;

/// How much a requirement binds.
enum class Level : std::uint8_t { kMust, kShould, kMay };

[[nodiscard]] std::string_view to_string(Level level) noexcept;

/// One check and what came of it. Any bytes may stand in the strings, a device may have sent them:
/// each form of the report makes them harmless and keeps them readable.
struct ReportRow {
  Verdict verdict{};
  std::string name;         ///< in words, dotted: device, topic, what; once in a report
  std::string summary;      ///< one sentence
  std::string requirement;  ///< the id of what was checked; empty: the row speaks for itself
  Level level{};            ///< of the requirement
  std::string demand;       ///< the requirement's sentence
  std::string source;       ///< where the requirement is written or seen
  std::string document{};   ///< the file that has it, from the root of its project; empty: none
  std::uint32_t line{};     ///< of the requirement in there, from 1; 0: not known
  std::string expected;
  std::string actual;    ///< what came instead, or why it was skipped or showed nothing
  std::string margin{};  ///< what was measured nearest to a bound, and the bounds; empty: nothing
  std::string evidence;  ///< several lines: the last messages, decoded
  std::string repeat;    ///< the command that does this again
  Duration duration{};   ///< zero: not measured
  /// Skipped because of what the run was told, or what its link or its hands cannot do.
  bool is_left_out = false;
  /// What stands together: a suite in JUnit, a part of the page. Empty: the name says it, with the
  /// first two words of three or more.
  std::string topic{};
};

/// A table as it is read: one cell a column, written out with its unit.
struct Table {
  std::vector<std::string> columns{};
  std::vector<std::vector<std::string>> rows{};
  /// As plots call it whose dots open its rows: letters, digits, hyphens, once in a report; empty:
  /// none does.
  std::string name{};
};

/// What was measured, as opposed to checked: words, a table, time lines, scenes, then plots, each
/// optional.
struct ReportSection {
  std::string title{};
  std::string text{};
  Table table{};
  std::vector<Plot> plots{};
  std::vector<Scene> scenes{};
  std::vector<Timeline> timelines{};
};

/// How much of what binds was judged, in requirements that a device must obey.
struct Coverage {
  std::size_t all{};            ///< of the profile
  std::size_t judged{};         ///< of these
  std::size_t within{};         ///< left by the run's options, its link and its hands
  std::size_t judged_within{};  ///< of these

  /// 1 if nothing is left.
  [[nodiscard]] double share() const noexcept {
    return within == 0 ? 1 : static_cast<double>(judged_within) / static_cast<double>(within);
  }
};

/// `53 of 90 must requirements (58 %); of the 60 within reach of this run 53 (88 %)`.
[[nodiscard]] std::string to_text(const Coverage& coverage);

/// A run. All forms of it are made from this.
struct Report {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  ///< target, profile, seed, versions
  std::vector<ReportRow> rows;
  std::vector<ReportSection> sections;
  std::optional<Coverage> coverage{};               ///< none: it was not about requirements
  std::optional<std::chrono::sys_seconds> started;  ///< wall clock; none in virtual time

  [[nodiscard]] std::array<std::size_t, kVerdictCount> counts() const noexcept;
  [[nodiscard]] std::size_t count(Verdict verdict) const noexcept;
};

/// What a whole run came to. The values are the exit codes of every program (docs/cli.md).
enum class Conclusion : std::uint8_t {
  kPassed = 0,    ///< at least one row passed or deviated as known, and nothing was found
  kFindings = 1,  ///< a row failed or is flaky
  kRig = 3,       ///< the rig stood in the way, or everything was inconclusive
  kNothing = 4,   ///< nothing ran
};

/// `passed`, `findings`, `rig` or `nothing`.
[[nodiscard]] std::string_view to_string(Conclusion conclusion) noexcept;

[[nodiscard]] Conclusion conclusion_of(const Report& report) noexcept;

/// Whether text may have colours. Words say the same without them. It is for the program to know
/// whether it writes to a terminal, and whether NO_COLOR is set.
enum class Style : std::uint8_t { kPlain, kColour };

/// `12 passed, 1 failed, 2 skipped`: only what there is, but always the first two.
[[nodiscard]] std::string counts_line(const Report& report, Style style = Style::kPlain);

/// For a terminal: a row is one line, and what it has to show below it unless it passed.
[[nodiscard]] std::string to_text(const ReportRow& row, Style style = Style::kPlain);
/// Words and table; a plot only by its title.
[[nodiscard]] std::string to_text(const ReportSection& section, Style style = Style::kPlain);
/// Title, facts, rows, sections and the line of counts.
[[nodiscard]] std::string to_text(const Report& report, Style style = Style::kPlain);

/// One JSON object of docs/schemas/report.schema.json, "armjig.report/1".
[[nodiscard]] std::string to_json(const Report& report);

/// JSON Lines as things happen, "armjig.report-row/1" (docs/schemas/report-row.schema.json): one
/// start with title and facts, one line for each row, one end with the counts.
[[nodiscard]] std::string to_jsonl_start(const Report& report);
[[nodiscard]] std::string to_jsonl(const ReportRow& row);
[[nodiscard]] std::string to_jsonl_end(const Report& report);

/// JUnit XML for CI systems, valid against tests/data/junit.xsd: a suite for each topic. Rows that
/// failed or were flaky are failures, trouble with the rig is an error, inconclusive is skipped.
[[nodiscard]] std::string to_junit(const Report& report);

/// SARIF 2.1.0 for code scanning: requirements are the rules, rows that failed, were flaky or
/// deviated the results, each at its requirement's line. A row without document is at line 1 of
/// armjig.sarif, the report's usual name. Trouble with the rig is a notification of the tool.
[[nodiscard]] std::string to_sarif(const Report& report);

/// One page that needs no network, with search, filters and plots.
[[nodiscard]] std::string to_html(const Report& report);

/// A form in which a report can be kept.
struct ReportForm {
  std::string_view name;  ///< of the option that asks for it
  std::string_view what;  ///< for people
  std::string (*text_of)(const Report& report);
};

/// All of them; nothing else lists them.
[[nodiscard]] std::span<const ReportForm> report_forms() noexcept;

/// Where a report is to be kept: paths by the names of their forms; an empty one is passed over.
using ReportFiles = std::map<std::string, std::string, std::less<>>;

/// Writes each form that has a path. Stops at the first problem.
[[nodiscard]] Outcome<void> write_files(const Report& report, const ReportFiles& files);

}  // namespace armjig
