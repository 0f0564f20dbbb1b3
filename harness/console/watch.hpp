// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "harness/console/watched.hpp"
#include "harness/timing/latency_histogram.hpp"
#include "harness/timing/schedule.hpp"

namespace armjig {

/// From the first question to the last answer, in the time of the device's port: asks on absolute
/// deadlines, and listens between them.
class Watch {
 public:
  struct Plan {
    Duration period{};                   ///< of questions, above 0
    std::optional<std::uint64_t> count;  ///< of questions, or of messages that came without any
    std::optional<Duration> time;        ///< in which questions are asked
  };
  /// Called after each `Watched::listen`.
  using Heard = std::function<void()>;

  /// `watched` outlives it.
  Watch(Watched& watched, const Plan& plan)
      : watched_{watched}, plan_{plan}, start_{watched.now()}, schedule_{start_, plan.period} {}

  /// Whether everything that was planned has been asked.
  [[nodiscard]] bool is_over() const;

  /// Listens until the next question is due, and asks it. Errors are the port's.
  [[nodiscard]] Result<void> cycle(const Heard& heard);
  /// Listens for the answers to the last one.
  [[nodiscard]] Result<void> end(const Heard& heard);

  /// When the next question is due.
  [[nodiscard]] Instant next() const noexcept { return schedule_.next(); }
  [[nodiscard]] double seconds_since_start() const;

  // Texts of several lines.
  /// All that is known, under a title.
  [[nodiscard]] std::string page(std::string_view title) const;
  /// The link so far, and how well the schedule was kept.
  [[nodiscard]] std::string summary() const;

 private:
  [[nodiscard]] Result<void> listen_until(Instant time, const Heard& heard);

  Watched& watched_;
  Plan plan_;
  Instant start_;
  PeriodicSchedule schedule_;
  std::uint64_t asked_ = 0;
  std::uint64_t skipped_ = 0;
  LatencyHistogram lateness_;
};

}  // namespace armjig
