// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/latency/path.hpp"
#include "harness/timing/latency_histogram.hpp"

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
  /// By how much more than the host the device counted since it took the request before.
  std::optional<Duration> shift;
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

  /// What another one measured, too; its trips come after ours.
  void add(const Measured& other);
};

/// Matches answers to requests in the order of the requests, and keeps what is to be said of them.
/// Recording takes nothing from the heap while there is room for the trips.
class TripBook {
 public:
  static constexpr std::size_t kOutliers = 5;
  static constexpr std::size_t kMostTrips = 4'000'000;
  static constexpr std::size_t kMostPending = 256;

  explicit TripBook(const MeterPlan& plan, MeterProgress* progress = nullptr);

  void note(MeterEvent::Kind kind, Instant time, std::size_t bytes = 0) noexcept;
  /// A request leaves now. Requires fewer than `kMostPending`.
  void send(Instant deadline, Instant sent) noexcept;
  /// It has left, after its deadline or after what was waited for, whatever was later.
  void record_lateness() noexcept;
  void skip(std::uint64_t deadlines) noexcept { measured_.skipped += deadlines; }
  /// An answer has come, to the oldest request that waits. `shift`: as of its round trip.
  void end(const Path::Arrival& arrival, std::optional<Duration> shift = std::nullopt);
  /// No answer came to those that wait; until `settled` nobody shall ask.
  void lose(Instant now, Instant settled) noexcept;
  /// Forgets those that wait: nobody waited long enough to call them lost.
  void forget() noexcept { ended_ = sent_; }
  void pass(Duration time) noexcept { measured_.time += time; }

  [[nodiscard]] std::size_t pending() const noexcept { return sent_ - ended_; }
  /// When the oldest that waits was sent. Requires one.
  [[nodiscard]] Instant oldest() const noexcept { return pending_[ended_ % kMostPending].sent; }
  /// The same; none if an answer would be one to nothing.
  [[nodiscard]] std::optional<Instant> awaited() const noexcept {
    if (pending() == 0) return std::nullopt;
    return oldest();
  }
  [[nodiscard]] const Measured& measured() const noexcept { return measured_; }

 private:
  struct Pending {
    Instant deadline{};
    Instant sent{};
  };

  void keep_if_worst(const RoundTrip& trip);

  std::optional<Duration> period_;
  MeterProgress* progress_;
  Measured measured_;
  std::array<Pending, kMostPending> pending_{};  ///< a ring
  Instant free_since_{};                         ///< when nothing was waited for any more
  std::size_t sent_ = 0;
  std::size_t ended_ = 0;                              ///< answered or lost
  std::array<MeterEvent, Outlier::kEvents> events_{};  ///< a ring
  std::size_t event_count_ = 0;
};

}  // namespace armjig
