// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "harness/script/program.hpp"

namespace armjig::script {

/// Longer texts are refused unread.
inline constexpr std::size_t kMostBytes = std::size_t{1} << 20;

/// The longest move or delay that is read, in seconds: an hour.
inline constexpr double kLongestTime = 3600;

/// Errors in the order of lines, at least one and at most twenty; whatever the bytes are.
using ParseResult = tl::expected<Program, std::vector<Diagnostic>>;

/// Reads a program. Lines end with LF, CR LF or CR.
[[nodiscard]] ParseResult parse(std::string_view text, Dialect dialect);

}  // namespace armjig::script
