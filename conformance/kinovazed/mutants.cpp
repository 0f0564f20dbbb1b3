// SPDX-License-Identifier: Apache-2.0
#include "conformance/kinovazed/mutants.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "emulators/kinovazed/defects/faults.hpp"

namespace armjig::kinovazed {
namespace {

/// Why a mutant is no mutant.
struct Equivalent {
  std::string_view name;
  std::string_view reason;
};
constexpr std::array kEquivalents{
    Equivalent{"late:Unfolded", "how long an arm takes to unfold is not known"},
    Equivalent{"late:Retracted", "how long an arm takes to fold is not known"},
    Equivalent{"first-point:Handle", "its two points are too near for the time to tell"},
    Equivalent{"bit-high:0", "a healthy server always sets bit 0"},
};

struct Hints {
  std::string_view section;
  std::array<std::string_view, 3> requirements;
};
constexpr std::array kHints{
    Hints{"Connections", {"kinovazed.connection", "kinovazed.line", "kinovazed.reply"}},
    Hints{"Lines", {"kinovazed.line", "kinovazed.robust", "kinovazed.reply"}},
    Hints{"Commands", {"kinovazed.console", "kinovazed.state", "kinovazed.line"}},
    Hints{"States", {"kinovazed.state", "kinovazed.state", "kinovazed.state"}},
    Hints{"Replies and events", {"kinovazed.reply", "kinovazed.state", "kinovazed.interrupt"}},
    Hints{"Interrupts and ends", {"kinovazed.event", "kinovazed.interrupt", "kinovazed.state"}},
    Hints{"Heartbeats", {"kinovazed.beat", "kinovazed.state", "kinovazed.connection"}},
    Hints{"Joystick", {"kinovazed.joystick", "kinovazed.mode", "kinovazed.state"}},
    Hints{"Objectives", {"kinovazed.objective", "kinovazed.state", "kinovazed.interrupt"}},
    Hints{"Times", {"kinovazed.beat", "kinovazed.mode", "kinovazed.time"}},
    Hints{"Robustness", {"kinovazed.robust", "kinovazed.line", "kinovazed.reply"}},
};

}  // namespace

std::vector<Mutant> all_mutants() {
  std::vector<Mutant> all;
  for (auto& fault : all_faults()) {
    Mutant mutant{std::move(fault.name), std::move(fault.section)};
    const auto known = std::ranges::find(kEquivalents, mutant.name, &Equivalent::name);
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

}  // namespace armjig::kinovazed
