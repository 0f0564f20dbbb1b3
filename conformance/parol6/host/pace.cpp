// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/host/pace.hpp"

#include <fmt/core.h>

#include "conformance/parol6/host/occasions.hpp"

namespace armjig::parol6::programs {
namespace {

using namespace std::chrono_literals;

constexpr Duration kWindow = 1s;
constexpr int kMost = 125;
constexpr int kLeast = 80;
constexpr Duration kEarliest = 5ms;
constexpr Duration kLatest = 15ms;
constexpr int kMostOffBeat = 5;

}  // namespace

void Pace::judge(Instant time, const Complain& complain) {
  if (!last_) {
    window_begin_ = time;
  } else if (time - window_begin_ >= kWindow) {
    judge_window(time, complain);
    window_begin_ = time;
    frames_ = 0;
    off_beat_ = 0;
  }
  if (last_) {
    const auto gap = time - *last_;
    if (gap < kEarliest - noise_ || gap > kLatest + noise_) ++off_beat_;
  }
  ++frames_;
  last_ = time;
}

/// `time`: of the first frame behind the window. A program that was not there is not slow.
void Pace::judge_window(Instant time, const Complain& complain_now) const {
  const auto complain = complain_now.resting_on({.since = window_begin_});
  complain.occasion(occasion::kSecond);
  if (frames_ > kMost) {
    complain("parol6.host.rate-fast", fmt::format("{} frames came in a second", frames_));
    return;
  }
  const bool was_away = time - *last_ >= kWindow / 2;
  if (was_away) return;
  if (frames_ < kLeast) {
    complain("parol6.host.rate-slow", fmt::format("{} frames came in a second", frames_));
  } else if (off_beat_ > kMostOffBeat) {
    complain("parol6.host.jitter",
             fmt::format("{} of {} frames came early or late", off_beat_, frames_));
  }
}

}  // namespace armjig::parol6::programs
