// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/mealy/machine.hpp"

namespace armjig::mealy {

/// One place in which a learned machine is not the documented one.
struct Deviation {
  std::string name;      ///< in words for reports: `idle.Freeze`, once in a comparison
  std::string sentence;  ///< what is not as documented
  std::string documented;
  std::string learned;
  Word shown_by;  ///< to a machine that begins anew; its last letter shows it, or leads there
};

struct Comparison {
  /// The documented state that each learned one is; none: nobody wrote it down.
  std::vector<std::optional<std::size_t>> documented;
  std::vector<Deviation> deviations;  ///< empty: the machines are equal
  /// Steps of the learned machine that are not documented so, by state and letter.
  std::set<std::pair<std::size_t, Letter>> steps;
};

/// Both have the same alphabet; the learned one is minimal. If they are not equal, a learned state
/// is the documented one with which most of its answers agree, and most of those after each letter.
[[nodiscard]] Comparison compare(const Machine& learned, const Machine& documented);

/// The learned machine with the documented names of its states.
[[nodiscard]] Machine named(Machine learned, const Machine& documented,
                            const Comparison& comparison);

}  // namespace armjig::mealy
