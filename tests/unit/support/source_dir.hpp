// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armjig {

/// The root of the source tree, where recordings, examples and documents lie.
[[nodiscard]] std::string source_dir();

}  // namespace armjig
