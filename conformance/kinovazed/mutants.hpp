// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/mutation.hpp"

namespace armjig::kinovazed {

/// Every fault that the emulated server can have, and which of them nobody can see.
[[nodiscard]] MutantsEntry mutants_entry() noexcept;

}  // namespace armjig::kinovazed
