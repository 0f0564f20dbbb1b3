// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/quantity.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "harness/wire/parol6/joint_bounds.hpp"

namespace armjig::parol6 {

/// The way along which go-to frames lead the joints, judged from one set-point to the next and the
/// time between them. Telemetry is one period old on a good link and several on a slow one, and a
/// joint follows one or two periods later (parol6.goto.law), so a set-point is compared with
/// telemetry only where a way begins, from joints that stand.
///
/// A joint may be led at its top speed, and be up to two periods' worth of it ahead of that. So
/// frames may come a period late, and one of them may be lost. Set-points count with their speed:
/// the board goes to where a frame would let it rest.
class GoToWay {
 public:
  using Limits = std::array<StepsPerSecond, kJointCount>;

  /// A set-point that asks more of a joint than its top speed.
  struct Excess {
    std::size_t joint{};
    double way{};                     ///< steps
    std::optional<Duration> since{};  ///< the set-point before; none: the way begins here
  };

  /// `noise`: what the link may add to the times of frames.
  explicit GoToWay(const Limits& top_speeds, Duration noise = {}) noexcept
      : limits_{top_speeds}, noise_{noise} {}

  /// What was sent is no go-to: the next one begins a way.
  void end() noexcept { begin_.reset(); }

  /// Takes the next set-point, in order of time. `known`: the newest telemetry.
  [[nodiscard]] std::vector<Excess> go_on(Instant time, const CommandFrame& frame,
                                          const JointSteps& known);

  /// Whether a place is beyond the bounds and not on the way back from where the joint is beyond
  /// them. Ask before `go_on` with the same set-point.
  [[nodiscard]] bool leads_out(std::size_t joint, const JointBounds& bounds, Steps place,
                               Steps known) const noexcept;

  /// A joint that telemetry of now shows at none of the places to which it was led during the last
  /// tenth of a second and more: it does not follow, or goes elsewhere. Not asked of a way that has
  /// only just begun.
  [[nodiscard]] std::optional<std::size_t> stray(Instant now, const JointSteps& seen) const;

 private:
  /// Where the set-points of some time were.
  struct Stretch {
    JointSteps lowest{};
    JointSteps highest{};

    void include(const JointSteps& places) noexcept;
  };

  void note_place(Instant time, const JointSteps& goal) noexcept;

  Limits limits_;
  Duration noise_;
  std::optional<Instant> begin_;  ///< of the way; none: the joints are not led
  Instant last_{};
  CommandFrame frame_{};                      ///< at `last_`
  std::array<double, kJointCount> credit_{};  ///< how much further each may be led at once, steps
  Instant stretch_begin_{};
  Stretch stretch_{};
  Stretch stretch_before_{};
};

/// `go 131 steps at once, which is 6550 steps/s` or `go 181 steps 10.0 ms after the frame before`.
[[nodiscard]] std::string describe(const GoToWay::Excess& excess);

}  // namespace armjig::parol6
