// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/mutation.hpp"

namespace armjig::parol6 {

/// Every fault that the emulated board can have, and which of them nobody can see.
[[nodiscard]] MutantsEntry mutants_entry() noexcept;

}  // namespace armjig::parol6
