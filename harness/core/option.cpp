// SPDX-License-Identifier: Apache-2.0
#include "harness/core/option.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "harness/core/nearest.hpp"
#include "harness/core/number.hpp"

namespace armjig {
namespace {

constexpr std::string_view kDots = "..";
constexpr std::string_view kAnd = ",...";

std::string_view one_of(std::string_view values) {
  return values.ends_with(kAnd) ? values.substr(0, values.size() - kAnd.size()) : values;
}

/// The number that the text is, if it is one in the range `L..H`.
template <class Number>
std::optional<Number> parse_in(std::string_view range, std::string_view text, Number most) {
  const auto dots = range.find(kDots);
  const auto low = whole_text_as<Number>(range.substr(0, dots));
  const auto high = whole_text_as<Number>(range.substr(dots + kDots.size()));
  const auto number = whole_text_as<Number>(text);
  const bool is_in = number && !(low && *number < *low) && *number <= high.value_or(most);
  return is_in ? number : std::nullopt;
}

std::string describe_range(std::string_view range) {
  const auto dots = range.find(kDots);
  const auto low = range.substr(0, dots);
  const auto high = range.substr(dots + kDots.size());
  if (!low.empty() && !high.empty()) return fmt::format(" from {} to {}", low, high);
  if (!low.empty()) return fmt::format(" of at least {}", low);
  return high.empty() ? "" : fmt::format(" of at most {}", high);
}

/// `a, b and c`.
std::string enumerate(const std::vector<std::string_view>& names, std::string_view last_word) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 < names.size() ? ", " : fmt::format(" {} ", last_word);
    text += names[i];
  }
  return text;
}

std::vector<std::string_view> split(std::string_view text, char mark) {
  std::vector<std::string_view> parts;
  for (auto rest = text;;) {
    const auto end = rest.find(mark);
    parts.push_back(rest.substr(0, end));
    if (end == std::string_view::npos) return parts;
    rest.remove_prefix(end + 1);
  }
}

}  // namespace

tl::unexpected<Problem> OptionValue::refuse(std::string hint) const {
  return problem(ErrorCode::kBadValue, fmt::format("{}, {}={}", where_, row_.name, text_),
                 std::move(hint));
}

tl::unexpected<Problem> OptionValue::refuse_number(std::string_view kind) const {
  const auto range = describe_range(one_of(row_.values));
  return row_.values.ends_with(kAnd)
             ? refuse(fmt::format("write {}numbers{}, with commas between", kind, range))
             : refuse(fmt::format("write a {}number{}", kind, range));
}

Outcome<void> OptionValue::take(const Outcome<void>& taken) const {
  if (taken) return {};
  return refuse(taken.error().hint);
}

Outcome<void> OptionValue::take(std::string& place) const {
  if (text_.empty()) return refuse(fmt::format("write {}", row_.values));
  place = text_;
  return {};
}

Outcome<void> OptionValue::take(double& place) const {
  const auto number = parse_in(one_of(row_.values), text_, std::numeric_limits<double>::max());
  if (!number || !std::isfinite(*number)) return refuse_number("");
  place = *number;
  return {};
}

Outcome<void> OptionValue::take(std::chrono::microseconds& place) const {
  std::int64_t count{};
  return take(count).map([&] { place = std::chrono::microseconds{count}; });
}

Outcome<std::int64_t> OptionValue::whole(std::int64_t most) const {
  const auto number = parse_in(one_of(row_.values), text_, most);
  if (number) return *number;
  return refuse_number("whole ");
}

Outcome<std::size_t> OptionValue::index() const {
  const auto words = split(one_of(row_.values), '|');
  const auto word = std::ranges::find(words, text_);
  if (word == words.end()) {
    return refuse(did_you_mean(text_, words) + "write " + enumerate(words, "or"));
  }
  return static_cast<std::size_t>(word - words.begin());
}

Outcome<void> check_names(std::string_view device, const std::vector<std::string_view>& known,
                          const DeviceOptions& options, std::string_view where) {
  for (const auto& [name, value] : options) {
    if (std::ranges::find(known, name) != known.end()) continue;
    return problem(
        ErrorCode::kUnknownOption, fmt::format("{}, {}", where, name),
        fmt::format("{}{} has {}", did_you_mean(name, known), device, enumerate(known, "and")));
  }
  return {};
}

std::string to_markdown(std::span<const OptionRow> rows) {
  std::string table = "| option | meaning |\n|---|---|\n";
  for (const auto& row : rows) {
    std::string values;
    for (const char letter : row.values) values += letter == '|' ? "\\|" : std::string{letter};
    table += fmt::format("| `{}={}` | {} |\n", row.name, values, row.meaning);
  }
  return table;
}

}  // namespace armjig
