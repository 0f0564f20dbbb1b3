// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/report/report.hpp"

/// What the forms of a report have in common. Nothing here is for users of the library.
namespace armjig::wording {

/// The text as valid UTF-8 without control characters: harmless in a terminal and legal in XML.
/// Bytes that cannot stay are written `\n` or `\x1B`.
[[nodiscard]] std::string line(std::string_view text);
[[nodiscard]] std::string lines(std::string_view text);  ///< line feeds and tabs stay

/// The columns that printable text takes, if every character is as wide as a letter.
[[nodiscard]] std::size_t width_of(std::string_view printable) noexcept;

/// As many whole characters from its beginning as fit in `width` columns.
[[nodiscard]] std::string cut(std::string_view printable, std::size_t width);

/// `lines` with `&`, `<`, `>` and quotes escaped, for element content and quoted attributes.
[[nodiscard]] std::string html(std::string_view text);

/// `3 passed`, `1 error`.
[[nodiscard]] std::string counted(std::size_t count, Verdict verdict);

/// Whether somebody has to do something about the device.
[[nodiscard]] bool is_finding(Verdict verdict) noexcept;

using Rows = std::vector<const ReportRow*>;

/// Rows of one topic, or whose names begin alike: with device and topic, the first two words of
/// three or more, or else with the first word.
struct Topic {
  std::string_view name;
  Rows rows;
};

/// In the order in which the topics come up. Points into the report.
[[nodiscard]] std::vector<Topic> topics_of(const Report& report);

/// Whether `actual` says why, not what.
[[nodiscard]] bool is_reason(Verdict verdict) noexcept;

struct Detail {
  std::string_view label;
  std::string text;  ///< one printable line
};

/// Requirement, source, expected and got, without what is empty.
[[nodiscard]] std::vector<Detail> details_of(const ReportRow& row);

/// All that a row has to show beside its summary, in lines begun with `margin`.
[[nodiscard]] std::string details_text(const ReportRow& row, std::string_view margin);

/// `expected X; got Y`, or as much of it as there is.
[[nodiscard]] std::string expected_and_actual(const ReportRow& row);

/// `2026-11-21T08:35:28`, UTC.
[[nodiscard]] std::string iso_time(std::chrono::sys_seconds time);

[[nodiscard]] double seconds(Duration duration) noexcept;

}  // namespace armjig::wording
