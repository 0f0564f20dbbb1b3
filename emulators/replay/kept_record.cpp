// SPDX-License-Identifier: Apache-2.0
#include "emulators/replay/kept_record.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace armjig {
namespace {

nlohmann::json member_of(std::string_view event, const char* key) {
  const auto json = nlohmann::json::parse(event, nullptr, /*allow_exceptions=*/false);
  return json.is_object() ? json.value(key, nlohmann::json{}) : nlohmann::json{};
}

std::string event_of(const KeptRecord& record) { return '{' + record.details + '}'; }

}  // namespace

std::string text_in(std::string_view event, const char* key) {
  const auto value = member_of(event, key);
  return value.is_string() ? value.get<std::string>() : std::string{};
}

double real_in(std::string_view event, const char* key, double otherwise) {
  const auto value = member_of(event, key);
  return value.is_number() ? value.get<double>() : otherwise;
}

std::int64_t number_in(std::string_view event, const char* key, std::int64_t otherwise) {
  const auto value = member_of(event, key);
  if (value.is_number_integer()) return value.get<std::int64_t>();
  return value.is_number() ? std::llround(value.get<double>()) : otherwise;
}

std::string text_in(const KeptRecord& record, const char* key) {
  return text_in(event_of(record), key);
}

std::int64_t number_in(const KeptRecord& record, const char* key, std::int64_t otherwise) {
  return number_in(event_of(record), key, otherwise);
}

std::string what_of(const KeptRecord& event) {
  auto name = text_in(event, "dir");
  return name.empty() ? text_in(event, "op") : name;
}

std::string label_of(const KeptRecord& record) {
  return record.kind == LinkKind::kEvents ? what_of(record) : std::string{to_string(record.kind)};
}

bool has_stop(const KeptRecord& record) { return member_of(event_of(record), "stop") != false; }

}  // namespace armjig
