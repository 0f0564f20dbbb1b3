// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "harness/latency/path.hpp"
#include "harness/latency/probe.hpp"
#include "harness/latency/trip_book.hpp"
#include "harness/timing/schedule.hpp"

namespace armjig {

/// Sends requests and times the answers. What is between a send and its answer is the path's; all
/// else is done before or after.
class Meter {
 public:
  static constexpr std::size_t kOutliers = TripBook::kOutliers;
  static constexpr std::size_t kMostTrips = TripBook::kMostTrips;
  static constexpr std::size_t kMostBurst = TripBook::kMostPending;

  /// Until so many requests were sent, or so much time has passed, whatever comes first.
  struct Until {
    std::uint64_t count = ~std::uint64_t{0};
    Duration time = Duration::max();
  };

  /// All outlive it. `must_end` is asked between requests, and ten times a second while nothing
  /// happens.
  Meter(Path& path, Probe& probe, const MeterPlan& plan, std::function<bool()> must_end,
        MeterProgress* progress = nullptr);

  /// Goes on measuring; the schedule begins anew. False: `must_end` ended it. Errors: the path's.
  [[nodiscard]] Result<bool> run(const Until& until);

  [[nodiscard]] const Measured& measured() const noexcept { return book_.measured(); }

 private:
  [[nodiscard]] Result<void> send_burst(Instant deadline);
  [[nodiscard]] Result<void> wait_for_answers();
  [[nodiscard]] Result<void> listen_until(Instant time);
  [[nodiscard]] Result<void> drain();
  void take(const Path::Arrival& arrival);
  void lose_pending();

  Path& path_;
  Probe& probe_;
  MeterPlan plan_;
  std::function<bool()> must_end_;
  TripBook book_;
  std::array<std::byte, 4096> buffer_{};
};

}  // namespace armjig
