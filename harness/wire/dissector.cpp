// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/dissector.hpp"

#include <fmt/core.h>

#include "harness/core/hex.hpp"

namespace armjig {
std::string to_text(const Message& message) {
  auto text = fmt::format("{} {}, {} bytes", to_string(message.direction), message.name,
                          message.raw.size());
  if (!message.fault.empty()) text += fmt::format(": {}", message.fault);
  text += fmt::format("\n  {}\n", to_hex_dump(message.raw));
  for (const auto& field : message.fields) {
    if (field.encoding == Encoding::kLiteral) continue;
    text += fmt::format("  {:<18} {}\n", field.name,
                        field_text(field, field_value(field, message.raw)));
  }
  return text;
}

std::vector<std::string> field_differences(std::span<const Field> fields, Bytes expected,
                                           Bytes actual) {
  std::vector<std::string> differences;
  for (const auto& field : fields) {
    const auto end = std::size_t{field.offset} + field.width;
    if (end > expected.size() || end > actual.size()) break;
    const auto wanted = field_value(field, expected);
    const auto got = field_value(field, actual);
    if (wanted == got) continue;
    differences.push_back(fmt::format("{}: expected {}, got {}", field.name,
                                      field_text(field, wanted), field_text(field, got)));
  }
  return differences;
}

}  // namespace armjig
