// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace armjig {

/// How deep arrays and objects of a file may be nested. Parsers and trees recurse, and a stack has
/// an end; files of ours need five levels.
inline constexpr std::size_t kDeepestNesting = 64;
inline constexpr std::string_view kTooDeep = "it is nested more than 64 levels deep";

/// Whether a text nests deeper than that if it is JSON. Of what is no JSON nothing is promised but
/// that a parser, which stops at the first mistake, does not get deeper either.
[[nodiscard]] bool is_too_deep(std::string_view json) noexcept;

}  // namespace armjig
