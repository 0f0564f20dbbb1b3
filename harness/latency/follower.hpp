// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "harness/core/error.hpp"
#include "harness/core/time.hpp"

namespace armjig {

/// A joint of an emulated device, in virtual time, that is led along a way by set-points. Lengths
/// are in its own smallest unit.
class Follower {
 public:
  Follower() = default;
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;
  virtual ~Follower() = default;

  /// What lengths are in: `steps`.
  [[nodiscard]] virtual std::string_view unit() const noexcept = 0;
  /// How far it can well be led.
  [[nodiscard]] virtual double reach() const noexcept = 0;
  [[nodiscard]] virtual Instant now() const = 0;
  virtual void wait_until(Instant time) = 0;
  /// Where it is. Sends where it shall be, and how fast, then reads where it was.
  [[nodiscard]] virtual Result<double> lead(double position, double speed) = 0;
};

}  // namespace armjig
