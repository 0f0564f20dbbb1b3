// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "conformance/mutation.hpp"

namespace armjig::kinovazed {

/// Every fault that the emulated server can have, and which of them nobody can see.
[[nodiscard]] std::vector<Mutant> all_mutants();

[[nodiscard]] std::span<const std::string_view> mutant_hints(std::string_view section);

}  // namespace armjig::kinovazed
