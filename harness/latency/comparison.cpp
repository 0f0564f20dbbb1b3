// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "harness/core/median.hpp"

namespace armjig {
namespace {

/// Two figures are looked at, so that in all one of 100 comparisons of the same errs.
constexpr double kConfidence = 0.995;
constexpr std::size_t kFewestPairs = 10;
/// A noise floor has at least that of its bootstrap.
constexpr double kFloorConfidence = 0.99;

Difference verdict_of(const ConfidenceInterval& interval) noexcept {
  if (interval.low > Duration{}) return Difference::kSlower;
  return interval.high < Duration{} ? Difference::kFaster : Difference::kNone;
}

Difference worst_of(const std::vector<Compared>& figures) noexcept {
  const auto has = [&figures](Difference wanted) {
    return std::ranges::find(figures, wanted, &Compared::difference) != figures.end();
  };
  for (const auto one : {Difference::kSlower, Difference::kFaster, Difference::kUnclear}) {
    if (has(one)) return one;
  }
  return Difference::kNone;
}

/// Of the differences of neighbours, in one figure.
using IntervalOf = ConfidenceInterval (*)(std::span<const Duration> differences,
                                          std::uint64_t seed);

ConfidenceInterval interval_of_mean(std::span<const Duration> differences, std::uint64_t seed) {
  return mean_interval(differences, {.confidence = kConfidence, .seed = seed});
}

/// Means of neighbours, so that there are at most `kMostCompared`.
std::vector<Duration> thinned(std::span<const Duration> values) {
  constexpr std::size_t kMostCompared = 1'000;
  const auto size = (values.size() + kMostCompared - 1) / kMostCompared;
  std::vector<Duration> means;
  for (std::size_t i = 0; i + size <= values.size(); i += size) {
    const auto part = values.subspan(i, size);
    means.push_back(std::accumulate(part.begin(), part.end(), Duration{}) /
                    static_cast<Duration::rep>(size));
  }
  return means;
}

/// Of the middle, by Wilcoxon's signed ranks: the means of all pairs, without the smallest and the
/// largest ones. Slices in which the machine was busy move it little, and unlike the median it uses
/// how large each difference is.
ConfidenceInterval interval_of_middle(std::span<const Duration> differences, std::uint64_t) {
  constexpr double kNormalEnd = 2.807;  // a normal value lies that far out in 1 - kConfidence
  const auto values = thinned(differences);
  std::vector<Duration> means;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = i; j < values.size(); ++j) means.push_back((values[i] + values[j]) / 2);
  }
  const auto count = static_cast<double>(values.size());
  const auto deviation = std::sqrt(count * (count + 1) * (2 * count + 1) / 24);
  const auto outside =
      static_cast<std::ptrdiff_t>(std::max(0.0, count * (count + 1) / 4 - kNormalEnd * deviation));
  std::ranges::sort(means);
  return {*(means.begin() + outside), *(means.end() - 1 - outside)};
}

Compared compare(std::string_view figure, std::span<const Slice> first,
                 std::span<const Slice> second, Duration Slice::* of, IntervalOf interval_of,
                 std::uint64_t seed) {
  std::vector<Duration> ones;
  std::vector<Duration> others;
  std::vector<Duration> differences;
  for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) {
    ones.push_back(first[i].*of);
    others.push_back(second[i].*of);
    differences.push_back(others.back() - ones.back());
  }
  Compared compared{.figure = std::string{figure}, .difference = Difference::kUnclear};
  if (differences.empty()) return compared;
  compared.first = median_of(ones);
  compared.second = median_of(others);
  compared.interval = interval_of(differences, seed);
  if (differences.size() >= kFewestPairs) compared.difference = verdict_of(compared.interval);
  return compared;
}

}  // namespace

std::string_view to_string(Difference difference) noexcept {
  constexpr std::array<std::string_view, 4> kWords{"no difference", "slower", "faster", "unclear"};
  return kWords[static_cast<std::size_t>(difference)];
}

Slice slice_of(std::span<const RoundTrip> trips) {
  assert(!trips.empty());
  std::vector<Duration> durations;
  Duration sum{};
  for (const auto& trip : trips) {
    durations.push_back(trip.duration);
    sum += trip.duration;
  }
  return {median_of(std::move(durations)), sum / static_cast<Duration::rep>(trips.size())};
}

LatencyComparison compare_alternated(std::span<const Slice> first, std::span<const Slice> second,
                                     std::uint64_t seed) {
  LatencyComparison comparison{
      .confidence = kConfidence,
      .rests_on = fmt::format("{} pairs of alternated slices: signed ranks of the differences of "
                              "their medians, bootstrap of those of their means",
                              std::min(first.size(), second.size()))};
  comparison.figures.push_back(
      compare("median", first, second, &Slice::median, interval_of_middle, seed));
  comparison.figures.push_back(
      compare("mean", first, second, &Slice::mean, interval_of_mean, seed));
  comparison.difference = worst_of(comparison.figures);
  return comparison;
}

Outcome<Baseline> parse_baseline(std::string_view json, const std::string& where) {
  const auto content = nlohmann::json::parse(json, nullptr, false);
  const auto wrong = [&where](const char* hint) {
    return problem(ErrorCode::kMalformed, where, hint);
  };
  const auto schema = content.is_object() ? content.find("schema") : content.end();
  if (schema == content.end() || *schema != "armjig.latency/1") {
    return wrong("it is no report of armjig latency --json");
  }
  try {
    const auto& round_trip = content.at("round_trip");
    const auto time = [](const nlohmann::json& object, const char* name) {
      return Duration{object.at(name).get<Duration::rep>()};
    };
    const auto& floor = round_trip.at("noise_floor");
    return Baseline{.median = time(round_trip, "p50_ns"),
                    .noise = {time(floor, "low_ns"), time(floor, "high_ns")},
                    .text = fmt::format("{} of {}", content.at("target").get<std::string>(),
                                        content.at("date").get<std::string>())};
  } catch (const nlohmann::json::exception&) {
    return wrong("a figure is missing in it or is no number: was it too short?");
  }
}

LatencyComparison compare_with(const Baseline& baseline, Duration median,
                               const ConfidenceInterval& noise) {
  Compared compared{.figure = "median", .first = baseline.median, .second = median};
  compared.interval = {noise.low - baseline.noise.high, noise.high - baseline.noise.low};
  compared.difference = verdict_of(compared.interval);
  return {.figures = {compared},
          .confidence = kFloorConfidence,
          .rests_on = "noise floors of both runs: " + baseline.text,
          .difference = compared.difference};
}

}  // namespace armjig
