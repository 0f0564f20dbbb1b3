// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <utility>

#include "harness/core/number.hpp"
#include "harness/script/lines.hpp"

namespace armjig::script {
namespace {

/// What the commander does before it runs a program: every `( ... )` becomes `()`, and what comes
/// out has to be a name with its parentheses. Nothing if it is.
std::optional<Diagnostic> check_name(const Line& line) {
  Cursor cursor{line.text, line.number};
  const auto refuse = [&](std::string text) {
    return Diagnostic{Severity::kError, cursor.place(), std::move(text)};
  };
  const auto word = cursor.take_word();
  const auto* const name = find_name(word);
  if (name == nullptr) {
    cursor = Cursor{line.text, line.number};
    const auto blanks = line.text.find_first_not_of(" \t");
    if (blanks == std::string_view::npos) return refuse("a line of blanks is no command here");
    if (blanks > 0) return refuse("blanks in front of a command make it unknown");
    if (cursor.rest().starts_with("//")) return refuse("there are no comments in this dialect");
    return refuse(
        fmt::format("there is no command {}", quoted(word.empty() ? cursor.rest() : word)));
  }
  if (!cursor.take("(")) return refuse(fmt::format("'(' has to follow {} at once", word));
  const auto close = cursor.rest().find(')');
  if (close == std::string_view::npos) return refuse(fmt::format("{} has no ')'", word));
  cursor.skip(close + 1);
  if (cursor.is_at_end()) return std::nullopt;
  return refuse(fmt::format("nothing may follow a command: {}", quoted(cursor.rest())));
}

Flaw stops(std::string why) { return {Flaw::Effect::kStops, std::move(why)}; }
Flaw skipped(std::string why) { return {Flaw::Effect::kSkipped, std::move(why)}; }

std::string_view trimmed(std::string_view text) noexcept {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// A number with blanks around it, with or without exponent.
template <class Value>
std::optional<Value> read_number(std::string_view text) noexcept {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  return whole_text_as<Value>(text);
}

Command read_delay(std::string_view arguments) {
  const auto seconds = read_number<double>(arguments);
  if (!seconds) return stops(fmt::format("the delay {} is no number", quoted(arguments)));
  if (!(*seconds > 0.01)) return stops("a delay is longer than 0.01 s");
  if (*seconds > kLongestTime) return stops("a delay of more than an hour is not planned here");
  return Delay{*seconds};
}

Command read_output(std::string_view arguments) {
  if (arguments == "1,HIGH") return Output{1, Output::Level::kHigh};
  if (arguments == "1,LOW") return Output{1, Output::Level::kLow};
  return stops("only Output(1,HIGH) and Output(1,LOW) work in the commander, without blanks");
}

Command read_gripper(std::string_view arguments) {
  struct Range {
    int lowest;
    int highest;
  };
  constexpr std::array kRanges{Range{0, 255}, Range{0, 255}, Range{100, 1000}};
  std::array<std::int16_t, 3> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto comma = arguments.find(',');
    const bool is_last = i + 1 == values.size();
    if (is_last != (comma == std::string_view::npos)) return skipped("it takes three numbers");
    const auto value = read_number<int>(arguments.substr(0, comma));
    if (!value) return skipped("its arguments are whole numbers");
    if (*value < kRanges[i].lowest || *value > kRanges[i].highest) {
      return skipped(fmt::format("{} is not between {} and {}", *value, kRanges[i].lowest,
                                 kRanges[i].highest));
    }
    values[i] = static_cast<std::int16_t>(*value);
    if (!is_last) arguments.remove_prefix(comma + 1);
  }
  return GripperMove{values[0], values[1], Milliamperes{values[2]}};
}

/// Reads `, KEY = NUMBER` as a whole or not at all.
std::optional<double> take_option(Cursor& cursor, std::string_view key) {
  auto ahead = cursor;
  ahead.skip_blanks();
  if (!ahead.take(",")) return std::nullopt;
  ahead.skip_blanks();
  if (!ahead.take(key)) return std::nullopt;
  ahead.skip_blanks();
  if (!ahead.take("=")) return std::nullopt;
  ahead.skip_blanks();
  const auto number = ahead.take_number();
  if (!number) return std::nullopt;
  cursor = ahead;
  return value_of(*number);
}

bool take_flag(Cursor& cursor, std::string_view word) {
  auto ahead = cursor;
  ahead.skip_blanks();
  if (!ahead.take(",")) return false;
  ahead.skip_blanks();
  if (!ahead.take(word)) return false;
  cursor = ahead;
  return true;
}

/// Six numbers with commas between them; nothing if they are not there.
std::optional<std::array<double, 6>> take_target(Cursor& cursor) {
  std::array<double, 6> target{};
  for (std::size_t i = 0; i < target.size(); ++i) {
    cursor.skip_blanks();
    if (i > 0 && !cursor.take(",")) return std::nullopt;
    cursor.skip_blanks();
    const auto number = cursor.take_number();
    if (!number) return std::nullopt;
    target[i] = value_of(*number);
  }
  return target;
}

/// From behind the opening parenthesis. The commander matches as much of the line as it
/// understands, and never looks at the rest.
Command read_move(parol6::planning::Move::Kind kind, Cursor& cursor,
                  std::vector<Diagnostic>& remarks) {
  constexpr double kLargestNumber = 1e6;
  parol6::planning::Move move{.kind = kind};
  const auto target = take_target(cursor);
  if (!target) return stops("a move begins with six numbers like -12.5");
  move.target = *target;
  move.timing.speed = take_option(cursor, "v");
  move.timing.acceleration = take_option(cursor, "a");
  move.timing.duration = take_option(cursor, "t");
  if (take_flag(cursor, "trap")) {
    move.timing.law = parol6::planning::Law::kTrapezoid;
  } else if (take_flag(cursor, "poly")) {
    move.timing.law = parol6::planning::Law::kPolynomial;
  }
  if (take_flag(cursor, "speed")) move.tracking = parol6::planning::Tracking::kSpeed;
  for (const double value : move.target) {
    if (!(std::abs(value) <= kLargestNumber)) return stops("a number is far beyond any arm");
  }
  if (move.timing.duration && !(*move.timing.duration <= kLongestTime)) {
    return stops("a move of more than an hour is not planned here");
  }
  auto ahead = cursor;
  ahead.skip_blanks();
  if (ahead.rest() != ")") {
    remarks.push_back({Severity::kWarning, cursor.place(),
                       fmt::format("the commander ignores {}", quoted(cursor.rest()))});
  }
  return move;
}

/// Requires that the name check let it pass.
Statement read_statement(const Line& line, std::vector<Diagnostic>& remarks) {
  Cursor cursor{line.text, line.number};
  Statement statement{cursor.place(), std::string{line.text}, {}};
  const auto keyword = find_name(cursor.take_word())->keyword;
  cursor.take("(");
  const auto arguments = cursor.rest().substr(0, cursor.rest().size() - 1);
  if (const auto kind = move_kind(keyword)) {
    statement.command = read_move(*kind, cursor, remarks);
    return statement;
  }
  switch (keyword) {
    case Keyword::kBegin:
      statement.command = Begin{};
      break;
    case Keyword::kEnd:
      statement.command = End{};
      break;
    case Keyword::kLoop:
      statement.command = Loop{};
      break;
    case Keyword::kDummy:
      statement.command = Dummy{};
      break;
    case Keyword::kDelay:
      statement.command = read_delay(arguments);
      break;
    case Keyword::kOutput:
      statement.command = read_output(arguments);
      break;
    case Keyword::kGripper:
      statement.command = read_gripper(arguments);
      break;
    case Keyword::kGripperCalibration:
      statement.command = GripperCalibration{};
      break;
    default:
      statement.command =
          Flaw{Flaw::Effect::kHangs, "the commander has no code for it and hangs there"};
      break;
  }
  return statement;
}

}  // namespace

ParseResult parse_commander(const Lines& lines) {
  Program program{Dialect::kCommander, {}, {}};
  std::vector<Diagnostic> errors;
  for (const auto& line : lines) {
    if (line.text.empty()) continue;
    if (auto error = check_name(line)) {
      errors.push_back(*std::move(error));
      if (errors.size() == kMostErrors) break;
      continue;
    }
    program.statements.push_back(read_statement(line, program.remarks));
  }
  const auto hangs = [](Statement& statement, std::vector<Diagnostic>& /*errors*/) {
    statement.command =
        Flaw{Flaw::Effect::kHangs, "the commander hangs at a Begin() that is not its first line"};
  };
  const Frame frame{
      {1, 1}, "the first line has to be Begin()", "the last line has to be End() or Loop()", hangs};
  return checked(std::move(program), frame, std::move(errors));
}

}  // namespace armjig::script
