// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "harness/core/hex.hpp"
#include "harness/wire/dissector.hpp"

namespace armjig {

/// docs/schemas/message.schema.json ("armjig.message/1"). `Json` is the library's.
template <class Json>
[[nodiscard]] Json message_object(const Message& message) {
  Json json{{"schema", "armjig.message/1"},
            {"t_us", microseconds(message.time)},
            {"direction", to_string(message.direction)},
            {"message", message.name},
            {"hex", to_hex(message.raw)}};
  if (!message.fault.empty()) json["fault"] = message.fault;
  for (const auto& field : message.fields) {
    const auto value = field_value(field, message.raw);
    Json entry{{"value", value}, {"text", field_text(field, value)}};
    if (!field.unit.empty()) entry["unit"] = field.unit;
    json["fields"][std::string{field.name}] = std::move(entry);
  }
  return json;
}

/// The same on one line, without a line end.
void append_json(std::string& out, const Message& message);
[[nodiscard]] std::string to_json(const Message& message);

}  // namespace armjig
