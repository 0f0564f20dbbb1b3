// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/latency/path.hpp"
#include "harness/latency/probe.hpp"
#include "harness/timing/latency_histogram.hpp"
#include "harness/timing/schedule.hpp"

namespace armjig {

/// What is to be measured.
struct MeterPlan {
  /// Between requests, on absolute deadlines; none: the next one as soon as the answer is there.
  std::optional<Duration> period = std::chrono::milliseconds{10};
  std::size_t burst = 1;                        ///< requests at a deadline, right after each other
  Duration patience = std::chrono::seconds{1};  ///< after which an answer is lost
  std::size_t expected = 0;                     ///< round trips for which room is made
};

/// A request that was answered.
struct RoundTrip {
  Instant sent{};
  Duration duration{};
  Duration late{};                   ///< of the sending, after its deadline
  std::optional<Duration> delivery;  ///< from the kernel's stamp until it was read
};

/// What happened to a message, for the traces of the worst.
struct MeterEvent {
  enum class Kind : std::uint8_t { kDue, kSent, kCame, kAnswered, kLost };
  Kind kind{};
  Instant time{};
  std::size_t bytes{};
};

/// What was going on when an answer took long.
struct Outlier {
  static constexpr std::size_t kEvents = 12;

  RoundTrip trip;
  std::array<MeterEvent, kEvents> events{};  ///< the last ones, oldest first
  std::size_t event_count{};
};

/// What others may look at while it is measured.
struct MeterProgress {
  std::atomic<std::uint64_t> answered = 0;
  std::atomic<std::uint64_t> lost = 0;
  std::atomic<Duration::rep> worst = 0;  ///< nanoseconds
};

/// All that was measured.
struct Measured {
  LatencyHistogram round_trips;
  /// From the deadline, and with those that nobody sent meanwhile; in a closed loop the same.
  LatencyHistogram corrected;
  LatencyHistogram lateness;      ///< of sending; empty in a closed loop
  LatencyHistogram delivery;      ///< from kernel to program, where it tells
  std::vector<RoundTrip> trips;   ///< the first ones, as many as there was room for
  std::vector<Outlier> outliers;  ///< the worst, longest first
  std::uint64_t sent = 0;
  std::uint64_t lost = 0;
  std::uint64_t skipped = 0;  ///< deadlines that passed without a request
  std::uint64_t surplus = 0;  ///< answers to nothing
  std::uint64_t unkept = 0;   ///< round trips that are in the histograms only
  Duration time{};            ///< in which was measured
};

/// Sends requests and times the answers. What is between a send and its answer is the path's; all
/// else is done before or after.
class Meter {
 public:
  static constexpr std::size_t kOutliers = 5;
  static constexpr std::size_t kMostTrips = 4'000'000;
  static constexpr std::size_t kMostBurst = 256;

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

  [[nodiscard]] const Measured& measured() const noexcept { return measured_; }

 private:
  struct Pending {
    Instant deadline{};
    Instant sent{};
  };

  [[nodiscard]] Result<void> send_burst(Instant deadline);
  [[nodiscard]] Result<void> wait_for_answers();
  [[nodiscard]] Result<void> listen_until(Instant time);
  [[nodiscard]] Result<void> drain();
  void take(const Path::Arrival& arrival);
  void end_trip(const Path::Arrival& arrival);
  void lose_pending();
  void note(MeterEvent::Kind kind, Instant time, std::size_t bytes = 0) noexcept;
  void keep_if_worst(const RoundTrip& trip);
  [[nodiscard]] std::size_t pending() const noexcept { return sent_ - ended_; }

  Path& path_;
  Probe& probe_;
  MeterPlan plan_;
  std::function<bool()> must_end_;
  MeterProgress* progress_;
  Measured measured_;
  std::array<Pending, kMostBurst> pending_{};  ///< a ring
  Instant free_since_{};                       ///< when nothing was waited for any more
  std::size_t sent_ = 0;
  std::size_t ended_ = 0;                              ///< answered or lost
  std::array<MeterEvent, Outlier::kEvents> events_{};  ///< a ring
  std::size_t event_count_ = 0;
  std::array<std::byte, 4096> buffer_{};
};

}  // namespace armjig
