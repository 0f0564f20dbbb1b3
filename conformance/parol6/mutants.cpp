// SPDX-License-Identifier: Apache-2.0
#include "conformance/parol6/mutants.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "emulators/parol6/defects/defects.hpp"

namespace armjig::parol6 {
namespace {

/// Why a mutant is no mutant. A name that ends with `*` stands for all that begin so.
struct Equivalent {
  std::string_view name;
  std::string_view reason;
};
constexpr std::array<Equivalent, 0> kEquivalents{};

bool matches(std::string_view pattern, std::string_view name) noexcept {
  if (!pattern.ends_with('*')) return pattern == name;
  pattern.remove_suffix(1);
  return name.starts_with(pattern);
}

struct Hints {
  std::string_view section;
  std::array<std::string_view, 4> requirements;
};
constexpr std::array kHints{
    Hints{"Telemetry", {"parol6.telemetry", "parol6.jog", "parol6.telemetry", "parol6.frame"}},
    Hints{"Command frame", {"parol6.jog", "parol6.goto", "parol6.command", "parol6.telemetry"}},
    Hints{"Commands", {"parol6.command", "parol6.jog", "parol6.home", "parol6.goto"}},
    Hints{"Jog", {"parol6.jog", "parol6.jog", "parol6.jog", "parol6.jog"}},
    Hints{"Go-to law", {"parol6.goto", "parol6.goto", "parol6.goto", "parol6.goto"}},
    Hints{"Homing", {"parol6.home", "parol6.home", "parol6.home", "parol6.home"}},
    Hints{"Demonstration", {"parol6.demo", "parol6.demo", "parol6.demo", "parol6.demo"}},
    Hints{"Gripper",
          {"parol6.gripper", "parol6.telemetry.gripper", "parol6.passive", "parol6.telemetry"}},
    Hints{"Inputs and outputs",
          {"parol6.io", "parol6.outputs", "parol6.telemetry", "parol6.passive"}},
    Hints{"Timing",
          {"parol6.telemetry.timing", "parol6.timing", "parol6.telemetry.timing", "parol6.timing"}},
    Hints{"Receiving", {"parol6.receive", "parol6.frame", "parol6.loop", "parol6.robust"}},
    Hints{"Link", {"parol6.frame", "parol6.link", "parol6.rate", "parol6.robust"}},
    Hints{"Profile", {"parol6.receive", "parol6.command", "parol6.home", "parol6.gripper"}},
};

}  // namespace

std::vector<Mutant> all_mutants() {
  std::vector<Mutant> all;
  for (auto& fault : all_faults()) {
    Mutant mutant{std::move(fault.name), std::move(fault.section)};
    const auto known = std::ranges::find_if(
        kEquivalents, [&](const Equivalent& one) { return matches(one.name, mutant.name); });
    if (known != kEquivalents.end()) mutant.equivalent = known->reason;
    all.push_back(std::move(mutant));
  }
  return all;
}

std::span<const std::string_view> mutant_hints(std::string_view section) {
  const auto hints = std::ranges::find(kHints, section, &Hints::section);
  if (hints == kHints.end()) return {};
  return hints->requirements;
}

}  // namespace armjig::parol6
