// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <utility>

#include "harness/script/lines.hpp"

namespace armjig::script {
namespace {

/// Of angles and millimetres: far beyond any arm, and safe to compute with.
constexpr double kLargestNumber = 1e6;
constexpr std::string_view kComment = "//";

template <class T>
using Read = tl::expected<T, Diagnostic>;

auto wrong(Place place, std::string text) {
  return tl::unexpected{Diagnostic{Severity::kError, place, std::move(text)}};
}

/// The arguments of one command, from behind the opening parenthesis.
class Arguments {
 public:
  /// `form` is how the command is written, for messages.
  Arguments(Cursor& cursor, std::string_view form) noexcept : cursor_{cursor}, form_{form} {}

  [[nodiscard]] Place place() {
    cursor_.skip_blanks();
    return cursor_.place();
  }

  /// Passes over the comma in front of all arguments but the first.
  Read<void> next() {
    if (std::exchange(is_first_, false)) return {};
    const auto at = place();
    if (cursor_.take(",")) return {};
    return wrong(at, cursor_.rest().starts_with(')') || cursor_.is_at_end()
                         ? fmt::format("an argument is missing: {}", form_)
                         : fmt::format("there should be ',' or ')' in front of {}: {}",
                                       quoted(cursor_.rest()), form_));
  }

  Read<double> number(double lowest, double highest, std::string_view what) {
    if (auto comma = next(); !comma) return tl::unexpected{comma.error()};
    return value(lowest, highest, what);
  }

  /// A number without the comma in front of it.
  Read<double> value(double lowest, double highest, std::string_view what) {
    const auto at = place();
    if (cursor_.is_at_end() || cursor_.rest().starts_with(')')) {
      return wrong(at, fmt::format("{} is missing: {}", what, form_));
    }
    const auto text = cursor_.take_number();
    if (!text) {
      return wrong(at, fmt::format("{} should be a number like -12.5, not {}", what,
                                   quoted(cursor_.rest())));
    }
    const auto found = value_of(*text);
    if (found >= lowest && found <= highest) return found;
    return wrong(at, fmt::format("{} is {} to {}, not {}", what, lowest, highest, quoted(*text)));
  }

  Read<std::int16_t> integer(std::int16_t lowest, std::int16_t highest, std::string_view what) {
    if (auto comma = next(); !comma) return tl::unexpected{comma.error()};
    const auto at = place();
    const auto found = value(lowest, highest, what);
    if (!found) return tl::unexpected{found.error()};
    if (*found == std::floor(*found)) return static_cast<std::int16_t>(*found);
    return wrong(at, fmt::format("{} is a whole number", what));
  }

  /// Whether another argument comes.
  [[nodiscard]] bool has_more() {
    cursor_.skip_blanks();
    return !cursor_.is_at_end() && !cursor_.rest().starts_with(')');
  }

  [[nodiscard]] std::string_view word() { return cursor_.take_word(); }

  /// Passes over `=`.
  Read<void> equals() {
    const auto at = place();
    if (cursor_.take("=")) return {};
    return wrong(at, fmt::format("there should be '=' in front of {}", quoted(cursor_.rest())));
  }

  Read<void> end() {
    const auto at = place();
    if (cursor_.take(")")) return {};
    return cursor_.is_at_end() ? wrong(at, "the ')' is missing")
                               : wrong(at, fmt::format("too many arguments from {} on: {}",
                                                       quoted(cursor_.rest()), form_));
  }

