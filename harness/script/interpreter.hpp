// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tl/expected.hpp>

#include "harness/motion/parol6/planner.hpp"
#include "harness/script/program.hpp"
#include "harness/wire/parol6/frame.hpp"

namespace armjig::script {

struct InterpreterSettings {
  parol6::planning::PlannerSettings planner{};  ///< its rules follow the program's dialect
  std::uint64_t passes = 1;     ///< of a program that ends with `Loop()`; 0: for ever
  std::uint8_t gripper_id = 0;  ///< CAN node
};

/// A move that is under way.
struct ActiveMove {
  std::size_t statement{};
  parol6::JointSteps start{};  ///< where the joints were when it was planned
  parol6::planning::Plan plan;
  std::size_t sent = 0;  ///< set-points that have left

  /// Where the plan has the joints after the newest frame. Requires `sent > 0`.
  [[nodiscard]] const parol6::JointSteps& position() const noexcept {
    return plan.set_points[sent - 1].position;
  }
};

/// Runs a program in tact with a loop of 100 Hz, over whatever sends frames and knows where the
/// joints are. No I/O and no clock: time is the number of calls.
///
/// In the commander's dialect the frames are the shipped program's, with the ticks in which it
/// plans, ends a move or jumps. In the documented one nothing is wasted: moves begin with their
/// first sample, and a move that follows positions holds its last one until the joints are there,
/// for 20 frames at most.
class Interpreter {
 public:
  /// The program has to outlive it.
  Interpreter(const Program& program, const InterpreterSettings& settings);

  /// The frame of the next period; nothing once the program has ended. `position` is the newest
  /// telemetry. Errors end the program: a move that cannot be planned, the sample in front of a
  /// singularity, a `Flaw` that stops or hangs.
  [[nodiscard]] tl::expected<std::optional<parol6::CommandFrame>, Diagnostic> next(
      const parol6::JointSteps& position);

  /// The statement that the newest frame belongs to.
  [[nodiscard]] std::size_t statement() const noexcept { return statement_; }
  /// What the newest frame has for the gripper; before the first, that of a program which says
  /// nothing about it.
  [[nodiscard]] const parol6::GripperSetPoint& gripper() const noexcept { return frame_.gripper; }
  /// The move that the newest frame belongs to; null if the arm shall stand.
  [[nodiscard]] const ActiveMove* move() const noexcept { return move_ ? &*move_ : nullptr; }

 private:
  using Frame = parol6::CommandFrame;
  using Next = tl::expected<std::optional<Frame>, Diagnostic>;

  [[nodiscard]] bool is_commander() const noexcept {
    return program_.dialect == Dialect::kCommander;
  }
  [[nodiscard]] Next go_on_moving(const parol6::JointSteps& position);
  [[nodiscard]] std::optional<Diagnostic> execute(const parol6::JointSteps& position);
  [[nodiscard]] std::optional<Diagnostic> begin(const parol6::planning::Move& move,
                                                const parol6::JointSteps& position);
  [[nodiscard]] Frame set_point();
  [[nodiscard]] Frame idle(const parol6::JointSteps& position);
  [[nodiscard]] Diagnostic error(std::string text) const;
  void loop();

  const Program& program_;
  InterpreterSettings settings_;
  Frame frame_;
  std::size_t next_statement_ = 1;  ///< `Begin` has no frame
  std::size_t statement_ = 0;
  std::uint64_t passes_left_;
  std::uint64_t idle_frames_ = 0;  ///< that the statement still has to send
  bool must_repeat_ = false;       ///< the commander plans while the frame before leaves again
  std::optional<ActiveMove> move_;
  int held_ = 0;  ///< frames since the last set-point
};

}  // namespace armjig::script
