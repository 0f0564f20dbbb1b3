// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <thread>
#include <vector>

#include "harness/core/time.hpp"
#include "harness/timing/latency_histogram.hpp"

namespace armjig {

/// A sleep that took longer than it should have.
struct Oversleep {
  Instant due{};
  Duration late{};
};

/// The longest time by which somebody slept too long within a stretch of time; zero if nobody did.
[[nodiscard]] Duration overslept_within(std::span<const Oversleep> oversleeps, Instant from,
                                        Instant to) noexcept;

/// A thread that only sleeps and wakes: when it is late, it was the host, whatever else was being
/// measured. It has the priority and the processors of who makes it.
class Sentinel {
 public:
  /// Times are those of a clock that was `now` just before the call. `worth` is what is kept with
  /// its time; the histogram has all.
  Sentinel(Instant now, Duration period, Duration worth);
  Sentinel(const Sentinel&) = delete;
  Sentinel& operator=(const Sentinel&) = delete;
  ~Sentinel() { stop(); }

  /// Whether it has not slept yet.
  [[nodiscard]] bool is_fresh() const noexcept { return is_fresh_; }
  /// Ends it. What follows is only to be asked afterwards.
  void stop();
  [[nodiscard]] const LatencyHistogram& lateness() const noexcept { return lateness_; }
  /// In the order of their times.
  [[nodiscard]] std::span<const Oversleep> oversleeps() const noexcept { return kept_; }
  /// How many more there were than could be kept.
  [[nodiscard]] std::uint64_t forgotten() const noexcept { return forgotten_; }

 private:
  void run(Duration period, Duration worth) noexcept;

  static constexpr std::size_t kMostKept = 100'000;

  Instant start_;
  std::chrono::steady_clock::time_point wall_start_ = std::chrono::steady_clock::now();
  LatencyHistogram lateness_;
  std::vector<Oversleep> kept_;
  std::uint64_t forgotten_ = 0;
  std::atomic<bool> is_fresh_ = true;
  std::atomic<bool> must_end_ = false;
  std::thread thread_;
};

}  // namespace armjig
