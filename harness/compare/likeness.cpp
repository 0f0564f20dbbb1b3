// SPDX-License-Identifier: Apache-2.0
#include "harness/compare/likeness.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <tuple>

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

Instant begin_of(const RecordedMessage& message) {
  return message.earlier.empty() ? message.message.time : message.earlier.front();
}

}  // namespace

std::optional<Likeness::Times> Likeness::first_apart(const RecordedMessage& one,
                                                     const RecordedMessage& other) const {
  const auto are_near = [this](Times times) {
    return std::chrono::abs(times.first - times.second) <= rules_.time_tolerance;
  };
  const auto& [before, after] = std::tie(one.earlier, other.earlier);
  // In other pieces only the first and the last byte have a time that can be told.
  const auto known = before.size() == after.size() ? before.size() : std::size_t{0};
  for (std::size_t i = 0; i < known; ++i) {
    if (const Times times{before[i], after[i]}; !are_near(times)) return times;
  }
  const Times begins{begin_of(one), begin_of(other)};
  if (!are_near(begins)) return begins;
  const Times ends{one.message.time, other.message.time};
  return are_near(ends) ? std::nullopt : std::optional{ends};
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

bool Likeness::is_among(const RecordedMessage& one,
                        std::span<const RecordedMessage* const> others) const {
  const auto is_comparable = [&](const RecordedMessage* other) {
    return one.note == other->note && one.rest == other->rest &&
           are_alike(one.message, other->message) && is_only_in_fields(one.message, other->message);
  };
  if (others.empty() || !std::ranges::all_of(others, is_comparable)) return false;
  return std::ranges::all_of(one.message.fields, [&](const Field& field) {
    const auto value = field_value(field, one.message.raw);
    bool is_reached = false;
    bool is_exceeded = false;
    for (const auto* const other : others) {
      const auto its = field_value(field, other->message.raw);
      if (rules_.allows(one.message.name, field, value, its)) return true;
      const auto is_less = number_of(field, its) < number_of(field, value);
      (is_less ? is_reached : is_exceeded) = true;
    }
    return !is_state(field) && is_reached && is_exceeded;
  });
}

std::vector<std::string> Likeness::differences(const RecordedMessage& a,
                                               const RecordedMessage& b) const {
  std::vector<std::string> what;
  if (const auto times = first_apart(a, b)) {
    what.push_back(
        fmt::format("time: {} us, {} us", microseconds(times->first), microseconds(times->second)));
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
