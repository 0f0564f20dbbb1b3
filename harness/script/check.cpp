// SPDX-License-Identifier: Apache-2.0
#include "harness/script/check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace armjig::script {
namespace {

/// So long the gripper needs for its calibration.
constexpr double kCalibrationTime = 4;

/// Arguments of a move that do nothing, in a sentence; empty if there are none.
std::string idle_arguments(const parol6::planning::Move& move) {
  using Kind = parol6::planning::Move::Kind;
  const auto& timing = move.timing;
  const bool has_time = timing.duration && *timing.duration > 0;
  if (move.kind == Kind::kLine || move.kind == Kind::kToolLine) {
    return timing.speed || timing.acceleration ? "v and a do nothing on a line" : "";
  }
  if (has_time && (timing.speed || timing.acceleration)) return "v and a do nothing beside t";
  if (has_time) return {};
  if (timing.speed.has_value() != timing.acceleration.has_value()) {
    return "v and a count only together: both are at their defaults";
  }
  return timing.law ? "trap and poly do nothing without t" : "";
}

/// Watches whether a program waits for its gripper, statement by statement.
class GripperWatch {
 public:
  /// What is wrong at this statement, if something is.
  std::optional<Diagnostic> pass(const Statement& statement) {
    if (const auto* const delay = std::get_if<Delay>(&statement.command)) {
      waited_ += delay->seconds;
      return std::nullopt;
    }
    if (!needs_gripper(statement)) return std::nullopt;
    auto found = miss(statement.place);
    if (!std::holds_alternative<parol6::planning::Move>(statement.command))
      begin(statement.command);
    return found;
  }

  /// Whether the gripper should be at rest when this begins.
  static bool needs_gripper(const Statement& statement) {
    return std::holds_alternative<parol6::planning::Move>(statement.command) ||
           std::holds_alternative<GripperMove>(statement.command) ||
           std::holds_alternative<GripperCalibration>(statement.command);
  }

 private:
  enum class Busy { kNo, kMoves, kCalibrates };

  void begin(const Command& command) {
    busy_ = std::holds_alternative<GripperMove>(command) ? Busy::kMoves : Busy::kCalibrates;
    waited_ = 0;
  }

  std::optional<Diagnostic> miss(Place place) {
    const auto was_busy = std::exchange(busy_, Busy::kNo);
    if (was_busy == Busy::kMoves && waited_ == 0) {
      return Diagnostic{Severity::kWarning, place,
                        "the gripper is not waited for: a Delay is missing in front of this"};
    }
    if (was_busy == Busy::kCalibrates && waited_ < kCalibrationTime) {
      return Diagnostic{Severity::kWarning, place,
                        fmt::format("the gripper's calibration takes {:.0f} s, and is given {:.2f}",
                                    kCalibrationTime, waited_)};
    }
    return std::nullopt;
  }

  Busy busy_ = Busy::kNo;
  double waited_ = 0;
};

/// The same of a program that begins anew, where its next pass first needs the gripper.
std::optional<Diagnostic> pass_again(GripperWatch& gripper, const Program& program) {
  const auto is_loop = [](const Statement& statement) {
    return std::holds_alternative<Loop>(statement.command);
  };
  if (std::ranges::none_of(program.statements, is_loop)) return std::nullopt;
  for (const auto& statement : program.statements) {
    auto found = gripper.pass(statement);
    if (found) found->text += ", on the way from Loop";
    if (found || GripperWatch::needs_gripper(statement)) return found;
  }
  return std::nullopt;
}

std::optional<Diagnostic> check_flaw(const Statement& statement) {
  const auto* const flaw = std::get_if<Flaw>(&statement.command);
  if (flaw == nullptr) return std::nullopt;
  const bool goes_on = flaw->effect == Flaw::Effect::kSkipped;
  return Diagnostic{goes_on ? Severity::kWarning : Severity::kError, statement.place,
                    goes_on ? "the commander skips this: " + flaw->why : flaw->why};
}

/// What comes behind the first end of a program.
std::optional<Diagnostic> check_reach(const Program& program) {
  const auto is_end = [](const Statement& statement) {
    return std::holds_alternative<End>(statement.command) ||
           std::holds_alternative<Loop>(statement.command);
  };
  const auto end = std::ranges::find_if(program.statements, is_end);
  if (end == program.statements.end() || end + 1 == program.statements.end()) return std::nullopt;
  return Diagnostic{Severity::kWarning, (end + 1)->place, "this is never reached"};
}

void sort_by_place(std::vector<Diagnostic>& diagnostics) {
  std::ranges::stable_sort(diagnostics, {}, [](const Diagnostic& diagnostic) {
    return std::pair{diagnostic.place.line, diagnostic.place.column};
  });
}

}  // namespace

std::vector<Diagnostic> check(const Program& program) {
  auto found = program.remarks;
  const auto add = [&](std::optional<Diagnostic> diagnostic) {
    if (diagnostic) found.push_back(*std::move(diagnostic));
  };
  GripperWatch gripper;
  for (const auto& statement : program.statements) {
    add(check_flaw(statement));
    add(gripper.pass(statement));
    const auto* const move = std::get_if<parol6::planning::Move>(&statement.command);
    if (move == nullptr) continue;
    if (auto text = idle_arguments(*move); !text.empty()) {
      found.push_back({Severity::kWarning, statement.place, std::move(text)});
    }
  }
  add(pass_again(gripper, program));
  add(check_reach(program));
  sort_by_place(found);
  return found;
}

std::vector<Diagnostic> check(const Program& program, const Schedule& schedule) {
  std::vector<Diagnostic> found;
  for (const auto& move : schedule.moves) {
    for (const auto& note : move.plan.singularities) {
      found.push_back(
          {Severity::kWarning, program.statements[move.statement].place, describe(note)});
    }
  }
  if (schedule.stop) {
    found.push_back(*schedule.stop);
    found.back().text += "; the program ends there";
  }
  sort_by_place(found);
  found.push_back({Severity::kNote, program.statements.back().place,
                   fmt::format("takes {:.2f} s", schedule.seconds())});
  return found;
}

}  // namespace armjig::script