 private:
  Cursor& cursor_;
  std::string_view form_;
  bool is_first_ = true;
};

std::string_view form_of(Keyword keyword) noexcept {
  switch (keyword) {
    case Keyword::kDelay:
      return "Delay(SECONDS)";
    case Keyword::kOutput:
      return "Output(1|2, HIGH|LOW)";
    case Keyword::kGripper:
      return "Gripper(POSITION, SPEED, CURRENT)";
    case Keyword::kMoveJoint:
      return "MoveJoint(J1, J2, J3, J4, J5, J6 [, v=] [, a=] [, t=] [, trap|poly] [, speed])";
    case Keyword::kMovePose:
      return "MovePose(X, Y, Z, RX, RY, RZ [, v=] [, a=] [, t=] [, trap|poly] [, speed])";
    case Keyword::kMoveCart:
      return "MoveCart(X, Y, Z, RX, RY, RZ [, t=] [, trap|poly] [, speed])";
    case Keyword::kMoveCartRelTrf:
      return "MoveCartRelTRF(X, Y, Z, RX, RY, RZ [, t=] [, trap|poly] [, speed])";
    default:
      return "it takes none";
  }
}

Read<Command> read_delay(Arguments& arguments) {
  return arguments.number(0.01, kLongestTime, "the delay in seconds")
      .map([](double seconds) -> Command { return Delay{seconds}; });
}

Read<Command> read_output(Arguments& arguments) {
  const auto number = arguments.integer(1, 2, "the output");
  if (!number) return tl::unexpected{number.error()};
  if (auto comma = arguments.next(); !comma) return tl::unexpected{comma.error()};
  const auto at = arguments.place();
  const auto word = arguments.word();
  if (word == "HIGH") return Output{*number, Output::Level::kHigh};
  if (word == "LOW") return Output{*number, Output::Level::kLow};
  return wrong(at, fmt::format("the level is HIGH or LOW, not {}", quoted(word)));
}

Read<Command> read_gripper(Arguments& arguments) {
  const auto position = arguments.integer(0, 255, "the position");
  if (!position) return tl::unexpected{position.error()};
  const auto speed = arguments.integer(0, 255, "the speed");
  if (!speed) return tl::unexpected{speed.error()};
  const auto current = arguments.integer(0, parol6::kMaxGripperCurrent.value, "the current in mA");
  if (!current) return tl::unexpected{current.error()};
  return GripperMove{*position, *speed, Milliamperes{*current}};
}

/// What may stand behind the six numbers, in this order.
enum class Option : std::uint8_t { kSpeed, kAcceleration, kTime, kLaw, kTracking, kNone };

Option option_of(std::string_view word) noexcept {
  if (word == "v") return Option::kSpeed;
  if (word == "a") return Option::kAcceleration;
  if (word == "t") return Option::kTime;
  if (word == "trap" || word == "poly") return Option::kLaw;
  return word == "speed" ? Option::kTracking : Option::kNone;
}

bool is_line(parol6::planning::Move::Kind kind) noexcept {
  return kind == parol6::planning::Move::Kind::kLine ||
         kind == parol6::planning::Move::Kind::kToolLine;
}

Read<void> read_value(Arguments& arguments, Option option, parol6::planning::Timing& timing) {
  if (auto equals = arguments.equals(); !equals) return equals;
  const auto read = [&](double lowest, double highest, std::string_view what,
                        std::optional<double>& into) -> Read<void> {
    const auto value = arguments.value(lowest, highest, what);
    if (!value) return tl::unexpected{value.error()};
    into = *value;
    return {};
  };
  if (option == Option::kSpeed) return read(0, 100, "v in percent", timing.speed);
  if (option == Option::kAcceleration) return read(0, 100, "a in percent", timing.acceleration);
  return read(0.01, kLongestTime, "t in seconds", timing.duration);
}

/// Reads one of the options; `last` is the one in front of it.
Read<Option> read_option(Arguments& arguments, parol6::planning::Move& move, Option last) {
  const auto at = arguments.place();
  const auto word = arguments.word();
  const auto option = option_of(word);
  if (option == Option::kNone) {
    return wrong(at, fmt::format("there is no argument {}; there are v=, a=, t=, trap, poly, speed",
                                 quoted(word)));
  }
  const bool is_rate = option == Option::kSpeed || option == Option::kAcceleration;
  if (is_rate && is_line(move.kind)) {
    return wrong(at, fmt::format("a move along a line has no '{}': give t=SECONDS", word));
  }
  if (last != Option::kNone && option <= last) {
    return wrong(at, fmt::format("{} stands here twice or too late: the order is v, a, t, "
                                 "trap or poly, speed",
                                 quoted(word)));
  }
  if (option == Option::kLaw) {
    move.timing.law =
        word == "trap" ? parol6::planning::Law::kTrapezoid : parol6::planning::Law::kPolynomial;
  } else if (option == Option::kTracking) {
    move.tracking = parol6::planning::Tracking::kSpeed;
  } else if (auto value = read_value(arguments, option, move.timing); !value) {
    return tl::unexpected{value.error()};
  }
  return option;
}

Read<Command> read_move(Arguments& arguments, parol6::planning::Move::Kind kind) {
  using Names = std::array<std::string_view, 6>;
  constexpr Names kAngles{"J1", "J2", "J3", "J4", "J5", "J6"};
  constexpr Names kPose{"X", "Y", "Z", "RX", "RY", "RZ"};
  parol6::planning::Move move{.kind = kind};
  const auto& names = kind == parol6::planning::Move::Kind::kJoint ? kAngles : kPose;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto number = arguments.number(-kLargestNumber, kLargestNumber, names[i]);
    if (!number) return tl::unexpected{number.error()};
    move.target[i] = *number;
  }
  auto last = Option::kNone;
  while (arguments.has_more()) {
    if (auto comma = arguments.next(); !comma) return tl::unexpected{comma.error()};
    const auto option = read_option(arguments, move, last);
    if (!option) return tl::unexpected{option.error()};
    last = *option;
  }
  return move;
}

Read<Command> read_command(Keyword keyword, Arguments& arguments) {
  if (const auto kind = move_kind(keyword)) return read_move(arguments, *kind);
  switch (keyword) {
    case Keyword::kBegin:
      return Begin{};
    case Keyword::kEnd:
      return End{};
    case Keyword::kLoop:
      return Loop{};
    case Keyword::kDummy:
      return Dummy{};
    case Keyword::kDelay:
      return read_delay(arguments);
    case Keyword::kOutput:
      return read_output(arguments);
    case Keyword::kGripper:
      return read_gripper(arguments);
    default:
      return GripperCalibration{};
  }
}

Read<const Name*> read_name(Cursor& cursor) {
  const auto at = cursor.place();
  const auto word = cursor.take_word();
  if (const auto* const name = find_name(word)) {
    if (is_implemented(name->keyword)) return name;
    return wrong(at, fmt::format("{} is a name without a meaning: no program of the vendor's "
                                 "implements it",
                                 word));
  }
  if (word.empty()) {
    return wrong(at, fmt::format("a command should stand here, not {}", quoted(cursor.rest())));
  }
  const auto* const similar = find_similar_name(word);
  return wrong(at, similar == nullptr ? fmt::format("there is no command {}", quoted(word))
                                      : fmt::format("there is no command {}; is it {}?",
                                                    quoted(word), similar->text));
}

Read<Statement> read_statement(Cursor& cursor) {
  Statement statement;
  statement.place = cursor.place();
  const auto text = cursor.rest();
  const auto name = read_name(cursor);
  if (!name) return tl::unexpected{name.error()};
  cursor.skip_blanks();
  const auto at = cursor.place();
  if (!cursor.take("(")) return wrong(at, fmt::format("'(' is missing behind {}", (*name)->text));
  Arguments arguments{cursor, form_of((*name)->keyword)};
  auto command = read_command((*name)->keyword, arguments);
  if (!command) return tl::unexpected{command.error()};
  if (auto end = arguments.end(); !end) return tl::unexpected{end.error()};
  statement.command = *std::move(command);
  statement.text = text.substr(0, text.size() - cursor.rest().size());
  cursor.skip_blanks();
  if (cursor.is_at_end() || cursor.rest().starts_with(kComment)) return statement;
  return wrong(cursor.place(),
               fmt::format("a line has one command; this is too much: {}", quoted(cursor.rest())));
}

}  // namespace

ParseResult parse_documented(const Lines& lines) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  Program program{Dialect::kDocumented, {}, {}};
  std::vector<Diagnostic> errors;
  for (const auto& [text, number] : lines) {
    Cursor cursor{text, number};
    if (number == 1) cursor.take(kByteOrderMark);
    cursor.skip_blanks();
    if (cursor.is_at_end() || cursor.rest().starts_with(kComment)) continue;
    auto statement = read_statement(cursor);
    if (!statement) errors.push_back(statement.error());
    if (statement) program.statements.push_back(*std::move(statement));
    if (errors.size() == kMostErrors) break;
  }
  const auto refuse = [](const Statement& statement, std::vector<Diagnostic>& all) {
    all.push_back(
        {Severity::kError, statement.place, "Begin() stands once, in front of all others"});
  };
  const Frame frame{{lines.empty() ? 1 : std::max(lines.back().number, 1), 1},
                    "the first command should be Begin()",
                    "the last command should be End() or Loop()",
                    refuse};
  return checked(std::move(program), frame, std::move(errors));
}

}  // namespace armjig::script
