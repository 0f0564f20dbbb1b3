// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "conformance/program_checker.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::parol6::programs {

/// Judges one frame by its values alone. The vendor's GUI begins with a frame of start values whose
/// code is 0: that is nobody's mistake.
void judge_fields(const CommandFrame& frame, bool is_first, const Complain& complain);

/// Judges what a program wants of the gripper, from frame to frame.
class GripperConduct {
 public:
  /// `report`: what telemetry says of the gripper; none before any came.
  void judge(const CommandFrame& frame, const std::optional<GripperReport>& report,
             const Complain& complain);

 private:
  void judge_move(const GripperSetPoint& wanted, const std::optional<GripperReport>& report,
                  const Complain& complain) const;

  std::optional<GripperSetPoint> before_;
  std::optional<GripperSetPoint> sent_;       ///< what the gripper got last
  std::optional<GripperSetPoint> forgotten_;  ///< changed in a frame that did not send it
};

}  // namespace armjig::parol6::programs
