// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/host/lines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include "harness/wire/steps.hpp"

namespace armjig::kinovazed::programs {
namespace {

constexpr std::size_t kLongestLine = 127;
constexpr std::int64_t kLargestDeflection = 1000;

bool is_printable(char c) noexcept { return c >= ' ' && c <= '~'; }
char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// The line as it may be shown.
std::string shown(std::string_view line) {
  constexpr std::size_t kShown = 40;
  std::string text;
  for (const char c : line.substr(0, kShown)) {
    text +=
        is_printable(c) ? std::string{c} : fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
  }
  return fmt::format("'{}'", line.size() > kShown ? text + "..." : text);
}

/// The word that this one would be with other capitals; empty if none.
std::string_view meant_word(std::string_view line) noexcept {
  const auto word = line.substr(0, line.find(':'));
  const auto* const found = std::ranges::find_if(kVerbNames, [word](std::string_view name) {
    return std::ranges::equal(name, word, {}, lower, lower);
  });
  return found == kVerbNames.end() ? std::string_view{} : *found;
}

void judge_word(std::string_view line, const Complain& complain) {
  if (const auto meant = meant_word(line); !meant.empty()) {
    return complain("kinovazed.host.word-case",
                    fmt::format("{} is written {}", shown(line), meant));
  }
  complain("kinovazed.host.known-words", fmt::format("{} is no command", shown(line)));
}

std::string_view requirement_of(LineFault fault) noexcept {
  switch (fault) {
    case LineFault::kArgumentCount:
      return "kinovazed.host.argument-count";
    case LineFault::kNotAMode:
      return "kinovazed.host.mode-name";
    case LineFault::kNotAnObjective:
      return "kinovazed.host.objective-name";
    case LineFault::kNumberTooLarge:
      return "kinovazed.host.number-range";
    default:
      return "kinovazed.host.number";
  }
}

/// A line that the document does not have. `understood` is what the shipped server makes of it.
void judge_fault(std::string_view line, LineFault fault,
                 const tl::expected<Command, LineFault>& understood, const Complain& complain) {
  const bool is_word_unknown = !understood && understood.error() == LineFault::kUnknownWord;
  if (is_word_unknown) return judge_word(line, complain);
  const bool is_number = fault == LineFault::kNotANumber;
  if (fault == LineFault::kBlank || (understood && !is_number)) {
    return complain("kinovazed.host.bare-line",
                    fmt::format("{} has more than it needs", shown(line)));
  }
  complain(requirement_of(fault), fmt::format("{}: {}", shown(line), describe(fault)));
}

void judge_values(const Command& command, const Complain& complain) {
  if (names_objective(command.verb) &&
      static_cast<std::size_t>(command.objective) >= kDocumentedObjectives) {
    complain("kinovazed.host.objective-documented",
             fmt::format("{} came later", to_string(command.objective)));
  }
  const auto& [x, y, z] = command.deflection;
  for (const std::int64_t value : {x, y, z}) {
    if (std::abs(value) > kLargestDeflection) {
      return complain("kinovazed.host.deflection", fmt::format("a deflection was {}", value));
    }
  }
}

/// A whole line, with its CR.
void judge_line(std::string_view line, const Complain& complain) {
  const bool has_cr = line.ends_with('\r');
  if (has_cr) line.remove_suffix(1);
  if (line.empty() && has_cr) return;
  if (line.empty()) return complain("kinovazed.host.line-empty", "an LF came alone");
  if (!has_cr) {
    complain("kinovazed.host.line-end", fmt::format("{} ended with LF alone", shown(line)));
  }
  const auto strict = decode_command(line, Profile::kDocumented);
  const bool is_ascii = std::ranges::all_of(line, is_printable);
  if (strict && is_ascii) return judge_values(*strict, complain);
  if (!is_ascii) {
    return complain("kinovazed.host.line-ascii", fmt::format("{} came", shown(line)));
  }
  judge_fault(line, strict.error(), decode_command(line, Profile::kFirmware), complain);
}

}  // namespace

void Lines::feed(Bytes bytes, const OnCommand& on_command, const Complain& complain) {
  for_each_step(splitter_, bytes, [&](const LineSplitter::Step& step) {
    if (step.found == LineSplitter::Found::kNothing) return;
    const bool was_endless =
        std::exchange(is_endless_, step.found == LineSplitter::Found::kPieceOfLine);
    if (!was_endless && step.line.size() > kLongestLine) {
      complain("kinovazed.host.line-length",
               fmt::format("{} goes on for {} bytes or more", shown(step.line), step.line.size()));
    }
    if (was_endless || is_endless_) return;
    ++count_;
    const auto understood = decode_command(step.line, Profile::kFirmware);
    if (step.line.size() <= kLongestLine) judge_line(step.line, complain);
    if (understood) on_command(*understood);
  });
}

void Lines::end(const Complain& complain) const {
  if (splitter_.held().empty()) return;
  complain("kinovazed.host.line-finished", fmt::format("{} has no end", shown(splitter_.held())));
}

}  // namespace armjig::kinovazed::programs
