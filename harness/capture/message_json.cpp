// SPDX-License-Identifier: Apache-2.0
#include "harness/capture/message_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/wire/append_text.hpp"

namespace armjig {
namespace {

bool is_plain(char c) noexcept { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; }

void append_string(std::string& out, std::string_view text) {
  if (!std::ranges::all_of(text, is_plain)) {
    out += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return;
  }
  out += '"';
  out += text;
  out += '"';
}

/// The text of a number is plain as far as the field list is.
void append_field(std::string& out, const Field& field, std::int64_t value) {
  append_string(out, field.name);
  out += R"(:{"value":)";
  append_number(out, value);
  out += R"(,"text":")";
  const auto begin = out.size();
  append_field_text(out, field, value);
  if (!std::all_of(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end(), is_plain)) {
    const auto text = out.substr(begin);
    out.resize(begin - 1);
    append_string(out, text);
  } else {
    out += '"';
  }
  if (!field.unit.empty()) {
    out += R"(,"unit":)";
    append_string(out, field.unit);
  }
  out += '}';
}

}  // namespace

void append_json(std::string& out, const Message& message) {
  out += R"({"schema":"armjig.message/1","t_us":)";
  append_number(out, microseconds(message.time));
  out += R"(,"direction":)";
  append_string(out, to_string(message.direction));
  out += R"(,"message":)";
  append_string(out, message.name);
  out += R"(,"hex":")";
  append_hex(out, message.raw);
  out += '"';
  if (!message.fault.empty()) {
    out += R"(,"fault":)";
    append_string(out, message.fault);
  }
  if (!message.fields.empty()) {
    out += R"(,"fields":)";
    char separator = '{';
    for (const auto& field : message.fields) {
      out += std::exchange(separator, ',');
      append_field(out, field, field_value(field, message.raw));
    }
    out += '}';
  }
  out += '}';
}

std::string to_json(const Message& message) {
  std::string text;
  append_json(text, message);
  return text;
}

}  // namespace armjig
