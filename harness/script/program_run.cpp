// SPDX-License-Identifier: Apache-2.0
#include "harness/script/program_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "harness/script/format.hpp"

namespace armjig::script {
namespace {

/// A frame takes effect until the next one, and telemetry of that one comes before the third.
constexpr std::size_t kFramesUntilSeen = 3;
/// Until the last set-point has been seen and the arm stands.
constexpr int kFramesOfRest = 5;

}  // namespace

ProgramRun::ProgramRun(const Program& program, const InterpreterSettings& settings)
    : program_{program}, interpreter_{program, settings}, gripper_{interpreter_.gripper()} {}

std::string ProgramRun::take_news() { return std::exchange(news_, {}); }

std::optional<parol6::drive::Activity::Ending> ProgramRun::advance(parol6::drive::Drive& drive,
                                                                   Instant /*now*/) {
  const auto position = drive.telemetry()->position;
  compare(position);
  if (has_ended_) return come_to_rest();
  const auto frame = interpreter_.next(position);
  if (!frame) {
    drive.idle();
    return Ending{false, fmt::format("line {}: {}", frame.error().place.line, frame.error().text)};
  }
  if (!*frame) {
    drive.idle();
    has_ended_ = true;
    return std::nullopt;
  }
  tell_line();
  apply(drive, **frame);
  under_way_.push_back(wanted());
  under_way_.back().frame = frames_++;
  return std::nullopt;
}

std::optional<parol6::drive::Activity::Ending> ProgramRun::come_to_rest() {
  under_way_.push_back({});
  if (++idle_frames_ < kFramesOfRest) return std::nullopt;
  return Ending{true, fmt::format("ran to its end, {} moves", moves_.size())};
}

void ProgramRun::compare(const parol6::JointSteps& position) {
  if (under_way_.size() < kFramesUntilSeen) return;
  const auto seen = under_way_.front();
  under_way_.pop_front();
  if (!seen.move) return;
  if (samples_.size() < samples_.capacity()) {
    samples_.push_back({seen.frame, seen.position, position});
  }
  auto& result = moves_[*seen.move];
  for (std::size_t j = 0; j < parol6::kJointCount; ++j) {
    const auto error = position[j].value - seen.position[j].value;
    result.final_error[j] = error;
    if (std::abs(error) > std::abs(result.largest_error[j])) result.largest_error[j] = error;
  }
}

/// A latched emergency stop refuses motion, and its event has ended this activity before.
void ProgramRun::apply(parol6::drive::Drive& drive, const parol6::CommandFrame& frame) {
  if (frame.command == parol6::Command::kGoTo) {
    (void)drive.go_to(frame.position, frame.speed);
  } else if (frame.command == parol6::Command::kJog) {
    (void)drive.jog(frame.speed);
  } else {
    drive.idle();
  }
  drive.set_outputs(frame.in_out);
  if (frame.gripper == gripper_) return;
  drive.set_gripper(frame.gripper);
  gripper_ = frame.gripper;
  gripper_.mode = parol6::gripper_mode::kMove;  // it leaves once
}

ProgramRun::Wanted ProgramRun::wanted() {
  const auto* const move = interpreter_.move();
  if (move == nullptr || move->sent == 0) return {};
  if (move->sent == 1) moves_.push_back({move->statement, move->plan.tracking, {}, {}});
  return {moves_.size() - 1, move->position(), 0};
}

void ProgramRun::tell_line() {
  const auto statement = interpreter_.statement();
  if (std::exchange(told_statement_, statement) == statement) return;
  const auto& [place, text, command] = program_.statements[statement];
  if (!news_.empty()) news_ += '\n';
  news_ += fmt::format("line {}: {}", place.line, to_text(command, program_.dialect));
}

std::vector<Hazard> hazards_of(const Program& program) {
  std::vector<Hazard> hazards;
  const auto add = [&](Hazard hazard) {
    if (std::ranges::find(hazards, hazard) == hazards.end()) hazards.push_back(hazard);
  };
  for (const auto& [place, text, command] : program.statements) {
    if (std::holds_alternative<parol6::planning::Move>(command)) add(Hazard::kMove);
    if (std::holds_alternative<Output>(command)) add(Hazard::kState);
    if (std::holds_alternative<GripperMove>(command)) add(Hazard::kGrip);
    if (std::holds_alternative<GripperCalibration>(command)) add(Hazard::kGrip);
  }
  return hazards;
}

}  // namespace armjig::script
