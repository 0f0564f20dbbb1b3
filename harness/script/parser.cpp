// SPDX-License-Identifier: Apache-2.0
#include "harness/script/parser.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "harness/script/lines.hpp"

namespace armjig::script {
namespace {

bool is_no_text(char c) noexcept {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7F;
}

/// A byte that no text has.
std::optional<Diagnostic> find_binary(const Lines& lines) {
  for (const auto& [text, number] : lines) {
    const auto found = std::ranges::find_if(text, is_no_text);
    if (found == text.end()) continue;
    return Diagnostic{Severity::kError,
                      {number, static_cast<int>(found - text.begin()) + 1},
                      fmt::format("byte 0x{:02X}: this is no text", static_cast<int>(*found))};
  }
  return std::nullopt;
}

}  // namespace

std::string_view to_string(Dialect dialect) noexcept {
  return dialect == Dialect::kDocumented ? "documented" : "commander";
}

std::string describe(const Diagnostic& diagnostic, std::string_view file) {
  constexpr std::array<std::string_view, 3> kSeverities{"note", "warning", "error"};
  return fmt::format("{}:{}:{}: {}: {}", file, diagnostic.place.line, diagnostic.place.column,
                     kSeverities[static_cast<std::size_t>(diagnostic.severity)], diagnostic.text);
}

ParseResult parse(std::string_view text, Dialect dialect) {
  const auto refuse = [](Diagnostic diagnostic) {
    return tl::unexpected{std::vector{std::move(diagnostic)}};
  };
  if (text.size() > kMostBytes) {
    return refuse({Severity::kError, {1, 1}, "longer than 1 MiB: this is no program"});
  }
  const auto lines = split_lines(text);
  if (auto binary = find_binary(lines)) return refuse(*std::move(binary));
  return dialect == Dialect::kDocumented ? parse_documented(lines) : parse_commander(lines);
}

}  // namespace armjig::script
