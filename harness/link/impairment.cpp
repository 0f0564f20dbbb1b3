// SPDX-License-Identifier: Apache-2.0
#include "harness/link/impairment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <system_error>
#include <vector>

#include "harness/core/nearest.hpp"

namespace armjig {
namespace {

/// A value, or what to do about the text that is none.
template <class T>
using Parsed = tl::expected<T, std::string>;

tl::unexpected<std::string> wrong(std::string hint) {
  return tl::unexpected<std::string>{std::move(hint)};
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Cuts at each `separator` that is not in parentheses.
std::vector<std::string_view> split_at(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')') --depth;
    if (text[i] != separator || depth > 0) continue;
    parts.push_back(trimmed(text.substr(begin, i - begin)));
    begin = i + 1;
  }
  parts.push_back(trimmed(text.substr(begin)));
  return parts;
}

/// Reads the number that `text` begins with; the answer is what stands behind it, if there is one.
template <class Number>
std::optional<std::string_view> take_number(std::string_view text, Number& number) {
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return std::nullopt;
  return text.substr(static_cast<std::size_t>(rest - text.data()));
}

struct Measure {
  double value{};
  std::string_view unit;
};

std::optional<Measure> parse_measure(std::string_view text) {
  double value = 0;
  const auto unit = take_number(text, value);
  if (!unit || !std::isfinite(value)) return std::nullopt;
  return Measure{value, *unit};
}

Parsed<double> parse_rate(std::string_view text) {
  const auto measure = parse_measure(text);
  const bool is_percent = measure && measure->unit == "%";
  if (!measure || (!is_percent && !measure->unit.empty())) {
    return wrong(fmt::format("'{}' is no rate: write 0.001 or 0.1%", text));
  }
  const double rate = is_percent ? measure->value / 100 : measure->value;
  if (rate >= 0 && rate <= 1) return rate;
  return wrong(fmt::format("{} is beyond 0 to 1, which is 0% to 100%", text));
}

std::string print_rate(double rate) {
  const auto percent = fmt::format("{:.10g}%", rate * 100);
  return rate >= 1e-4 && parse_rate(percent) == rate ? percent : fmt::format("{}", rate);
}

Parsed<std::uint64_t> parse_whole(std::string_view text) {
  std::uint64_t value = 0;
  if (take_number(text, value) == "") return value;
  return wrong(fmt::format("'{}' is not a whole number below 2^64", text));
}

Parsed<std::uint64_t> parse_bytes(std::string_view text) {
  auto value = parse_whole(text);
  if (value && *value > 0) return value;
  return wrong(fmt::format("'{}' is not a number of bytes, 1 or more", text));
}

Parsed<std::uint64_t> parse_bandwidth(std::string_view text) {
  const auto suffix = text.empty() ? ' ' : text.back();
  const std::uint64_t factor = suffix == 'k' ? 1'000 : suffix == 'M' ? 1'000'000 : 1;
  const auto value = parse_whole(text.substr(0, text.size() - (factor == 1 ? 0 : 1)));
  constexpr std::uint64_t kMost = 1'000'000'000'000;
  if (value && *value > 0 && *value <= kMost / factor) return *value * factor;
  return wrong(fmt::format(
      "'{}' is no bandwidth: write bytes a second, 1 to 10^12, as in 11520, 300k or 1M", text));
}

struct TimeUnit {
  std::string_view symbol;
  Duration length;
};
constexpr std::array kTimeUnits{
    TimeUnit{"s", std::chrono::seconds{1}},
    TimeUnit{"ms", std::chrono::milliseconds{1}},
    TimeUnit{"us", std::chrono::microseconds{1}},
    TimeUnit{"ns", Duration{1}},
};

Parsed<Duration> parse_duration(std::string_view text) {
  const auto measure = parse_measure(text);
  if (!measure) {
    return wrong(fmt::format("'{}' is no duration: write a number and ns, us, ms or s", text));
  }
  const auto unit = std::ranges::find(kTimeUnits, measure->unit, &TimeUnit::symbol);
  if (unit == kTimeUnits.end()) {
    return wrong(fmt::format("'{}' needs a unit that is ns, us, ms or s, as in 2ms", text));
  }
  const double length = std::round(measure->value * static_cast<double>(unit->length.count()));
  constexpr Duration kMost = std::chrono::hours{1};
  if (length >= 0 && length <= static_cast<double>(kMost.count())) {
    return Duration{static_cast<Duration::rep>(length)};
  }
  return wrong(fmt::format("{} is beyond 0s to 3600s", text));
}

std::string print_duration(Duration duration) {
  const auto unit = std::ranges::find_if(kTimeUnits, [duration](const TimeUnit& candidate) {
    return duration % candidate.length == Duration::zero();
  });
  return fmt::format("{}{}", duration / unit->length, unit->symbol);
}

struct LawForm {
  std::string_view name;
  DurationLaw::Kind kind;
  std::size_t parameters;
};
constexpr std::array kLaws{
    LawForm{"constant", DurationLaw::Kind::kConstant, 1},
    LawForm{"uniform", DurationLaw::Kind::kUniform, 2},
    LawForm{"normal", DurationLaw::Kind::kNormal, 2},
    LawForm{"exponential", DurationLaw::Kind::kExponential, 1},
};
constexpr auto kLawForms = "2ms, uniform(1ms,3ms), normal(2ms,1ms) or exponential(2ms)";

Parsed<DurationLaw> parse_law(std::string_view text) {
  const auto open = text.find('(');
  if (open == std::string_view::npos) {
    return parse_duration(text).map(
        [](Duration constant) { return DurationLaw{DurationLaw::Kind::kConstant, constant, {}}; });
  }
  const auto form = std::ranges::find(kLaws, trimmed(text.substr(0, open)), &LawForm::name);
  if (form == kLaws.end()) {
    return wrong(fmt::format("no law is called '{}': write {}", text.substr(0, open), kLawForms));
  }
  if (text.back() != ')') return wrong(fmt::format("'{}' lacks its closing parenthesis", text));
  const auto parameters = split_at(text.substr(open + 1, text.size() - open - 2), ',');
  if (parameters.size() != form->parameters) {
    return wrong(fmt::format("{} takes {}: write {}", form->name,
                             form->parameters == 1 ? "one duration" : "two durations", kLawForms));
  }
  DurationLaw law{form->kind, {}, {}};
  const auto first = parse_duration(parameters.front());
  if (!first) return tl::unexpected{first.error()};
  law.first = *first;
  if (form->parameters == 1) return law;
  const auto second = parse_duration(parameters.back());
  if (!second) return tl::unexpected{second.error()};
  law.second = *second;
  if (law.kind == DurationLaw::Kind::kUniform && law.second < law.first) {
    return wrong(fmt::format("{} is less than {}: write uniform(LEAST,MOST)", parameters.back(),
                             parameters.front()));
  }
  return law;
}

std::string print_law(const DurationLaw& law) {
  auto first = print_duration(law.first);
  if (law.kind == DurationLaw::Kind::kConstant) return first;
  const auto form = std::ranges::find(kLaws, law.kind, &LawForm::kind);
  if (form->parameters == 1) return fmt::format("{}({})", form->name, first);
  return fmt::format("{}({},{})", form->name, first, print_duration(law.second));
}

/// `FIRST` or `FIRST:SECOND`.
struct Pair {
  std::string_view first;
  std::optional<std::string_view> second;
};

Pair parse_pair(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) return {text, std::nullopt};
  return {trimmed(text.substr(0, colon)), trimmed(text.substr(colon + 1))};
}

