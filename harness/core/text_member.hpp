// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armjig {

/// A text in a JSON object of any library that looks like nlohmann's; empty if there is none of
/// that name.
template <class Json>
[[nodiscard]] std::string text_member(const Json& json, const char* key) {
  if (!json.is_object()) return {};
  const auto value = json.value(key, Json{});
  return value.is_string() ? value.template get<std::string>() : std::string{};
}

}  // namespace armjig
