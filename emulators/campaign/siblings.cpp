// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/siblings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace armjig::campaign {
namespace {

struct Numbered {
  std::string_view stem;
  std::string_view number;  ///< empty: it has none
};
Numbered numbered(std::string_view name) {
  const auto last = name.find_last_not_of("0123456789");
  const auto size = last == name.npos ? 0 : last + 1;
  return {name.substr(0, size), name.substr(size)};
}

/// The fields of a record that is one whole message, and its bytes as these count them.
struct Whole {
  Message message;
  std::size_t head{};  ///< bytes in front that the record has not
};
std::optional<Whole> whole_in(const KeptRecord& record, MakeDissector make_dissector) {
  const auto dissector = make_dissector();
  auto messages = messages_in(record, *dissector);
  if (messages.size() != 1 || !messages.front().fault.empty()) return std::nullopt;
  const std::size_t head = record.kind == LinkKind::kBus ? 1 : 0;
  if (messages.front().raw.size() != record.bytes.size() + head) return std::nullopt;
  return Whole{std::move(messages.front()), head};
}

/// Numbers that its fields end with.
void add_numbers(const Message& message, std::set<std::string, std::less<>>& numbers) {
  for (const auto& field : message.fields) {
    const auto number = numbered(field.name).number;
    if (!number.empty()) numbers.emplace(number);
  }
}

void exchange(Message& message, std::string_view one, std::string_view other) {
  for (const auto& field : message.fields) {
    const auto name = numbered(field.name);
    if (name.number != one || field.place != Place::kBytes) continue;
    const auto sibling = std::ranges::find_if(message.fields, [&](const Field& candidate) {
      const auto [stem, number] = numbered(candidate.name);
      return stem == name.stem && number == other;
    });
    if (sibling == message.fields.end()) continue;
    const auto value = field_value(field, message.raw);
    set_field_value(field, message.raw, field_value(*sibling, message.raw));
    set_field_value(*sibling, message.raw, value);
  }
}

/// What is said of a part: `position.j1 -985 steps; speed.j1 0` has -985 for `position.j1`.
std::optional<double> number_of(std::string_view text, std::string_view part) {
  const auto place = text.find(std::string{part} + " ");
  if (place == text.npos) return std::nullopt;
  const auto digits = text.substr(place + part.size() + 1);
  double number{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{}) return std::nullopt;
  return number;
}

bool is_near(double one, double other) {
  constexpr double kNear = 0.05;
  return std::fabs(one - other) <= kNear * std::max(std::fabs(one), std::fabs(other));
}

struct Wrong {
  double expected{};
  double actual{};
};
bool are_alike(const Wrong& one, const Wrong& other) {
  if (is_near(one.actual - one.expected, other.actual - other.expected)) return true;
  return one.expected != 0 && other.expected != 0 &&
         is_near(one.actual / one.expected, other.actual / other.expected);
}

/// By the stem of each part that is a number.
std::map<std::string_view, Wrong> wrongs_of(const Symptom& symptom) {
  std::map<std::string_view, Wrong> wrongs;
  for (const auto& part : symptom.parts) {
    const auto expected = number_of(symptom.expected, part);
    const auto actual = number_of(symptom.actual, part);
    if (expected && actual) wrongs.emplace(numbered(part).stem, Wrong{*expected, *actual});
  }
  return wrongs;
}

}  // namespace

std::vector<Script> for_siblings(const Script& script, std::string_view part,
                                 MakeDissector make_dissector,
                                 void (*seal)(std::span<std::byte> message)) {
  const auto own = numbered(part).number;
  if (own.empty()) return {};
  std::map<std::size_t, Whole> wholes;
  std::set<std::string, std::less<>> numbers;
  for (std::size_t i = 0; i < script.size(); ++i) {
    if (auto whole = whole_in(script[i], make_dissector)) {
      add_numbers(whole->message, numbers);
      wholes.emplace(i, *std::move(whole));
    }
  }
  std::vector<Script> others;
  for (const auto& number : numbers) {
    if (number == own) continue;
    auto other = script;
    for (const auto& [place, whole] : wholes) {
      auto message = whole.message;
      exchange(message, own, number);
      if (seal != nullptr && message.raw != whole.message.raw) seal(message.raw);
      other[place].bytes.assign(message.raw.begin() + static_cast<std::ptrdiff_t>(whole.head),
                                message.raw.end());
    }
    if (other != script) others.push_back(std::move(other));
  }
  return others;
}

Script with_whole_reads(Script script) {
  constexpr std::int64_t kLongEnough = 80;
  for (auto& record : script) {
    const bool is_read = record.kind == LinkKind::kBus && !is_sent(record);
    const auto size = is_read ? number_in(record, "n", 0) : 0;
    const auto place = record.details.find(fmt::format("\"n\":{}", size));
    if (size <= 0 || size >= kLongEnough || place == std::string::npos) continue;
    const auto digits = place + std::string_view{"\"n\":"}.size();
    record.details.replace(digits, std::to_string(size).size(), std::to_string(kLongEnough));
  }
  return script;
}

bool are_alike(const Symptom& one, const Symptom& other) {
  const auto wrongs = wrongs_of(other);
  return std::ranges::any_of(wrongs_of(one), [&](const auto& wrong) {
    const auto same = wrongs.find(wrong.first);
    return same != wrongs.end() && are_alike(wrong.second, same->second);
  });
}

}  // namespace armjig::campaign
