// SPDX-License-Identifier: Apache-2.0
#include "harness/rig/judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "harness/core/nearest.hpp"

namespace armjig {
namespace {

constexpr std::array<std::string_view, kHazardCount> kHazards{"observe", "state",   "move", "home",
                                                              "grip",    "program", "crash"};

}  // namespace

std::string_view to_string(Hazard hazard) noexcept {
  return kHazards[static_cast<std::size_t>(hazard)];
}

Outcome<Permissions> parse_permissions(std::string_view text) {
  if (text == "all") return Permissions::all();
  Permissions permissions;
  auto rest = text;
  while (!rest.empty()) {
    const auto end = rest.find(',');
    const auto word = rest.substr(0, end);
    const auto found = std::ranges::find(kHazards, word);
    if (found == kHazards.end()) {
      return problem(ErrorCode::kBadValue, "--allow " + std::string{text},
                     did_you_mean(word, kHazards) +
                         "choose from state, move, home, grip, program, crash with commas between "
                         "them, or all");
    }
    permissions.add(static_cast<Hazard>(found - kHazards.begin()));
    rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
  }
  return permissions;
}

std::optional<Refusal> demand(Hazard hazard, const Permissions& permissions,
                              std::string_view what) {
  if (permissions.allow(hazard)) return std::nullopt;
  return Refusal{hazard, fmt::format("{} needs --allow {}", what, to_string(hazard))};
}

}  // namespace armjig
