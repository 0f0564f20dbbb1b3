// SPDX-License-Identifier: Apache-2.0
#include "harness/script/format.hpp"

#include <fmt/core.h>

#include "harness/script/lines.hpp"
#include "harness/script/parser.hpp"

namespace armjig::script {
namespace {

/// As short as it can be without losing anything, and without an exponent, which has no place here.
std::string to_text(double number) {
  auto text = fmt::format("{}", number);
  if (text.find('e') == std::string::npos) return text;
  text = fmt::format("{:.20f}", number);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

/// Prints commands, with `comma` between arguments.
class Printer {
 public:
  explicit Printer(std::string_view comma) : comma_{comma} {}

  std::string operator()(const Begin& /*begin*/) const { return "Begin()"; }
  std::string operator()(const End& /*end*/) const { return "End()"; }
  std::string operator()(const Loop& /*loop*/) const { return "Loop()"; }
  std::string operator()(const Dummy& /*dummy*/) const { return "Dummy()"; }
  std::string operator()(const GripperCalibration& /*calibration*/) const {
    return "Gripper_cal()";
  }
  std::string operator()(const Flaw& /*flaw*/) const { return {}; }
  std::string operator()(const Delay& delay) const {
    return fmt::format("Delay({})", to_text(delay.seconds));
  }
  std::string operator()(const Output& output) const {
    return fmt::format("Output({}{}{})", output.number, comma_,
                       output.level == Output::Level::kHigh ? "HIGH" : "LOW");
  }
  std::string operator()(const GripperMove& gripper) const {
    return fmt::format("Gripper({}{}{}{}{})", gripper.position, comma_, gripper.speed, comma_,
                       gripper.current.value);
  }
  std::string operator()(const parol6::planning::Move& move) const {
    auto text = fmt::format("{}({}", name_of(move.kind), to_text(move.target[0]));
    const auto add = [&](const std::string& argument) { text.append(comma_).append(argument); };
    for (std::size_t i = 1; i < move.target.size(); ++i) add(to_text(move.target[i]));
    const auto& timing = move.timing;
    if (timing.speed) add("v=" + to_text(*timing.speed));
    if (timing.acceleration) add("a=" + to_text(*timing.acceleration));
    if (timing.duration) add("t=" + to_text(*timing.duration));
    if (timing.law) add(*timing.law == parol6::planning::Law::kTrapezoid ? "trap" : "poly");
    if (move.tracking == parol6::planning::Tracking::kSpeed) add("speed");
    return text + ')';
  }

 private:
  static std::string_view name_of(parol6::planning::Move::Kind kind) noexcept {
    using Kind = parol6::planning::Move::Kind;
    switch (kind) {
      case Kind::kJoint:
        return "MoveJoint";
      case Kind::kPose:
        return "MovePose";
      case Kind::kLine:
        return "MoveCart";
      case Kind::kToolLine:
        break;
    }
    return "MoveCartRelTRF";
  }

  std::string_view comma_;
};

std::string_view without_blanks_behind(std::string_view text) noexcept {
  const auto last = text.find_last_not_of(" \t");
  return last == std::string_view::npos ? std::string_view{} : text.substr(0, last + 1);
}

std::string_view without_blanks_in_front(std::string_view text) noexcept {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

/// A line in one style. `statement` is what stands in it, if anything does.
std::string line_of(std::string_view line, const Statement* statement, Dialect dialect) {
  if (statement == nullptr) {
    return std::string{without_blanks_in_front(without_blanks_behind(line))};
  }
  auto text = to_text(statement->command, dialect);
  if (text.empty()) return statement->text;
  const auto end = static_cast<std::size_t>(statement->place.column) - 1 + statement->text.size();
  const auto comment = without_blanks_in_front(without_blanks_behind(line.substr(end)));
  return comment.empty() ? text : fmt::format("{}  {}", text, comment);
}

}  // namespace

std::string to_text(const Command& command, Dialect dialect) {
  return std::visit(Printer{dialect == Dialect::kDocumented ? ", " : ","}, command);
}

tl::expected<std::string, std::vector<Diagnostic>> format(std::string_view text, Dialect dialect) {
  const auto program = parse(text, dialect);
  if (!program) return tl::unexpected{program.error()};
  std::string out;
  auto statement = program->statements.begin();
  bool is_after_blank = true;
  for (const auto& [line, number] : split_lines(text)) {
    const bool has_statement =
        statement != program->statements.end() && statement->place.line == number;
    const auto formatted = line_of(line, has_statement ? &*statement : nullptr, dialect);
    if (has_statement) ++statement;
    const bool is_blank = formatted.empty();
    if (is_blank && (is_after_blank || dialect == Dialect::kCommander)) continue;
    is_after_blank = is_blank;
    out += formatted + '\n';
  }
  if (out.ends_with("\n\n")) out.pop_back();
  return out;
}

}  // namespace armjig::script
