// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/latency/follower.hpp"
#include "harness/latency/trip_book.hpp"

namespace armjig {

/// How far a joint was from where it should have been, over time.
struct TrackingError {
  double rms{};
  double p99{};
  double most{};
  double skipped{};  ///< share of the deadlines
};

struct RateError {
  double rate{};  ///< Hz
  TrackingError error;
};

/// What the delays of a run cost a control loop.
struct JitterCost {
  std::string unit;
  std::uint64_t seed{};
  Duration time{};         ///< that each figure rests on, virtual
  double rate{};           ///< Hz
  Duration p99{};          ///< of the round trips
  TrackingError steady;    ///< if every answer took as long as the median
  TrackingError measured;  ///< with the delays that were measured
  double limit{};
  std::vector<RateError> rates;          ///< with the delays that were measured
  std::optional<double> highest_rate{};  ///< of these, that keeps the error below `limit`
};

struct JitterCostHow {
  double rate = 100;
  std::optional<double> limit;  ///< of the error at 99 %; none: twice that of steady delays
  std::uint64_t seed = 1;
  int rounds = 4;
  Duration time = std::chrono::seconds{10};  ///< of a round
};

/// A joint goes to and fro by set-points at a fixed rate. Each round trip takes what is drawn from
/// the measured ones, half of it each way, and leaves as late as was measured; as in the run,
/// nobody asks while an answer is late. Draws do not depend on each other. Equal for equal seeds.
/// Requires round trips. Problems: those of `make_follower`, and a device that does not answer.
[[nodiscard]] Outcome<JitterCost> cost_of(
    const Measured& measured,
    const std::function<Outcome<std::unique_ptr<Follower>>()>& make_follower,
    const JitterCostHow& how);

}  // namespace armjig