using Grouping = PathImpairment::Grouping;

struct Group {
  Grouping kind{};
  std::size_t size{};
};

Parsed<Group> parse_group(std::string_view text) {
  if (text == "random") return Group{Grouping::kRandom, 0};
  const auto size = parse_bytes(text);
  if (size) return Group{Grouping::kFixed, *size};
  return wrong(fmt::format("'{}' is neither a number of bytes, 1 or more, nor random", text));
}

std::string print_group(Grouping kind, std::size_t size) {
  return kind == Grouping::kRandom ? "random" : fmt::format("{}", size);
}

using Read = Parsed<void>;

/// Puts a value that was read into its place.
template <class To, class From>
Read put(To& to, const Parsed<From>& value) {
  if (!value) return tl::unexpected{value.error()};
  to = *value;
  return {};
}

Read read_reordering(PathImpairment& path, std::string_view text) {
  const auto [rate, wait] = parse_pair(text);
  PathImpairment::Reordering read;
  if (auto done = put(read.rate, parse_rate(rate)); !done) return done;
  if (wait) {
    if (auto done = put(read.wait, parse_duration(*wait)); !done) return done;
  }
  path.reordering = read.rate > 0 ? read : PathImpairment::Reordering{};
  return {};
}

std::string print_reordering(const PathImpairment& path) {
  const auto& [rate, wait] = path.reordering;
  if (rate <= 0) return {};
  if (wait == PathImpairment::Reordering{}.wait) return print_rate(rate);
  return fmt::format("{}:{}", print_rate(rate), print_duration(wait));
}

