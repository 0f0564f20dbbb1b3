// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "harness/core/time.hpp"
#include "harness/drive/parol6/drive.hpp"

namespace armjig::parol6::drive {

/// A way from where the joints are to where they shall be, in set-points for `Drive::go_to`. A far
/// target must not be sent at once, for the board closes any distance in 10 ms if it can. All
/// joints begin and arrive together, slow down at both ends, and none is faster than its limit.
/// It knows nothing of what stands in the way.
class Glide {
 public:
  struct SetPoint {
    JointSteps position{};
    JointSpeeds feed{};
  };

  /// Requires `fastest` above 0 in every joint that has a way to go.
  Glide(const JointSteps& from, const JointSteps& to, const JointSpeeds& fastest) noexcept;

  [[nodiscard]] Duration duration() const noexcept { return duration_; }
  [[nodiscard]] const JointSteps& goal() const noexcept { return to_; }

  /// Where the joints shall be then; the goal from `duration` on.
  [[nodiscard]] SetPoint at(Duration since_start) const noexcept;

 private:
  JointSteps from_;
  JointSteps to_;
  Duration duration_{};
};

}  // namespace armjig::parol6::drive
