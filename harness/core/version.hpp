// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armjig {

/// SemVer of the library, the program and its JSON schemas; CMakeLists.txt has the same.
inline constexpr const char* kVersion = "0.1.0";

}  // namespace armjig