Read read_split(PathImpairment& path, std::string_view text) {
  const auto group = parse_group(text);
  if (!group) return tl::unexpected{group.error()};
  path.split = {group->kind, group->size};
  return {};
}

std::string print_split(const PathImpairment& path) {
  const auto& [kind, size] = path.split;
  return kind == Grouping::kNone ? std::string{} : print_group(kind, size);
}

Read read_merge(PathImpairment& path, std::string_view text) {
  const auto [size, wait] = parse_pair(text);
  const auto group = parse_group(size);
  if (!group) return tl::unexpected{group.error()};
  path.merge = {.kind = group->kind, .size = group->size};
  return wait ? put(path.merge.wait, parse_duration(*wait)) : Read{};
}

std::string print_merge(const PathImpairment& path) {
  const auto& [kind, size, wait] = path.merge;
  if (kind == Grouping::kNone) return {};
  if (wait == PathImpairment::Merge{}.wait) return print_group(kind, size);
  return fmt::format("{}:{}", print_group(kind, size), print_duration(wait));
}

Read read_stall(PathImpairment& path, std::string_view text) {
  const auto [rate, length] = parse_pair(text);
  if (!length) return wrong("write RATE:LENGTH, as in 0.1%:50ms");
  PathImpairment::Stall read;
  if (auto done = put(read.rate, parse_rate(rate)); !done) return done;
  if (auto done = put(read.length, parse_law(*length)); !done) return done;
  path.stall = read.rate > 0 ? read : PathImpairment::Stall{};
  return {};
}

std::string print_stall(const PathImpairment& path) {
  const auto& [rate, length] = path.stall;
  return rate > 0 ? fmt::format("{}:{}", print_rate(rate), print_law(length)) : std::string{};
}

/// An option that is a rate and nothing else.
template <double PathImpairment::* Rate>
Read read_rate(PathImpairment& path, std::string_view text) {
  return put(path.*Rate, parse_rate(text));
}
template <double PathImpairment::* Rate>
std::string print_rate(const PathImpairment& path) {
  return path.*Rate > 0 ? print_rate(path.*Rate) : std::string{};
}

/// An option that is a number and nothing else; 0 is its absence.
template <auto Number, Parsed<std::uint64_t> (*Parse)(std::string_view) = parse_bytes>
Read read_number(PathImpairment& path, std::string_view text) {
  return put(path.*Number, Parse(text));
}
template <auto Number>
std::string print_number(const PathImpairment& path) {
  return path.*Number > 0 ? fmt::format("{}", path.*Number) : std::string{};
}

struct Option {
  std::string_view name;
  std::string_view form;
  std::string_view meaning;
  Read (*read)(PathImpairment& path, std::string_view text);
  std::string (*print)(const PathImpairment& path);  ///< empty: the defect is absent
};

constexpr std::array kOptions{
    Option{"chunk", "BYTES", "cuts what is handed over into chunks of at most so many bytes",
           read_number<&PathImpairment::chunk>, print_number<&PathImpairment::chunk>},
    Option{"bit-errors", "RATE", "flips bits", read_rate<&PathImpairment::bit_errors>,
           print_rate<&PathImpairment::bit_errors>},
    Option{"loss", "RATE", "loses chunks", read_rate<&PathImpairment::loss>,
           print_rate<&PathImpairment::loss>},
    Option{"double", "RATE", "delivers chunks twice", read_rate<&PathImpairment::doubling>,
           print_rate<&PathImpairment::doubling>},
    Option{"reorder", "RATE[:TIME]", "lets chunks be overtaken by the next within TIME, else 20ms",
           read_reordering, print_reordering},
    Option{"split", "BYTES|random", "cuts chunks into pieces", read_split, print_split},
    Option{"merge", "BYTES|random[:TIME]", "joins what comes within TIME, else 16ms", read_merge,
           print_merge},
    Option{"delay", "LAW", "delays each piece",
           [](PathImpairment& path, std::string_view text) {
             return put(path.delay, parse_law(text));
           },
           [](const PathImpairment& path) {
             return path.delay == DurationLaw{} ? std::string{} : print_law(path.delay);
           }},
    Option{"bandwidth", "BYTES", "carries at most so many bytes a second (300k, 1M)",
           read_number<&PathImpairment::bandwidth, parse_bandwidth>,
           print_number<&PathImpairment::bandwidth>},
    Option{"stall", "RATE:LAW", "stands still before a chunk", read_stall, print_stall},
    Option{"disconnect", "RATE", "breaks before a chunk", read_rate<&PathImpairment::disconnect>,
           print_rate<&PathImpairment::disconnect>},
    Option{"disconnect-after", "BYTES", "breaks behind so many bytes",
           read_number<&PathImpairment::disconnect_after>,
           print_number<&PathImpairment::disconnect_after>},
};

