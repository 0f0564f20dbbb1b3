// SPDX-License-Identifier: Apache-2.0
#include "harness/script/check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "harness/motion/parol6/joint_table.hpp"
#include "harness/rig/parol6_judge.hpp"

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

/// The fastest set-point beyond what its joint can do. The commander looks at few of them.
std::string overspeed(const ScheduledMove& move) {
  std::size_t worst = 0;
  double most = 1;
  std::int32_t speed = 0;
  for (const auto& point : move.plan.set_points) {
    for (std::size_t j = 0; j < parol6::kJointCount; ++j) {
      const double share =
          std::abs(point.speed[j].value) / static_cast<double>(parol6::kJoints[j].max_speed.value);
      if (share <= most) continue;
      most = share;
      worst = j;
      speed = point.speed[j].value;
    }
  }
  if (speed == 0) return {};
  return fmt::format("j{} is told {} steps/s, it can do {}", worst + 1, speed,
                     parol6::kJoints[worst].max_speed.value);
}

/// What is odd about a move that was planned.
std::vector<std::string> doubts_of(const ScheduledMove& move) {
  std::vector<std::string> found;
  if (auto text = overspeed(move); !text.empty()) found.push_back(std::move(text));
  const bool stands = std::ranges::all_of(
      move.plan.set_points, [&](const auto& point) { return point.position == move.start; });
  if (stands && !move.plan.stop) {
    found.push_back(
        fmt::format("the joints are there already: they are held for {:.2f} s",
                    parol6::planning::kTick * static_cast<double>(move.plan.set_points.size())));
  }
  if (move.plan.turns_long_way) {
    found.emplace_back("the commander turns the tool the long way round on this line");
  }
  return found;
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
    const auto place = program.statements[move.statement].place;
    for (const auto& note : move.plan.singularities) {
      found.push_back({Severity::kWarning, place, describe(note)});
    }
    for (auto& text : doubts_of(move))
      found.push_back({Severity::kWarning, place, std::move(text)});
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

namespace {

using parol6::planning::Move;

/// A move that ends where it says, wherever it begins.
bool has_an_end_of_its_own(const Statement& statement) {
  const auto* const move = std::get_if<Move>(&statement.command);
  return move != nullptr && (move->kind == Move::Kind::kJoint || move->kind == Move::Kind::kPose);
}

/// Each costs the planning of all that comes before it.
constexpr std::size_t kMostFurtherErrors = 19;

/// What stands in the way of further moves of a program that could not be planned: `wrong` and what
/// would begin where that ends is left out, as often as there is something.
std::vector<Diagnostic> further_errors(Program program, Diagnostic wrong,
                                       const InterpreterSettings& settings,
                                       const parol6::JointSteps& from) {
  std::vector<Diagnostic> errors;
  auto& statements = program.statements;
  while (errors.size() < kMostFurtherErrors) {
    const auto first = std::ranges::find(statements, wrong.place, &Statement::place);
    if (first == statements.end() || !std::holds_alternative<Move>(first->command)) return errors;
    const auto last = std::find_if(first + 1, statements.end(), has_an_end_of_its_own);
    const auto moves = std::remove_if(first, last, [](const Statement& each) {
      return std::holds_alternative<Move>(each.command);
    });
    statements.erase(moves, last);
    const auto planned = schedule(program, settings, from);
    if (planned) return errors;
    errors.push_back(wrong = planned.error());
  }
  return errors;
}

}  // namespace

Inspection inspect(const Program& program, const InterpreterSettings& settings,
                   const parol6::JointSteps& from) {
  Inspection result{.schedule = {}, .found = check(program)};
  const auto is_error = [](const Diagnostic& one) { return one.severity == Severity::kError; };
  if (std::ranges::any_of(result.found, is_error)) return result;
  auto planned = schedule(program, settings, from);
  if (!planned) {
    result.found.push_back(planned.error());
    std::ranges::copy(further_errors(program, planned.error(), settings, from),
                      std::back_inserter(result.found));
    return result;
  }
  std::ranges::copy(check(program, *planned), std::back_inserter(result.found));
  result.schedule = *std::move(planned);
  return result;
}

std::optional<Diagnostic> check_guarded(const Program& program, const Schedule& schedule,
                                        const parol6::JointSteps& from, std::uint8_t homed) {
  const auto judge = parol6::rig::make_judge();
  parol6::TelemetryFrame telemetry{
      .position = from, .homed = homed, .io = parol6::io_flag::kEstopReleased};
  for (std::size_t i = 0; i < schedule.frames.size(); ++i) {
    const auto& frame = schedule.frames[i];
    judge->set_time(Instant{} + i * parol6::kFramePeriod);
    judge->observe(encode(telemetry));
    auto reason = judge->must_stop();
    if (!reason) {
      if (auto refusal = judge->judge(encode(frame), Permissions::all())) reason = refusal->reason;
    }
    if (reason) {
      return Diagnostic{Severity::kError, program.statements[schedule.statements[i]].place,
                        "the guard would not let it through: " + *reason};
    }
    telemetry.position = schedule.positions[i];
    telemetry.echo = frame.command;
  }
  return std::nullopt;
}

}  // namespace armjig::script
