// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/limit.hpp"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace armjig {
namespace {

using Of = Limit::Of;

struct Unit {
  std::string_view name;
  double nanoseconds;
};
constexpr std::array kUnits{Unit{"ns", 1}, Unit{"us", 1e3}, Unit{"ms", 1e6}, Unit{"s", 1e9}};

/// The number at the beginning, which is taken off.
std::optional<double> take_number(std::string_view& text) {
  double number{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || !std::isfinite(number) || number < 0) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return number;
}

/// What it is a limit of; false: nothing that we know.
bool read_name(std::string_view name, Limit& limit) {
  constexpr std::array<std::pair<std::string_view, Of>, 4> kNames{
      {{"mean", Of::kMean}, {"max", Of::kMax}, {"lost", Of::kLost}, {"skipped", Of::kSkipped}}};
  for (const auto& [word, of] : kNames) {
    limit.of = of;
    if (name == word) return true;
  }
  limit.of = Of::kPercentile;
  if (!name.starts_with('p')) return false;
  name.remove_prefix(1);
  const auto percent = take_number(name);
  limit.percent = percent.value_or(0);
  return percent && name.empty() && limit.percent > 0 && limit.percent <= 100;
}

bool read_value(std::string_view text, Limit& limit) {
  const auto value = take_number(text);
  if (!value) return false;
  limit.below = *value;
  if (limit.of == Of::kLost || limit.of == Of::kSkipped) return text.empty();
  for (const auto& unit : kUnits) {
    limit.below = *value * unit.nanoseconds;
    if (text == unit.name) return true;
  }
  return false;
}

Outcome<Limit> parse_limit(std::string_view text) {
  Limit limit{.text = std::string{text}};
  const auto sign = text.find('<');
  const bool is_read = sign != std::string_view::npos && read_name(text.substr(0, sign), limit) &&
                       read_value(text.substr(sign + 1), limit);
  if (is_read) return limit;
  return problem(ErrorCode::kBadValue, fmt::format("--limit '{}'", text),
                 "write p99<2ms, p99.9<5ms, mean<800us, max<10ms, lost<1 or skipped<1");
}

/// Among all requests, lost ones counted as longer than any.
double percentile_of(double percent, const Measured& measured) {
  const auto& histogram = measured.corrected;
  const auto rank = LatencyHistogram::rank_of(percent, histogram.count() + measured.lost);
  if (rank > histogram.count()) return std::numeric_limits<double>::infinity();
  return static_cast<double>(histogram.at_rank(rank).count());
}

double actual_of(const Limit& limit, const Measured& measured) {
  const bool is_whole = measured.lost == 0 && measured.corrected.count() > 0;
  switch (limit.of) {
    case Of::kPercentile:
      return percentile_of(limit.percent, measured);
    case Of::kMean:
      return is_whole ? static_cast<double>(measured.corrected.mean().count())
                      : std::numeric_limits<double>::infinity();
    case Of::kMax:
      return is_whole ? static_cast<double>(measured.corrected.max().count())
                      : std::numeric_limits<double>::infinity();
    case Of::kLost:
      return static_cast<double>(measured.lost);
    case Of::kSkipped:
      return static_cast<double>(measured.skipped);
  }
  return 0;
}

}  // namespace

Outcome<std::vector<Limit>> parse_limits(std::string_view text) {
  std::vector<Limit> limits;
  for (;;) {
    const auto comma = text.find(',');
    auto limit = parse_limit(text.substr(0, comma));
    if (!limit) return tl::unexpected{limit.error()};
    limits.push_back(*std::move(limit));
    if (comma == std::string_view::npos) return limits;
    text.remove_prefix(comma + 1);
  }
}

LimitVerdict check(const Limit& limit, const Measured& measured) {
  LimitVerdict verdict{.limit = limit, .actual = actual_of(limit, measured)};
  verdict.is_kept = verdict.actual < limit.below;
  const auto all = static_cast<double>(measured.corrected.count() + measured.lost);
  // Of fewer, not one would be beyond it.
  verdict.is_known =
      limit.of != Of::kPercentile || all * (100 - limit.percent) >= 100 || limit.percent == 100;
  return verdict;
}

std::string actual_text(const LimitVerdict& verdict) {
  if (std::isinf(verdict.actual)) return "lost";
  const bool is_number = verdict.limit.of == Of::kLost || verdict.limit.of == Of::kSkipped;
  if (is_number) return fmt::format("{}", verdict.actual);
  return verdict.actual < 1e6 ? fmt::format("{:.1f} us", verdict.actual / 1e3)
                              : fmt::format("{:.3f} ms", verdict.actual / 1e6);
}

}  // namespace armjig
