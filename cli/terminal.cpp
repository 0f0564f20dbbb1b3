// SPDX-License-Identifier: Apache-2.0
#include "cli/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "cli/choice.hpp"
#include "cli/environment.hpp"
#include "harness/core/number.hpp"

namespace armjig::cli {
namespace {

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

bool is_prose(std::string_view line) {
  constexpr std::size_t kLeast = 50;  // shorter ones end where they should
  return line.size() >= kLeast && line.front() != ' ';
}

/// Lines that were one before somebody broke them by hand.
std::vector<std::string> joined(const std::vector<std::string>& lines) {
  std::vector<std::string> out;
  bool goes_on = false;
  for (const auto& line : lines) {
    if (goes_on && !line.empty() && line.front() != ' ') {
      out.back() += ' ' + line;
    } else {
      out.push_back(line);
    }
    goes_on = is_prose(line) && !line.ends_with('.') && !line.ends_with(':');
  }
  return out;
}

/// A line, and how far what goes on of it is indented.
struct Line {
  std::string text;
  std::size_t indent;
};

/// What goes on stands below the last column of a table. A column that begins too far to the right
/// becomes a line of its own first.
std::vector<Line> columns_of(const std::string& line, std::size_t width) {
  constexpr std::size_t kFurther = 4;
  const auto own = line.find_first_not_of(' ');
  const auto gap = line.rfind("  ");
  if (line.size() <= width || gap == std::string::npos || gap < own) {
    return {{line, std::min(own, line.size())}};
  }
  const auto begin = line.find_first_not_of(' ', gap);
  if (begin == std::string::npos) return {{line, own}};
  if (begin <= width / 2) return {{line, begin}};
  const auto end = line.find_last_not_of(' ', gap) + 1;
  const std::string margin(own + kFurther, ' ');
  return {{line.substr(0, end), margin.size()}, {margin + line.substr(begin), margin.size()}};
}

std::string wrapped_line(Line line, std::size_t width) {
  auto& [text, indent] = line;
  std::string out;
  while (text.size() > width) {
    auto end = text.rfind(' ', width);
    if (end == std::string::npos || end <= indent) end = text.find(' ', width);
    if (end == std::string::npos) break;
    const auto rest = text.find_first_not_of(' ', end);
    if (rest == std::string::npos) break;
    out += text.substr(0, text.find_last_not_of(' ', end) + 1) + '\n';
    text = std::string(indent, ' ') + text.substr(rest);
  }
  return out + text + '\n';
}

}  // namespace

void add_colour_option(CLI::App& command, std::string& when) {
  when = "auto";
  command.add_option("--color", when, "colours: auto is on a terminal, unless NO_COLOR is set")
      ->check(one_of({"auto", "always", "never"}));
}

Style style_of(std::string_view when, std::FILE* stream) {
  // The streams stand before the descriptors and have none of their own (cli/outputs.hpp).
  const auto descriptor = stream == stderr ? STDERR_FILENO : STDOUT_FILENO;
  const bool is_liked =
      environment("NO_COLOR").empty() && environment("TERM") != "dumb" && ::isatty(descriptor) == 1;
  return when == "always" || (when == "auto" && is_liked) ? Style::kColour : Style::kPlain;
}

std::size_t help_width() {
  constexpr std::size_t kLeast = 60;
  constexpr std::size_t kDefault = 80;
  std::size_t width = whole_text_as<std::size_t>(environment("COLUMNS")).value_or(0);
  winsize size{};
  if (width == 0 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) width = size.ws_col;
  return width == 0 ? kDefault : std::max(width, kLeast);
}

std::string wrapped(std::string_view text, std::size_t width) {
  std::string out;
  for (const auto& line : joined(lines_of(text))) {
    for (const auto& column : columns_of(line, width)) out += wrapped_line(column, width);
  }
  return out;
}

}  // namespace armjig::cli
