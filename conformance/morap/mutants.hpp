// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/mutation.hpp"

namespace armjig::morap {

/// Every fault that the emulated node can have, and which of them nobody can see.
[[nodiscard]] MutantsEntry mutants_entry() noexcept;

}  // namespace armjig::morap
