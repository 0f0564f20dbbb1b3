// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/suite.hpp"

namespace armjig::parol6 {

/// The PAROL6 control board, and the programs that talk to it.
[[nodiscard]] Suite suite() noexcept;

}  // namespace armjig::parol6
