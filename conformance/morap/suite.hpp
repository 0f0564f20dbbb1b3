// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/suite.hpp"

namespace armjig::morap {

/// The MORAP motor nodes, and the programs that are their master.
[[nodiscard]] Suite suite() noexcept;

}  // namespace armjig::morap
