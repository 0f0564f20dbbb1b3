// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/mealy/drawing.hpp"

/// A machine as drawings tell it. Nothing here is for users of the library.
namespace armjig::mealy {

/// Steps between two states, in one line for each thing that is said.
struct Arrow {
  std::size_t from{};
  std::size_t to{};
  std::vector<std::string> lines{};  ///< `A, B / what is said`
  bool is_marked = false;            ///< it deviates
};

struct ToldMachine {
  std::vector<Arrow> arrows;
  std::vector<std::vector<std::string>> notes;  ///< of each state: steps that need no arrow
  std::vector<bool> is_marked;                  ///< of each state: nobody wrote it down
};

[[nodiscard]] ToldMachine told(const Drawing& drawing);

}  // namespace armjig::mealy
