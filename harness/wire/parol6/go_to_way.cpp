// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/parol6/go_to_way.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace armjig::parol6 {
namespace {

using namespace std::chrono_literals;
using Seconds = std::chrono::duration<double>;

/// The board closes a distance at 50 times it a second (parol6.goto.law), so this is how long a
/// joint at top speed takes for the distance that asks that speed of it.
constexpr Seconds kClosing = 20ms;
/// Set-points are whole steps.
constexpr double kRounding = 1;
/// Links and boards that need longer for an answer are not there.
constexpr Duration kStretch = 100ms;

/// Where a frame lets a joint come to rest (parol6.goto.law).
double rest_of(const CommandFrame& frame, std::size_t j) noexcept {
  return frame.position[j].value + frame.speed[j].value / 100.0;
}

}  // namespace

std::vector<GoToWay::Excess> GoToWay::go_on(Instant time, const CommandFrame& frame,
                                            const JointSteps& known) {
  const auto since = begin_ ? std::optional{time - last_} : std::nullopt;
  std::vector<Excess> found;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double top = limits_[j].value;
    auto& credit = credit_[j];
    double way = 0;
    if (since) {
      const double most = top * Seconds{kClosing + noise_}.count() + kRounding;
      credit = std::min(most, credit + top * Seconds{*since}.count());
      way = std::abs(rest_of(frame, j) - rest_of(frame_, j));
    } else {
      credit = top * kClosing.count();
      way = std::abs(frame.position[j].value - known[j].value) +
            std::abs(frame.speed[j].value) / 100.0;
    }
    if (way > credit) found.push_back({j, way, since});
    credit = std::max(0.0, credit - way);
  }
  note_place(time, frame.position);
  frame_ = frame;
  last_ = time;
  return found;
}

bool GoToWay::leads_out(std::size_t joint, const JointBounds& bounds, Steps place,
                        Steps known) const noexcept {
  const auto before = begin_ ? frame_.position[joint] : known;
  return place < std::min({bounds.lower, known, before}) ||
         place > std::max({bounds.upper, known, before});
}

void GoToWay::Stretch::include(const JointSteps& places) noexcept {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    lowest[j] = std::min(lowest[j], places[j]);
    highest[j] = std::max(highest[j], places[j]);
  }
}

void GoToWay::note_place(Instant time, const JointSteps& goal) noexcept {
  if (!begin_) {
    begin_ = stretch_begin_ = time;
    stretch_ = stretch_before_ = {goal, goal};
  } else if (time - stretch_begin_ >= kStretch) {
    stretch_before_ = stretch_;
    stretch_ = {frame_.position, frame_.position};  // that was in force until now
    stretch_begin_ = time;
  }
  stretch_.include(goal);
}

std::optional<std::size_t> GoToWay::stray(Instant now, const JointSteps& seen) const {
  if (!begin_ || now - *begin_ < kStretch) return std::nullopt;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double lag = limits_[j].value * kClosing.count();
    const auto lowest = std::min(stretch_.lowest[j], stretch_before_.lowest[j]);
    const auto highest = std::max(stretch_.highest[j], stretch_before_.highest[j]);
    if (seen[j].value < lowest.value - lag || seen[j].value > highest.value + lag) return j;
  }
  return std::nullopt;
}

std::string describe(const GoToWay::Excess& excess) {
  if (excess.since) {
    return fmt::format("go {:.0f} steps {:.1f} ms after the frame before", excess.way,
                       std::chrono::duration<double, std::milli>{*excess.since}.count());
  }
  return fmt::format("go {:.0f} steps at once, which is {:.0f} steps/s", excess.way,
                     excess.way / kClosing.count());
}

}  // namespace armjig::parol6
