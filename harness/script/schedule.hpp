// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "harness/motion/parol6/joint_table.hpp"
#include "harness/script/interpreter.hpp"

namespace armjig::script {

/// The longest program that is computed in advance: ten thousand seconds.
inline constexpr std::size_t kMostFrames = 1'000'000;

/// One move of a program, in one of its passes.
struct ScheduledMove {
  std::size_t statement{};
  std::size_t first_frame{};
  parol6::JointSteps start{};
  parol6::planning::Plan plan;
};

/// Everything that a program sends, one frame each 10 ms, to an arm that is always where it was
/// told to be.
struct Schedule {
  std::vector<parol6::CommandFrame> frames;
  std::vector<std::size_t> statements;        ///< of each frame
  std::vector<parol6::JointSteps> positions;  ///< where the arm is told to be, after each frame
  std::vector<ScheduledMove> moves;
  std::optional<Diagnostic> stop;  ///< ends early, behind the last frame

  [[nodiscard]] double seconds() const noexcept {
    return static_cast<double>(frames.size()) * parol6::planning::kTick;
  }
};

/// Runs the program from there without an arm. Errors: what the interpreter says before anything of
/// the move in question was sent, and programs that are longer than `kMostFrames`.
[[nodiscard]] tl::expected<Schedule, Diagnostic> schedule(const Program& program,
                                                          const InterpreterSettings& settings,
                                                          const parol6::JointSteps& from);

/// The frames as a recording of what goes to the device: `golden-trace/1`, the first one at 0.
[[nodiscard]] std::string to_trace(const Schedule& schedule, std::string_view title);

}  // namespace armjig::script
