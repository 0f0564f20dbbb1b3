// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "conformance/program_checker.hpp"
#include "harness/core/time.hpp"
#include "harness/wire/parol6/frame.hpp"
#include "harness/wire/parol6/go_to_way.hpp"

namespace armjig::parol6::programs {

/// Judges what a program commands, given what telemetry told it and what it commanded before. It
/// starts from the power-up of a board: enabled, not homed.
class Conduct {
 public:
  /// `noise`: of the link; with any, frames may come together that were sent one by one.
  explicit Conduct(Duration noise) noexcept;

  /// A frame of the program. Of several at one time the board acts on the last one only.
  void command(Instant time, const CommandFrame& frame, const Complain& complain);
  /// What the board answered.
  void telemetry(Instant time, const TelemetryFrame& frame);
  /// No frame has come until now.
  void wait_until(Instant time, const Complain& complain);
  void finish(Instant time, const Complain& complain);

  [[nodiscard]] const std::optional<TelemetryFrame>& last_telemetry() const noexcept {
    return telemetry_;
  }

 private:
  enum class Homing : std::uint8_t { kNo, kAsked, kRuns };

  /// What a jog or go-to that is held did so far.
  struct Held {
    CommandFrame frame{};
    Instant since{};
    std::array<Steps, kJointCount> position{};  ///< when it began
    bool has_moved = false;
    bool is_judged = false;
  };

  void act(Instant time, const CommandFrame& frame);
  void judge_order(Instant time, const CommandFrame& frame, const Complain& complain);
  void judge_silence(Instant time, const Complain& complain);
  void call_silent(Instant time, Duration longest, const Complain& complain);
  void note_occasions(const CommandFrame& frame, const Complain& complain) const;
  void judge_permission(const CommandFrame& frame, const Complain& complain) const;
  void judge_estop(Instant time, const CommandFrame& frame, const Complain& complain);
  void judge_homing(Instant time, const CommandFrame& frame, const Complain& complain);
  void judge_motion(Instant time, const CommandFrame& frame, const Complain& complain);
  void judge_held(Instant time, const CommandFrame& frame, const Complain& complain);
  void judge_jog(Instant time, const CommandFrame& frame, const Complain& complain);
  void judge_go_to(Instant time, const CommandFrame& frame, const Complain& complain);
  [[nodiscard]] bool is_arm_homed() const noexcept;
  [[nodiscard]] bool is_estop_pressed() const noexcept { return pressed_since_.has_value(); }
  [[nodiscard]] bool has_joints_move() const noexcept;

  Duration noise_;
  std::optional<TelemetryFrame> telemetry_;
  std::optional<CommandFrame> latched_;  ///< the last frame
  Instant latched_at_{};
  Duration gap_before_{};           ///< in front of the frames that came at that time
  int together_ = 1;                ///< how many did
  bool has_fallen_silent_ = false;  ///< behind the last frame, and that was said

  // As far as the frames before the last one have acted.
  bool is_enabled_ = true;
  Homing homing_ = Homing::kNo;

  std::optional<Instant> pressed_since_;  ///< the emergency stop, as telemetry shows it
  bool has_disabled_ = false;             ///< since then
  bool has_ignored_stop_ = false;         ///< and that was said
  std::optional<Instant> home_since_;     ///< home commands, one after the other
  std::optional<Instant> outward_since_;  ///< jogs that lead out of a range
  std::optional<Held> held_;
  GoToWay way_;
};

}  // namespace armjig::parol6::programs
