// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "harness/wire/dissector.hpp"

namespace armjig {

/// A message in one line without its end: direction, name and fields, or noise with the reason and
/// its bytes. Of a message with many fields those that are 0 are left out.
[[nodiscard]] std::string to_line(const Message& message);

/// The bytes for people; of many only the first, and how many more there are.
[[nodiscard]] std::string to_short_dump(Bytes bytes);

/// The value of a field for people in decimal, and in hexadecimal, as many digits as the field has.
[[nodiscard]] std::string text_in_both(const Field& field, std::int64_t value);

}  // namespace armjig
