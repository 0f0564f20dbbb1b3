// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/script/parser.hpp"

/// What both readers share. Not for users.
namespace armjig::script {

/// Goes through one line.
class Cursor {
 public:
  Cursor(std::string_view line, int number) noexcept : text_{line}, line_{number} {}

  [[nodiscard]] std::string_view rest() const noexcept { return text_.substr(at_); }
  [[nodiscard]] bool is_at_end() const noexcept { return at_ == text_.size(); }
  [[nodiscard]] Place place() const noexcept { return {line_, static_cast<int>(at_) + 1}; }

  void skip(std::size_t count) noexcept { at_ += count; }
  void skip_blanks() noexcept;
  /// Passes over `word` if it comes next.
  bool take(std::string_view word) noexcept;
  /// The letters, digits and underscores that come next.
  std::string_view take_word() noexcept;
  /// `["-"] digits ["." digits]`, as far as it goes; nothing, and stays, if there is none.
  std::optional<std::string_view> take_number() noexcept;

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_;
};

/// `text`, cut to a readable length, what is not printable ASCII as `\x1B`, in single quotes.
[[nodiscard]] std::string quoted(std::string_view text);

/// What a name in front of a parenthesis begins. The vendor's program knows three names that it
/// never implemented.
enum class Keyword : std::uint8_t {
  kBegin,
  kEnd,
  kLoop,
  kDummy,
  kDelay,
  kOutput,
  kGripper,
  kGripperCalibration,
  kMoveJoint,
  kMovePose,
  kMoveCart,
  kMoveCartRelTrf,
  kHome,
  kInput,
  kSpeedJoint,
};
struct Name {
  std::string_view text;
  Keyword keyword{};
};
[[nodiscard]] const Name* find_name(std::string_view text) noexcept;
/// One that differs only in upper and lower case.
[[nodiscard]] const Name* find_similar_name(std::string_view text) noexcept;

[[nodiscard]] constexpr bool is_implemented(Keyword keyword) noexcept {
  return keyword < Keyword::kHome;
}
/// The kind of a move; nothing if it is none.
[[nodiscard]] std::optional<parol6::planning::Move::Kind> move_kind(Keyword keyword) noexcept;

/// The value of a number as `take_number` finds it; infinite if it is too large.
[[nodiscard]] double value_of(std::string_view number) noexcept;

/// Without its end.
struct Line {
  std::string_view text;
  int number{};
};
using Lines = std::vector<Line>;
[[nodiscard]] Lines split_lines(std::string_view text);

/// What a dialect says of the commands that a program has to begin and to end with.
struct Frame {
  Place if_empty;  ///< where it says that there is no command
  std::string_view first;
  std::string_view last;
  /// Gets each `Begin()` that is not the first command.
  std::function<void(Statement&, std::vector<Diagnostic>& errors)> late_begin;
};
/// The program unless there are errors, or would be with those of its frame.
[[nodiscard]] ParseResult checked(Program program, const Frame& frame,
                                  std::vector<Diagnostic> errors);

inline constexpr std::size_t kMostErrors = 20;

[[nodiscard]] ParseResult parse_documented(const Lines& lines);
[[nodiscard]] ParseResult parse_commander(const Lines& lines);

}  // namespace armjig::script
