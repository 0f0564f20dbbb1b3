// SPDX-License-Identifier: Apache-2.0
#include "harness/drive/parol6/glide.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>

namespace armjig::parol6::drive {
namespace {

using Seconds = std::chrono::duration<double>;

/// The share of the way is 3 u^2 - 2 u^3 after the share u of the time: its speed begins and ends
/// at zero, and is 1.5 times the mean at its peak.
constexpr double kPeak = 1.5;

constexpr double way(double u) noexcept { return u * u * (3.0 - 2.0 * u); }
constexpr double speed(double u) noexcept { return 6.0 * u * (1.0 - u); }

}  // namespace

Glide::Glide(const JointSteps& from, const JointSteps& to, const JointSpeeds& fastest) noexcept
    : from_{from}, to_{to} {
  Seconds longest{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const double distance = std::abs(to[j].value - from[j].value);
    if (distance > 0) longest = std::max(longest, Seconds{kPeak * distance / fastest[j].value});
  }
  duration_ = std::chrono::ceil<Duration>(longest);
}

Glide::SetPoint Glide::at(Duration since_start) const noexcept {
  if (since_start >= duration_) return {to_, {}};
  const auto u = Seconds{since_start} / Seconds{duration_};
  SetPoint point;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto distance = static_cast<double>(to_[j].value - from_[j].value);
    point.position[j] =
        Steps{from_[j].value + static_cast<std::int32_t>(std::lround(distance * way(u)))};
    point.feed[j] =
        StepsPerSecond{static_cast<std::int32_t>(distance * speed(u) / Seconds{duration_}.count())};
  }
  return point;
}

}  // namespace armjig::parol6::drive
