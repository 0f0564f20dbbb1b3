// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/jitter_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "harness/link/random_source.hpp"
#include "harness/timing/schedule.hpp"

namespace armjig {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kTurns = 0.5;  ///< to and fro, a second
/// In which the joint gets under way, and nothing is counted.
constexpr Duration kWarmUp = std::chrono::seconds{2};
constexpr std::array kRates{10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0};
/// More deadlines that pass by are no longer that rate.
constexpr double kMostSkipped = 0.01;

/// Durations as a histogram has them, drawn independently.
class Delays {
 public:
  Delays(const LatencyHistogram& histogram, std::uint64_t seed) : draw_{seed} {
    const auto counts = histogram.counts();
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] == 0) continue;
      below_ += counts[i];
      values_.push_back(
          {below_, std::clamp(LatencyHistogram::last_of(i), histogram.min(), histogram.max())});
    }
  }
  /// Nothing if there are none.
  Duration next() {
    if (values_.empty()) return {};
    return std::ranges::upper_bound(values_, draw_.below(below_), {}, &Value::below)->duration;
  }

 private:
  struct Value {
    std::uint64_t below{};  ///< of so many draws, those from the value before on
    Duration duration{};
  };
  RandomSource draw_;
  std::uint64_t below_ = 0;
  std::vector<Value> values_;
};

/// Errors, each for as long as it was the newest one.
class Errors {
 public:
  void add(double error, Duration time) {
    all_.push_back({std::abs(error), Seconds{time}.count()});
  }
  void count(std::uint64_t deadlines, std::uint64_t skipped) {
    deadlines_ += deadlines;
    skipped_ += skipped;
  }

  [[nodiscard]] TrackingError tell() {
    TrackingError told;
    if (all_.empty()) return told;
    std::ranges::sort(all_, {}, &Error::size);
    const auto time = std::accumulate(all_.begin(), all_.end(), 0.0,
                                      [](double sum, const Error& one) { return sum + one.time; });
    double before = 0;
    double squares = 0;
    for (const auto& one : all_) {
      squares += one.size * one.size * one.time;
      if (before <= 0.99 * time) told.p99 = one.size;
      before += one.time;
    }
    told.rms = std::sqrt(squares / time);
    told.most = all_.back().size;
    told.skipped = static_cast<double>(skipped_) / static_cast<double>(deadlines_ + skipped_);
    return told;
  }

 private:
  struct Error {
    double size{};
    double time{};
  };
  std::vector<Error> all_;
  std::uint64_t deadlines_ = 0;
  std::uint64_t skipped_ = 0;
};

/// Where the joint shall be: it begins at rest.
struct Way {
  double reach{};

  [[nodiscard]] double position(Duration time) const {
    return reach / 2 * (1 - std::cos(angle(time)));
  }
  [[nodiscard]] double speed(Duration time) const {
    return reach / 2 * kTurns * 2 * std::numbers::pi * std::sin(angle(time));
  }

 private:
  static double angle(Duration time) {
    return 2 * std::numbers::pi * kTurns * Seconds{time}.count();
  }
};

Result<void> run_round(Follower& joint, Duration period, Duration time, Delays& lateness,
                       Delays& round_trips, Errors& errors) {
  const auto start = joint.now();
  const Way way{joint.reach()};
  PeriodicSchedule schedule{start + period, period};
  Instant last = start;
  while (schedule.next() < start + kWarmUp + time) {
    joint.wait_until(schedule.next());
    const auto cycle = schedule.begin(joint.now());
    const auto planned = cycle.deadline - start;
    const auto sent = joint.now() + lateness.next();
    const auto round_trip = round_trips.next();
    joint.wait_until(sent + round_trip / 2);
    const auto arrived = joint.now();
    const auto position = joint.lead(way.position(planned), way.speed(planned));
    if (!position) return tl::unexpected{position.error()};
    if (arrived >= start + kWarmUp) {
      errors.add(way.position(arrived - start) - *position, arrived - last);
      errors.count(1, cycle.skipped);
    }
    last = arrived;
    joint.wait_until(std::max(joint.now(), sent + round_trip));
  }
  return {};
}

}  // namespace

Outcome<JitterCost> cost_of(
    const Measured& measured,
    const std::function<Outcome<std::unique_ptr<Follower>>()>& make_follower,
    const JitterCostHow& how) {
  JitterCost cost{.seed = how.seed,
                  .time = how.time * how.rounds,
                  .rate = how.rate,
                  .p99 = measured.round_trips.percentile(99)};
  const auto run = [&](double rate, const LatencyHistogram& lateness,
                       const LatencyHistogram& round_trips) -> Outcome<TrackingError> {
    const auto period = std::chrono::round<Duration>(Seconds{1 / rate});
    Errors errors;
    for (int round = 0; round < how.rounds; ++round) {
      auto joint = make_follower();
      if (!joint) return tl::unexpected{joint.error()};
      cost.unit = (*joint)->unit();
      const auto seed = how.seed * 1'000 + static_cast<std::uint64_t>(round);
      Delays late{lateness, 2 * seed};
      Delays trips{round_trips, 2 * seed + 1};
      const auto done = run_round(**joint, period, how.time, late, trips, errors);
      if (!done) {
        return problem(done.error().code, "the emulated device", "it ended what drives it");
      }
    }
    return errors.tell();
  };

  LatencyHistogram median;
  median.record(measured.round_trips.percentile(50));
  const auto steady = run(how.rate, {}, median);
  if (!steady) return tl::unexpected{steady.error()};
  cost.steady = *steady;
  cost.limit = how.limit.value_or(2 * cost.steady.p99);
  std::vector<double> rates{kRates.begin(), kRates.end()};
  if (std::ranges::find(rates, how.rate) == rates.end()) rates.push_back(how.rate);
  std::ranges::sort(rates);
  for (const auto rate : rates) {
    const auto error = run(rate, measured.lateness, measured.round_trips);
    if (!error) return tl::unexpected{error.error()};
    cost.rates.push_back({rate, *error});
    if (rate == how.rate) cost.measured = *error;
    if (error->p99 < cost.limit && error->skipped <= kMostSkipped) cost.highest_rate = rate;
  }
  return cost;
}

}  // namespace armjig
