// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/core/quantity.hpp"
#include "harness/motion/parol6/planner.hpp"

/// RBTscript, the programs of the PAROL6 PC software: a command a line, from `Begin()` to `End()`
/// or `Loop()`. No I/O.
namespace armjig::script {

enum class Dialect : std::uint8_t {
  kDocumented,  ///< what the vendor's document shows, made precise
  kCommander,   ///< what the shipped PC program takes, and what it takes it for
};
[[nodiscard]] std::string_view to_string(Dialect dialect) noexcept;

/// Both from 1; columns count bytes.
struct Place {
  int line{};
  int column{};

  friend bool operator==(const Place&, const Place&) = default;
};

enum class Severity : std::uint8_t {
  kNote,
  kWarning,  ///< it runs, but probably not as it was meant
  kError,    ///< it cannot run
};

/// What is to be said about a program: one sentence without a full stop.
struct Diagnostic {
  Severity severity{};
  Place place{};
  std::string text;
};
/// `FILE:3:14: error: there is no command 'Wait'`.
[[nodiscard]] std::string describe(const Diagnostic& diagnostic, std::string_view file);

struct Begin {};
struct End {};
struct Loop {};  ///< goes on behind `Begin()`
struct Dummy {};

/// Waits. The arm stands, frames go on.
struct Delay {
  double seconds{};
};

struct Output {
  enum class Level : std::uint8_t { kLow, kHigh };

  int number{};  ///< 1 or 2
  Level level{};
};

/// Does not wait for the fingers.
struct GripperMove {
  std::int16_t position{};  ///< 0 open to 255 closed
  std::int16_t speed{};     ///< 0 to 255
  Milliamperes current{};
};

/// Does not wait for its end, which is four seconds later at most.
struct GripperCalibration {};

/// A line that the commander lets pass when it loads a program, and finds wrong when it gets there.
struct Flaw {
  enum class Effect : std::uint8_t {
    kStops,    ///< the program ends there
    kSkipped,  ///< goes on with the next line
    kHangs,    ///< repeats the last frame for ever
  };

  Effect effect{};
  std::string why;
};

using Command = std::variant<Begin, End, Loop, Dummy, Delay, Output, GripperMove,
                             GripperCalibration, parol6::planning::Move, Flaw>;

struct Statement {
  Place place{};
  std::string text;  ///< as written, without comment
  Command command;
};

/// Requires of whoever makes one: begins with `Begin`, ends with `End` or `Loop`.
struct Program {
  Dialect dialect{};
  std::vector<Statement> statements;
  std::vector<Diagnostic> remarks;  ///< what was read, but is not what it seems
};

}  // namespace armjig::script
