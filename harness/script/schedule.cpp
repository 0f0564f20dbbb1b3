// SPDX-License-Identifier: Apache-2.0
#include "harness/script/schedule.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/core/hex.hpp"
#include "harness/script/json_line.hpp"

namespace armjig::script {
namespace {

constexpr std::size_t kTickMicroseconds = 10'000;

/// Notes the move that the interpreter has begun, if it is a new one.
void note_move(const ActiveMove* move, Schedule& schedule) {
  if (move == nullptr || move->sent != 1) return;
  schedule.moves.push_back({move->statement, schedule.frames.size(), move->start, move->plan});
}

}  // namespace

tl::expected<Schedule, Diagnostic> schedule(const Program& program,
                                            const InterpreterSettings& settings,
                                            const parol6::JointSteps& from) {
  Schedule result;
  Interpreter interpreter{program, settings};
  auto position = from;
  for (;;) {
    const auto frame = interpreter.next(position);
    const auto* const move = interpreter.move();
    if (!frame) {
      if (move == nullptr) return tl::unexpected{frame.error()};
      result.stop = frame.error();
      return result;
    }
    if (!*frame) return result;
    if (result.frames.size() == kMostFrames) {
      return tl::unexpected{Diagnostic{Severity::kError,
                                       program.statements[interpreter.statement()].place,
                                       "the program takes longer than 10000 s up to here"}};
    }
    note_move(move, result);
    if (move != nullptr && move->sent > 0) position = move->position();
    result.frames.push_back(**frame);
    result.statements.push_back(interpreter.statement());
    result.positions.push_back(position);
  }
}

std::string to_trace(const Schedule& schedule, std::string_view title) {
  auto header = nlohmann::ordered_json{
      {"format", "golden-trace/1"},
      {"device", "parol6"},
      {"title", title},
      {"duration_us", schedule.frames.size() * kTickMicroseconds},
  };
  auto text = json_line(header);
  for (std::size_t i = 0; i < schedule.frames.size(); ++i) {
    text += json_line(nlohmann::ordered_json{{"t_us", i * kTickMicroseconds},
                                             {"dir", "to_device"},
                                             {"hex", to_hex(parol6::encode(schedule.frames[i]))}});
  }
  return text;
}

}  // namespace armjig::script
