// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/mealy/machine.hpp"

namespace armjig::mealy {

/// What a document says of a state and a letter. The first row that fits counts.
struct Row {
  std::string_view from;    ///< empty: of all states
  std::string_view letter;  ///< empty: of all letters
  std::string_view said;    ///< empty: nothing
  std::string_view to;      ///< empty: it stays
};

/// A machine as a document has it: a table from its first state on.
struct Table {
  std::string_view first;
  std::span<const Row> rows;
};

/// The machine of several tables, each of which hears all letters; most devices have one. What they
/// say is one after the other with `, ` between, the names of states with ` + `. States that no
/// word leads to are left out. Problems: `kBadValue` if a state and a letter have no row, or a row
/// is of a letter that there is not; `where` is for messages.
[[nodiscard]] Outcome<Machine> documented(std::span<const Table> tables,
                                          const std::vector<std::string>& letters,
                                          const std::string& where);

}  // namespace armjig::mealy
