// SPDX-License-Identifier: Apache-2.0
#include "harness/script/interpreter.hpp"

#include <cmath>
#include <utility>

#include "harness/motion/parol6/joint_table.hpp"

namespace armjig::script {
namespace {

using parol6::CommandFrame;
using parol6::JointSteps;

using parol6::planning::kTick;
constexpr int kLongestHold = 20;

constexpr std::uint8_t kGripperGoes = parol6::gripper_command::kActivate |
                                      parol6::gripper_command::kGoTo |
                                      parol6::gripper_command::kReleaseDirection;

/// What a host sends besides joints: outputs off, and a gripper's set-point that asks for nothing.
/// The commander lets a gripper go there all the same, the host that was recorded does not.
CommandFrame first_frame(const InterpreterSettings& settings, Dialect dialect) {
  CommandFrame frame;
  frame.command = parol6::Command::kIdle;
  frame.affected_joints = 0xFF;
  frame.gripper = {.position = 1,
                   .speed = 1,
                   .current = Milliamperes{1},
                   .command = dialect == Dialect::kCommander ? kGripperGoes : std::uint8_t{1},
                   .id = settings.gripper_id};
  frame.check = parol6::kCheckHost;
  return frame;
}

parol6::planning::Rules rules_of(Dialect dialect) noexcept {
  return dialect == Dialect::kCommander ? parol6::planning::Rules::kCommander
                                        : parol6::planning::Rules::kDocumented;
}

std::uint64_t frames_of(const Delay& delay, Dialect dialect) noexcept {
  return dialect == Dialect::kCommander
             ? static_cast<std::uint64_t>(delay.seconds / kTick) + 1
             : static_cast<std::uint64_t>(std::llround(delay.seconds / kTick));
}

std::uint8_t flag_of(const Output& output) noexcept {
  return output.number == 1 ? parol6::io_flag::kOut1 : parol6::io_flag::kOut2;
}

/// With the bits of the flag as the output's level has them.
std::uint8_t switched(std::uint8_t flags, const Output& output) noexcept {
  const auto flag = flag_of(output);
  return static_cast<std::uint8_t>(output.level == Output::Level::kHigh ? flags | flag
                                                                        : flags & ~flag);
}

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

}  // namespace

Interpreter::Interpreter(const Program& program, const InterpreterSettings& settings)
    : program_{program},
      settings_{settings},
      frame_{first_frame(settings, program.dialect)},
      passes_left_{settings.passes} {
  settings_.planner.rules = rules_of(program.dialect);
}

Interpreter::Next Interpreter::next(const JointSteps& position) {
  for (;;) {
    if (move_) {
      auto moved = go_on_moving(position);
      if (!moved || *moved) return moved;
    }
    if (idle_frames_ > 0) {
      --idle_frames_;
      return idle(position);
    }
    if (next_statement_ == program_.statements.size()) return std::nullopt;
    statement_ = next_statement_++;
    if (auto stopped = execute(position)) return tl::unexpected{*std::move(stopped)};
    if (std::exchange(must_repeat_, false)) return frame_;
  }
}

/// Nothing if the move has ended and wants no frame any more.
Interpreter::Next Interpreter::go_on_moving(const JointSteps& position) {
  const auto& plan = move_->plan;
  if (move_->sent < plan.set_points.size()) return set_point();
  if (plan.stop) return tl::unexpected{error(describe(*plan.stop))};
  const bool is_there = move_->sent == 0 || position == move_->position();
  const bool must_hold = !is_commander() &&
                         plan.tracking == parol6::planning::Tracking::kSpeedAndPosition &&
                         !is_there;
  if (must_hold && held_++ < kLongestHold) return frame_;
  move_.reset();
  if (is_commander()) return idle(position);
  return std::nullopt;
}

std::optional<Diagnostic> Interpreter::execute(const JointSteps& position) {
  const auto wait = [this](std::uint64_t frames) -> std::optional<Diagnostic> {
    idle_frames_ = frames;
    return std::nullopt;
  };
  const auto visitor = Overloaded{
      [&](const Begin& /*begin*/) { return wait(0); },
      [&](const End& /*end*/) {
        next_statement_ = program_.statements.size();
        return wait(is_commander() ? 1 : 0);
      },
      [&](const Loop& /*loop*/) {
        loop();
        return wait(1);
      },
      [&](const Dummy& /*dummy*/) { return wait(1); },
      [&](const Delay& delay) { return wait(frames_of(delay, program_.dialect)); },
      [&](const Output& output) {
        frame_.in_out = switched(frame_.in_out, output);
        return wait(1);
      },
      [&](const GripperMove& gripper) {
        frame_.gripper.position = gripper.position;
        frame_.gripper.speed = gripper.speed;
        frame_.gripper.current = gripper.current;
        frame_.gripper.command = kGripperGoes;
        return wait(1);
      },
      [&](const GripperCalibration& /*calibration*/) {
        frame_.gripper.mode = parol6::gripper_mode::kCalibrate;
        return wait(1);
      },
      [&](const parol6::planning::Move& move) { return begin(move, position); },
      [&](const Flaw& flaw) {
        if (flaw.effect == Flaw::Effect::kSkipped) return wait(1);
        return std::optional{error(flaw.why)};
      },
  };
  return std::visit(visitor, program_.statements[statement_].command);
}

std::optional<Diagnostic> Interpreter::begin(const parol6::planning::Move& move,
                                             const JointSteps& position) {
  // The path is wanted also if only speeds are sent.
  auto with_positions = move;
  if (!is_commander()) with_positions.tracking = parol6::planning::Tracking::kSpeedAndPosition;
  auto plan = parol6::planning::plan(with_positions, position, settings_.planner);
  if (!plan) return error(describe(plan.error()));
  plan->tracking = move.tracking;
  move_ = ActiveMove{statement_, position, *std::move(plan)};
  held_ = 0;
  must_repeat_ = is_commander();
  return std::nullopt;
}

CommandFrame Interpreter::set_point() {
  const auto& point = move_->plan.set_points[move_->sent++];
  const auto tracking = move_->plan.tracking;
  frame_.command = parol6::planning::command_of(tracking);
  // A board that follows speeds does not look at positions. The host that was recorded leaves
  // those of the start in, the commander the path's.
  const bool shows_start = !is_commander() && tracking == parol6::planning::Tracking::kSpeed;
  frame_.position = shows_start ? move_->start : point.position;
  frame_.speed = point.speed;
  return frame_;
}

CommandFrame Interpreter::idle(const JointSteps& position) {
  frame_.command = parol6::Command::kIdle;
  frame_.position = is_commander() ? position : JointSteps{};
  frame_.speed = {};
  auto frame = frame_;
  frame_.gripper.mode = parol6::gripper_mode::kMove;  // it leaves once
  return frame;
}

Diagnostic Interpreter::error(std::string text) const {
  return {Severity::kError, program_.statements[statement_].place, std::move(text)};
}

void Interpreter::loop() {
  if (settings_.passes == 0 || --passes_left_ > 0) {
    next_statement_ = 1;
  } else {
    next_statement_ = program_.statements.size();
  }
}

}  // namespace armjig::script