/// `NAME=VALUE` with its direction.
struct Item {
  std::string_view text;
  std::string_view direction;  ///< `out`, `in`, or empty for both
  std::string_view name;
  std::string_view value;
};

tl::unexpected<Problem> bad_item(ErrorCode code, std::string_view item, std::string hint) {
  return problem(code, fmt::format("impairment '{}'", item), std::move(hint));
}

Outcome<Item> parse_item(std::string_view text) {
  if (text.empty()) {
    return bad_item(ErrorCode::kBadValue, text, "write NAME=VALUE, as in loss=1%,delay=2ms");
  }
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) {
    return bad_item(ErrorCode::kBadValue, text, "write NAME=VALUE, as in loss=1%");
  }
  Item item{text, {}, trimmed(text.substr(0, equals)), trimmed(text.substr(equals + 1))};
  if (const auto dot = item.name.find('.'); dot != std::string_view::npos) {
    item.direction = item.name.substr(0, dot);
    item.name.remove_prefix(dot + 1);
    if (item.direction != "out" && item.direction != "in") {
      return bad_item(ErrorCode::kUnknownOption, text,
                      "the directions are out. (to the device) and in. (from it)");
    }
    if (item.name == "seed") {
      return bad_item(ErrorCode::kBadValue, text, "the seed is for both directions: write seed=N");
    }
  }
  if (item.name == "seed" ||
      std::ranges::find(kOptions, item.name, &Option::name) != kOptions.end())
    return item;
  std::string names;
  for (const auto& option : kOptions) names += fmt::format("{}, ", option.name);
  return bad_item(
      ErrorCode::kUnknownOption, text,
      fmt::format("{}known: {}seed", did_you_mean(item.name, kOptions, &Option::name), names));
}

Outcome<void> apply(const Item& item, Impairment& impairment) {
  if (item.name == "seed") {
    const auto done = put(impairment.seed, parse_whole(item.value));
    if (!done) return bad_item(ErrorCode::kBadValue, item.text, done.error());
    return {};
  }
  const auto& option = *std::ranges::find(kOptions, item.name, &Option::name);
  for (auto* const path : {&impairment.out, &impairment.in}) {
    const std::string_view direction = path == &impairment.out ? "out" : "in";
    if (!item.direction.empty() && item.direction != direction) continue;
    if (const auto done = option.read(*path, item.value); !done) {
      return bad_item(ErrorCode::kBadValue, item.text, done.error());
    }
  }
  return {};
}

}  // namespace

Outcome<Impairment> parse_impairment(std::string_view text) {
  std::vector<Item> items;
  std::set<std::pair<std::string_view, std::string_view>> seen;
  for (const auto part : split_at(text, ',')) {
    const auto item = parse_item(part);
    if (!item) return tl::unexpected{item.error()};
    if (!seen.emplace(item->direction, item->name).second) {
      return bad_item(ErrorCode::kBadValue, part,
                      fmt::format("{} is given twice: leave one out", item->name));
    }
    items.push_back(*item);
  }
  Impairment impairment;
  for (const bool has_direction : {false, true}) {
    for (const auto& item : items) {
      if (item.direction.empty() == has_direction) continue;
      if (auto done = apply(item, impairment); !done) return tl::unexpected{done.error()};
    }
  }
  return impairment;
}

std::string to_string(const Impairment& impairment) {
  std::string text;
  for (const auto& option : kOptions) {
    const auto out = option.print(impairment.out);
    const auto in = option.print(impairment.in);
    if (out == in) {
      if (!out.empty()) text += fmt::format("{}={},", option.name, out);
      continue;
    }
    if (!out.empty()) text += fmt::format("out.{}={},", option.name, out);
    if (!in.empty()) text += fmt::format("in.{}={},", option.name, in);
  }
  return text + fmt::format("seed={}", impairment.seed);
}

std::string impairment_forms() {
  std::string forms;
  const auto add = [&forms](std::string_view form, std::string_view meaning) {
    forms += fmt::format("  {:<28} {}\n", form, meaning);
  };
  for (const auto& option : kOptions) {
    add(fmt::format("{}={}", option.name, option.form), option.meaning);
  }
  add("seed=N", "chooses another course of events; the same seed repeats it");
  add("RATE", "a chance per chunk (bit-errors: per bit): 0.001 or 0.1%");
  add("LAW", kLawForms);
  add("out.NAME=, in.NAME=", "to the device only, from the device only");
  return forms;
}

}  // namespace armjig
