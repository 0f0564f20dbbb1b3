// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "cli/device_console.hpp"

/// Commands that a person types, as a table: what they are called, what they need, what they do.
namespace armjig::cli {

using Words = std::span<const std::string_view>;

/// Whether the words could be read; if not, a sentence that says why, or an empty one.
using Read = tl::expected<void, std::string>;

[[nodiscard]] inline auto wrong(std::string text) { return tl::unexpected{std::move(text)}; }

/// When a command may be given.
enum class When : std::uint8_t {
  kAlways,
  kAlone,  ///< not while another one goes on
};

template <class Console>
struct CommandRow {
  std::string_view name;
  std::string_view arguments;
  std::string_view help;
  When when{};
  Read (Console::*run)(Words words);
  std::string_view completions;  ///< words for one place, `|`, words for the next
};

/// The pieces between any of `separators`, empty ones left out.
[[nodiscard]] inline std::vector<std::string_view> split(std::string_view text,
                                                         std::string_view separators) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const auto end = text.find_first_of(separators);
    if (end != 0) words.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return words;
}

/// The words of a command, without a comment.
[[nodiscard]] inline std::vector<std::string_view> words_of(std::string_view line) {
  return split(line.substr(0, line.find('#')), " \t\r");
}

template <class Console>
[[nodiscard]] const CommandRow<Console>* find_row(std::span<const CommandRow<Console>> rows,
                                                  std::string_view name) noexcept {
  for (const auto& row : rows) {
    if (row.name == (name == "exit" ? "quit" : name)) return &row;
  }
  return nullptr;
}

template <class Console>
[[nodiscard]] std::string call_of(const CommandRow<Console>& row) {
  return row.arguments.empty() ? std::string{row.name}
                               : fmt::format("{} {}", row.name, row.arguments);
}

/// A line for each command, or for the one of that name; empty if there is none.
template <class Console>
[[nodiscard]] std::string help_text(std::span<const CommandRow<Console>> rows,
                                    std::string_view name) {
  constexpr std::size_t kColumn = 26;
  std::string text;
  for (const auto& row : rows) {
    if (!name.empty() && row.name != name) continue;
    const auto call = call_of(row);
    const auto* const gap = call.size() < kColumn ? "" : "\n";
    text += fmt::format("{}{}{}{:>{}}{}", text.empty() ? "" : "\n", call, gap, "",
                        kColumn - (call.size() < kColumn ? call.size() : 0), row.help);
  }
  return text;
}

/// What may stand at the end of the line.
template <class Console>
[[nodiscard]] std::vector<std::string> candidates_in(std::span<const CommandRow<Console>> rows,
                                                     std::string_view line) {
  const bool is_new_word = line.empty() || line.ends_with(' ');
  const auto words = split(line, " \t");
  const auto place = words.size() - (is_new_word ? 0 : 1);
  std::vector<std::string> found;
  if (place == 0 || (place == 1 && words.front() == "help")) {
    for (const auto& row : rows) found.emplace_back(row.name);
    return found;
  }
  const auto* const row = find_row(rows, words.front());
  if (row == nullptr) return found;
  const auto places = split(row->completions, "|");
  if (place > places.size()) return found;
  for (const auto word : split(places[place - 1], " ")) found.emplace_back(word);
  return found;
}

/// Runs the command of the line, unless it is blank. `complain(tone, text)` is told why not.
template <class Console, class Complain>
void run_command(Console& console, std::span<const CommandRow<Console>> rows, std::string_view line,
                 const std::string& going_on, Complain&& complain) {
  const auto words = words_of(line);
  if (words.empty()) return;
  const auto* const row = find_row(rows, words.front());
  if (row == nullptr) {
    return complain(Tone::kUnreadable,
                    fmt::format("there is no command '{}'; 'help' lists them", words.front()));
  }
  if (row->when == When::kAlone && !going_on.empty()) {
    return complain(Tone::kFailed, fmt::format("{} is still going on; 'stop' ends it", going_on));
  }
  const auto read = (console.*row->run)(Words{words}.subspan(1));
  if (read) return;
  const auto reason = read.error().empty() ? "" : read.error() + "; ";
  complain(Tone::kUnreadable, fmt::format("{}usage: {}", reason, call_of(*row)));
}

}  // namespace armjig::cli
