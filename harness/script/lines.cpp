// SPDX-License-Identifier: Apache-2.0
#include "harness/script/lines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <system_error>
#include <utility>

namespace armjig::script {
namespace {

constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
constexpr char lower(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
constexpr bool is_word(char c) noexcept {
  return is_digit(c) || c == '_' || (lower(c) >= 'a' && lower(c) <= 'z');
}

constexpr std::array kNames{
    Name{"Begin", Keyword::kBegin},
    Name{"End", Keyword::kEnd},
    Name{"Loop", Keyword::kLoop},
    Name{"Dummy", Keyword::kDummy},
    Name{"Delay", Keyword::kDelay},
    Name{"Output", Keyword::kOutput},
    Name{"Gripper", Keyword::kGripper},
    Name{"Gripper_cal", Keyword::kGripperCalibration},
    Name{"MoveJoint", Keyword::kMoveJoint},
    Name{"MovePose", Keyword::kMovePose},
    Name{"MoveCart", Keyword::kMoveCart},
    Name{"MoveCartRelTRF", Keyword::kMoveCartRelTrf},
    Name{"Home", Keyword::kHome},
    Name{"Input", Keyword::kInput},
    Name{"SpeedJoint", Keyword::kSpeedJoint},
};

void check_frame(std::vector<Statement>& statements, const Frame& frame,
                 std::vector<Diagnostic>& errors) {
  const auto add = [&](Place place, std::string_view text) {
    errors.push_back({Severity::kError, place, std::string{text}});
  };
  if (statements.empty()) return add(frame.if_empty, "there is no command in it");
  if (!std::holds_alternative<Begin>(statements.front().command)) {
    add(statements.front().place, frame.first);
  }
  for (std::size_t i = 1; i < statements.size(); ++i) {
    if (!std::holds_alternative<Begin>(statements[i].command)) continue;
    frame.late_begin(statements[i], errors);
  }
  const auto& last = statements.back();
  if (!std::holds_alternative<End>(last.command) && !std::holds_alternative<Loop>(last.command)) {
    add(last.place, frame.last);
  }
}

}  // namespace

void Cursor::skip_blanks() noexcept {
  while (take(" ") || take("\t")) {
  }
}

bool Cursor::take(std::string_view word) noexcept {
  if (!rest().starts_with(word)) return false;
  skip(word.size());
  return true;
}

std::string_view Cursor::take_word() noexcept {
  const auto left = rest();
  const auto end = std::ranges::find_if_not(left, is_word);
  const auto size = static_cast<std::size_t>(end - left.begin());
  skip(size);
  return left.substr(0, size);
}

std::optional<std::string_view> Cursor::take_number() noexcept {
  const auto left = rest();
  std::size_t end = left.starts_with('-') ? 1 : 0;
  const auto take_digits = [&] {
    const auto begin = end;
    while (end < left.size() && is_digit(left[end])) ++end;
    return end > begin;
  };
  if (!take_digits()) return std::nullopt;
  const auto whole = end;
  if (end < left.size() && left[end] == '.') {
    ++end;
    if (!take_digits()) end = whole;
  }
  skip(end);
  return left.substr(0, end);
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string out = "'";
  for (const char c : text.substr(0, kMost)) {
    const auto byte = static_cast<unsigned char>(c);
    out += byte >= 0x20 && byte < 0x7F ? std::string(1, c) : fmt::format("\\x{:02X}", byte);
  }
  return out + (text.size() > kMost ? "...'" : "'");
}

Lines split_lines(std::string_view text) {
  Lines lines;
  for (int number = 1; !text.empty(); ++number) {
    const auto end = text.find_first_of("\r\n");
    lines.push_back({text.substr(0, end), number});
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + (text.substr(end).starts_with("\r\n") ? 2 : 1));
  }
  return lines;
}

const Name* find_name(std::string_view text) noexcept {
  const auto* const name = std::ranges::find(kNames, text, &Name::text);
  return name == kNames.end() ? nullptr : name;
}

const Name* find_similar_name(std::string_view text) noexcept {
  const auto* const name = std::ranges::find_if(kNames, [text](const Name& candidate) {
    return std::ranges::equal(candidate.text, text, {}, lower, lower);
  });
  return name == kNames.end() ? nullptr : name;
}

std::optional<parol6::planning::Move::Kind> move_kind(Keyword keyword) noexcept {
  using Kind = parol6::planning::Move::Kind;
  switch (keyword) {
    case Keyword::kMoveJoint:
      return Kind::kJoint;
    case Keyword::kMovePose:
      return Kind::kPose;
    case Keyword::kMoveCart:
      return Kind::kLine;
    case Keyword::kMoveCartRelTrf:
      return Kind::kToolLine;
    default:
      return std::nullopt;
  }
}

double value_of(std::string_view number) noexcept {
  double value = 0;
  const auto read = std::from_chars(number.data(), number.data() + number.size(), value);
  if (read.ec == std::errc{}) return value;
  return number.starts_with('-') ? -std::numeric_limits<double>::infinity()
                                 : std::numeric_limits<double>::infinity();
}

ParseResult checked(Program program, const Frame& frame, std::vector<Diagnostic> errors) {
  if (errors.empty()) check_frame(program.statements, frame, errors);
  if (!errors.empty()) return tl::unexpected{std::move(errors)};
  return program;
}

}  // namespace armjig::script
