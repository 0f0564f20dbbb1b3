// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/support/source_dir.hpp"

namespace armjig {

std::string source_dir() { return ARMJIG_SOURCE_DIR; }

}  // namespace armjig
