// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "harness/drive/parol6/activity.hpp"
#include "harness/rig/guard.hpp"
#include "harness/script/interpreter.hpp"

namespace armjig::script {

/// How well the arm followed one move, in steps and with signs: place minus set-point.
struct MoveResult {
  std::size_t statement{};
  parol6::planning::Tracking tracking{};
  std::array<std::int32_t, parol6::kJointCount> largest_error{};
  std::array<std::int32_t, parol6::kJointCount> final_error{};  ///< when its last set-point was due
};

/// A set-point of a move, and where the joints were when the next one was due.
struct RunSample {
  std::size_t frame{};  ///< since the program began
  parol6::JointSteps wanted{};
  parol6::JointSteps seen{};
};

/// A program that runs on a drive, a frame each period, until the arm stands behind its last one.
/// Joints, outputs and gripper are the interpreter's; what a frame has besides is the drive's, and
/// the gripper is left alone until the program says something about it.
class ProgramRun final : public parol6::drive::Activity {
 public:
  /// The program has to outlive it.
  ProgramRun(const Program& program, const InterpreterSettings& settings);

  /// Each line that has begun, with its number.
  [[nodiscard]] std::string take_news() override;

  /// Those that have begun, in order.
  [[nodiscard]] const std::vector<MoveResult>& moves() const noexcept { return moves_; }

  /// Keeps up to `most` samples of moves; none are kept otherwise.
  void keep_samples(std::size_t most) { samples_.reserve(most); }
  [[nodiscard]] const std::vector<RunSample>& samples() const noexcept { return samples_; }

 private:
  /// Where a frame wants the arm.
  struct Wanted {
    std::optional<std::size_t> move{};  ///< in `moves_`; none: nowhere in particular
    parol6::JointSteps position{};
    std::size_t frame{};
  };

  [[nodiscard]] std::optional<Ending> advance(parol6::drive::Drive& drive, Instant now) override;
  [[nodiscard]] std::optional<Ending> come_to_rest();
  void compare(const parol6::JointSteps& position);
  void apply(parol6::drive::Drive& drive, const parol6::CommandFrame& frame);
  [[nodiscard]] Wanted wanted();
  void tell_line();

  const Program& program_;
  Interpreter interpreter_;
  std::vector<MoveResult> moves_;
  std::vector<RunSample> samples_;
  std::size_t frames_ = 0;
  std::deque<Wanted> under_way_;     ///< frames that telemetry does not show yet
  parol6::GripperSetPoint gripper_;  ///< as the program left it
  std::optional<std::size_t> told_statement_;
  std::string news_;
  bool has_ended_ = false;
  int idle_frames_ = 0;  ///< since the end
};

/// What a program does to a device besides being observed.
[[nodiscard]] std::vector<Hazard> hazards_of(const Program& program);

}  // namespace armjig::script
