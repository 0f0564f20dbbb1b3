// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/kept_record.hpp"

#include <nlohmann/json.hpp>

namespace armjig {
namespace {

nlohmann::json member_of(const KeptRecord& record, const char* key) {
  const auto json =
      nlohmann::json::parse('{' + record.details + '}', nullptr, /*allow_exceptions=*/false);
  return json.is_object() ? json.value(key, nlohmann::json{}) : nlohmann::json{};
}

}  // namespace

std::string text_in(const KeptRecord& record, const char* key) {
  const auto value = member_of(record, key);
  return value.is_string() ? value.get<std::string>() : std::string{};
}

std::int64_t number_in(const KeptRecord& record, const char* key, std::int64_t otherwise) {
  const auto value = member_of(record, key);
  return value.is_number_integer() ? value.get<std::int64_t>() : otherwise;
}

bool has_stop(const KeptRecord& record) { return member_of(record, "stop") != false; }

}  // namespace armjig
