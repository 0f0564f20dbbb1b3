// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/message_json.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "harness/core/hex.hpp"

namespace armjig {

std::string to_json(const Message& message) {
  using Json = nlohmann::ordered_json;
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
  return json.dump();
}

}  // namespace armjig
