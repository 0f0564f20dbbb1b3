// SPDX-License-Identifier: Apache-2.0
// How often `latency --against` is right: trials of 60 s a side, in virtual time, of echoes whose
// delays waver in several ways, with a machine that is slower now and then under both. A build that
// is 10 % or 20 us slower has to be flagged in at least 184 of 200 trials, an identical one in at
// most 6. ARMJIG_SOAK_TRIALS sets the number.
#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string_view>

#include "harness/link/random_source.hpp"
#include "tests/unit/latency/slices.hpp"

namespace armjig {
namespace {

constexpr std::size_t kSeconds = 60;

struct Way {
  std::string_view name;
  double (*microseconds)(RandomSource& random);  ///< of one answer
};
const Way kWays[] = {
    {"even, 0.8 to 1.2 ms", [](RandomSource& random) { return 800 + 400 * random.uniform(); }},
    {"normal, 100 us +- 10", [](RandomSource& random) { return 100 + 10 * random.normal(); }},
    {"90 % 1 ms, 10 % 4 ms",
     [](RandomSource& random) { return random.happens(0.1) ? 4'000.0 : 1'000.0; }},
    {"500 us and a long tail",
     [](RandomSource& random) { return 500 + 150 * random.exponential(); }},
    {"1 ms, 50 ms in one of 1,000",
     [](RandomSource& random) {
       return random.happens(0.001) ? 50'000.0 : 1'000 + 20 * random.normal();
     }},
};

/// The machine's part comes over both sides: a fifth more in some seconds.
std::vector<Slice> side(const Way& way, std::uint64_t seed, std::uint64_t machine, double slower,
                        double added) {
  RandomSource random{seed};
  const RandomSource load{machine};
  std::uint64_t answers = 0;
  return test::slices_of(4 * kSeconds, [=](auto) mutable {
    auto second = load.fork(answers++ / 100);
    const auto microseconds = way.microseconds(random) * slower + added;
    const auto loaded = std::max(microseconds, 1.0) * (second.happens(0.1) ? 1.2 : 1.0);
    return Duration{std::llround(1'000 * loaded)};
  });
}

struct Case {
  std::string_view name;
  double slower;
  double added;
};
constexpr Case kCases[] = {{"identical", 1, 0}, {"10 % slower", 1.1, 0}, {"20 us slower", 1, 20}};

bool try_way(const Way& way, int trials) {
  bool is_met = true;
  for (const auto& one : kCases) {
    const bool is_identical = one.slower == 1 && one.added == 0;
    int flagged = 0;
    for (int i = 0; i < trials; ++i) {
      const auto seed = static_cast<std::uint64_t>(i) * 3 + 1;
      const auto first = side(way, seed, seed, 1, 0);
      const auto second = side(way, seed + 1, seed, one.slower, one.added);
      const auto difference = compare_alternated(first, second, seed + 2).difference;
      flagged +=
          difference == Difference::kSlower || (is_identical && difference == Difference::kFaster);
    }
    const bool is_kept = is_identical ? flagged * 200 <= 6 * trials : flagged * 200 >= 184 * trials;
    fmt::print("{:28} {:14} {:3} of {} flagged{}\n", way.name, one.name, flagged, trials,
               is_kept ? "" : "  <- misses its bar");
    is_met = is_met && is_kept;
  }
  return is_met;
}

}  // namespace
}  // namespace armjig

int main() {
  const auto* const wanted = std::getenv("ARMJIG_SOAK_TRIALS");
  const int trials = wanted == nullptr ? 200 : std::max(1, std::atoi(wanted));
  bool is_met = true;
  for (const auto& way : armjig::kWays) is_met = armjig::try_way(way, trials) && is_met;
  return is_met ? 0 : 1;
}
