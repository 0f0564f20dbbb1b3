// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "conformance/mutation.hpp"

namespace armjig::demo {

/// Faults of each field of a reply, and of replies as a whole.
[[nodiscard]] std::vector<Mutant> all_mutants();

[[nodiscard]] std::span<const std::string_view> mutant_hints(std::string_view section);

}  // namespace armjig::demo
