// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "harness/core/bytes.hpp"
#include "harness/wire/dissector.hpp"

/// Text of many messages. All of it goes to the end of `out`, whose memory serves again.
namespace armjig {

/// In decimal.
void append_number(std::string& out, std::int64_t value);

/// As `to_hex`.
void append_hex(std::string& out, Bytes bytes);

/// As `field_text`.
void append_field_text(std::string& out, const Field& field, std::int64_t value);

/// As `to_line`.
void append_line(std::string& out, const Message& message);
/// The same without the direction.
void append_content(std::string& out, const Message& message);

}  // namespace armjig
