// SPDX-License-Identifier: Apache-2.0
// Whatever stands in a program: it is refused at a place that exists and in words that can be
// printed, or it is read, and then its own style does not change it, and it becomes frames or an
// error.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/require.hpp"
#include "harness/motion/parol6/joint_table.hpp"
#include "harness/script/check.hpp"
#include "harness/script/format.hpp"
#include "harness/script/parser.hpp"
#include "harness/script/schedule.hpp"

namespace armjig::fuzz {
namespace {

using script::Diagnostic;
using script::Dialect;

void check_errors(const std::vector<Diagnostic>& errors, std::string_view text) {
  const auto lines = 1 + std::ranges::count_if(text, [](char c) { return c == '\n' || c == '\r'; });
  require(!errors.empty(), "a refusal says why");
  for (const auto& [severity, place, words] : errors) {
    require(severity == script::Severity::kError, "what is refused is an error");
    require(place.line >= 1 && place.line <= lines && place.column >= 1, "an error has a place");
    require(!words.empty() && words.size() < 400, "an error is one sentence");
    require(std::ranges::all_of(words, [](char c) { return c >= 0x20 && c < 0x7F; }),
            "an error can be printed");
  }
}

/// Long programs are legal, but cost time: one is run if what it says takes less than a minute.
bool is_short(const script::Program& program) {
  double seconds = 0;
  for (const auto& statement : program.statements) {
    if (const auto* const delay = std::get_if<script::Delay>(&statement.command)) {
      seconds += delay->seconds;
    }
    if (const auto* const move = std::get_if<parol6::planning::Move>(&statement.command)) {
      seconds += move->timing.duration.value_or(5);
    }
  }
  return seconds < 60;
}

void check_program(std::string_view text, Dialect dialect) {
  const auto program = script::parse(text, dialect);
  if (!program) return check_errors(program.error(), text);
  const auto formatted = script::format(text, dialect);
  require(formatted.has_value(), "what can be read can be formatted");
  require(script::format(*formatted, dialect) == *formatted, "formatting twice changes nothing");
  (void)script::check(*program);
  if (!is_short(*program)) return;
  const auto schedule = script::schedule(*program, {}, parol6::kStandby);
  if (!schedule) return check_errors({schedule.error()}, text);
  require(schedule->statements.size() == schedule->frames.size(), "each frame has its line");
  require(!script::check(*program, *schedule).empty(), "a schedule has a length");
}

}  // namespace
}  // namespace armjig::fuzz

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  armjig::fuzz::check_program(text, armjig::script::Dialect::kDocumented);
  armjig::fuzz::check_program(text, armjig::script::Dialect::kCommander);
  return 0;
}
