// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/mutation.hpp"

namespace armjig::demo {

/// Faults of each field of a reply.
[[nodiscard]] MutantsEntry mutants_entry() noexcept;

}  // namespace armjig::demo
