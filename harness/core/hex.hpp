// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/bytes.hpp"
#include "harness/core/error.hpp"

namespace armjig {

/// Lower-case digits without separators, as golden-trace files have them.
[[nodiscard]] std::string to_hex(Bytes bytes);

/// Upper-case pairs separated by blanks, for people.
[[nodiscard]] std::string to_hex_dump(Bytes bytes);

/// Reads digits of either case. Blanks, tabs, line ends, commas, colons and `0x` prefixes between
/// bytes are passed over. Fails with `kBadHex` (detail: offset of the first character that is
/// neither) or `kOddHex`.
[[nodiscard]] Result<std::vector<std::byte>> from_hex(std::string_view text);

}  // namespace armjig
