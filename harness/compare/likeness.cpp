// SPDX-License-Identifier: Apache-2.0
#include "harness/compare/likeness.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "harness/core/hex.hpp"

namespace armjig {
namespace {

bool are_alike(const Message& one, const Message& other) {
  return one.fault.empty() && other.fault.empty() && !one.fields.empty() &&
         one.name == other.name && one.fields.data() == other.fields.data() &&
         one.fields.size() == other.fields.size();
}

/// Whether bytes that no field describes are the same. Of text, whether a field tells what differs:
/// a word that is no number has no value of its own.
bool is_only_in_fields(const Message& one, const Message& other) {
  if (one.fields.front().place == Place::kPiece) {
    return std::ranges::any_of(one.fields, [&](const Field& field) {
      return field_value(field, one.raw) != field_value(field, other.raw);
    });
  }
  if (one.raw.size() != other.raw.size()) return false;
  for (std::size_t i = 0; i < one.raw.size(); ++i) {
    if (one.raw[i] == other.raw[i]) continue;
    const bool is_described = std::ranges::any_of(one.fields, [i](const Field& field) {
      return i >= field.offset && i < std::size_t{field.offset} + field.width;
    });
    if (!is_described) return false;
  }
  return true;
}

}  // namespace

bool Likeness::is_in_time(const RecordedMessage& one, const RecordedMessage& other) const {
  return std::chrono::abs(one.message.time - other.message.time) <= rules_.time_tolerance;
}

bool Likeness::has_same_content(const RecordedMessage& a, const RecordedMessage& b) const {
  const auto& one = a.message;
  const auto& other = b.message;
  if (one.name != other.name || a.note != b.note || a.rest != b.rest) return false;
  if (one.raw == other.raw) return one.fault == other.fault;
  return are_alike(one, other) && is_only_in_fields(one, other) &&
         std::ranges::all_of(one.fields, [&](const Field& field) {
           return rules_.allows(one.name, field, field_value(field, one.raw),
                                field_value(field, other.raw));
         });
}

std::vector<std::string> Likeness::differences(const RecordedMessage& a,
                                               const RecordedMessage& b) const {
  std::vector<std::string> what;
  if (!is_in_time(a, b)) {
    what.push_back(fmt::format("time: {} us, {} us", microseconds(a.message.time),
                               microseconds(b.message.time)));
  }
  if (a.note != b.note) what.push_back(fmt::format("note: {}, {}", a.note, b.note));
  if (a.rest != b.rest) {
    what.push_back(fmt::format("rest: {}, {}", to_hex(a.rest), to_hex(b.rest)));
  }
  const bool is_same_message =
      a.message.name == b.message.name && a.message.fault == b.message.fault;
  if (has_same_content(a, b) || (is_same_message && a.message.raw == b.message.raw)) return what;
  const auto before = what.size();
  if (are_alike(a.message, b.message)) {
    for (const auto& field : a.message.fields) {
      const auto one = field_value(field, a.message.raw);
      const auto other = field_value(field, b.message.raw);
      if (rules_.allows(a.message.name, field, one, other)) continue;
      what.push_back(
          fmt::format("{}: {}, {}", field.name, field_text(field, one), field_text(field, other)));
    }
  }
  if (what.size() == before) {
    what.push_back(fmt::format("bytes: {}, {}", to_hex(a.message.raw), to_hex(b.message.raw)));
  }
  return what;
}

}  // namespace armjig
