// SPDX-License-Identifier: Apache-2.0
#include "harness/timing/sentinel.hpp"

#include <algorithm>

#include "harness/timing/schedule.hpp"

namespace armjig {

Duration overslept_within(std::span<const Oversleep> oversleeps, Instant from,
                          Instant to) noexcept {
  Duration most{};
  for (const auto& one : oversleeps) {
    if (one.due < to && one.due + one.late > from) {
      most = std::max(most, std::min(one.due + one.late, to) - std::max(one.due, from));
    }
  }
  return most;
}

Sentinel::Sentinel(Instant now, Duration period, Duration worth) : start_{now} {
  kept_.reserve(kMostKept);
  thread_ = std::thread{[this, period, worth] { run(period, worth); }};
}

void Sentinel::stop() {
  must_end_ = true;
  if (thread_.joinable()) thread_.join();
}

void Sentinel::run(Duration period, Duration worth) noexcept {
  using Clock = std::chrono::steady_clock;
  PeriodicSchedule schedule{start_ + period, period};
  while (!must_end_) {
    const auto due = schedule.next();
    std::this_thread::sleep_until(wall_start_ + (due - start_));
    const auto now = start_ + (Clock::now() - wall_start_);
    const auto late = now - due;
    lateness_.record(late);
    if (late >= worth && kept_.size() < kMostKept) {
      kept_.push_back({due, late});
    } else if (late >= worth) {
      ++forgotten_;
    }
    is_fresh_ = false;
    (void)schedule.begin(std::max(now, due));
  }
}

}  // namespace armjig
