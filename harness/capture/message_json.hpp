// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "harness/wire/dissector.hpp"

namespace armjig {

/// One JSON object on one line, docs/schemas/message.schema.json ("armjig.message/1"), without a
/// line end.
[[nodiscard]] std::string to_json(const Message& message);

}  // namespace armjig
