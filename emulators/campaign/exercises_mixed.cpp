// SPDX-License-Identifier: Apache-2.0
// Exercises with all fields of a message at once, and with several messages together.
#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "emulators/campaign/exercises.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

/// As a field of that width has it, of which the top bit is a sign.
std::int64_t signed_as(const Field& field, std::int64_t number) {
  const auto unused = 64 - 8 * static_cast<int>(field.width);
  return field.width == 0 ? number : (number << unused) >> unused;
}

/// At each time another byte at each place; each place has each value once in 256 times.
std::int64_t bytes_at(const Field& field, std::size_t time) {
  constexpr std::size_t kApart = 37;
  std::int64_t number = 0;
  for (std::size_t i = 0; i < field.width; ++i) {
    number = number << 8U | static_cast<std::int64_t>((time + kApart * (field.offset + i)) & 255U);
  }
  return signed_as(field, number);
}

std::int64_t edge_of(const Field& field, std::size_t time) {
  constexpr std::size_t kApart = 31;
  return signed_as(field, edge_at((time + kApart * field.offset) % kEdgeCount));
}

/// All bits, none, and what is next to the sign.
std::int64_t extreme_of(const Field& field, std::size_t time) {
  const auto most = (std::int64_t{1} << (8U * std::max<unsigned>(field.width, 2) - 1U)) - 1;
  const std::array numbers{std::int64_t{-1}, std::int64_t{0}, most, -most - 1};
  return numbers.at(time % numbers.size());
}

std::int64_t all_bits(const Field& /*field*/) { return -1; }

/// The values of a code, or each bit and all of them; none if it is neither.
std::vector<std::int64_t> meant_by(const Field& field) {
  std::vector<std::int64_t> values;
  for (const auto& one : field.values) values.push_back(one.value);
  for (std::size_t bit = 0; bit < field.bits.size(); ++bit) values.push_back(1LL << bit);
  if (!field.bits.empty()) values.push_back(255);
  return values;
}

std::vector<Field> floats_of(std::vector<Field> fields) {
  std::erase_if(fields,
                [](const Field& field) { return field.encoding != Encoding::kFloatLittle; });
  return fields;
}

bool has_read(const Script& exchange) { return exchange.size() > 1; }

}  // namespace

std::vector<Field> Exercises::free_fields(const Setting& setting) const {
  std::vector<Field> free;
  const auto* const code = code_in(setting.message);
  for (const auto& field : setting.message.fields) {
    if (&field == code || !can_choose(setting, field)) continue;
    auto other = setting.exchange.front();
    set_number(material_, other, setting.message, {&field, 1},
               field_value(field, setting.message.raw) ^ 1, 1);
    const auto dissector = material_.make_dissector();
    const auto messages = messages_in(other, *dissector);
    const bool is_of_the_form = messages.size() == 1 && messages.front().fault.empty() &&
                                messages.front().fields.size() == setting.message.fields.size();
    if (is_of_the_form) free.push_back(field);
  }
  return free;
}

Script Exercises::with_all(const Setting& setting, const std::vector<Field>& fields,
                           const NumberOf& number_of) const {
  constexpr int kLeast = 16;
  for (int smaller = 0; smaller <= kLeast; ++smaller) {
    auto raw = setting.message.raw;
    auto pieces = setting.exchange;
    for (const auto& field : fields) {
      const auto number = number_of(field) >> std::min(smaller, 8 * std::max(field.width - 1, 0));
      if (field.place == Place::kPiece) {
        set_piece(field, pieces.front().bytes, std::to_string(number));
      } else {
        set_field_value(field, raw, number);
      }
    }
    const bool is_of_pieces = fields.front().place == Place::kPiece;
    auto exchange = is_of_pieces ? std::move(pieces) : with_message(setting, raw);
    if (is_permitted(material_, exchange)) return exchange;
  }
  return {};
}

/// And on a bus what it changes.
void Exercises::add_told(Script& body, const Setting& setting, const Script& exchange) const {
  add_apart(body, exchange);
  if (!exchange.empty()) add(body, setting.telling);
}

Script Exercises::all_fields(const Setting& setting) const {
  constexpr std::size_t kBytes = 256;
  constexpr std::size_t kExtremes = 40;
  Script body;
  const auto fields = free_fields(setting);
  if (fields.empty()) return body;
  const auto try_all = [&](std::size_t times, auto number_at) {
    for (std::size_t time = 0; time < times; ++time) {
      const auto number = [&](const Field& field) { return number_at(field, time); };
      add_told(body, setting, with_all(setting, fields, number));
    }
  };
  try_all(kExtremes, extreme_of);
  try_all(kExtremes, [](const Field& field, std::size_t time) {
    return extreme_of(field, 2 + time % 2);  // there and back
  });
  if (fields.front().place == Place::kBytes) try_all(kBytes, bytes_at);
  if (material_.kind != LinkKind::kBus) try_all(kEdgeCount, edge_of);
  return body;
}

Script Exercises::held_codes(const Setting& setting) const {
  constexpr std::size_t kTimes = 8;
  constexpr int kTimesNamed = 4;
  Script body;
  for (const auto& piece : setting.message.fields) {
    const bool is_name = &piece == &setting.message.fields.front();
    if (piece.place != Place::kPiece || is_name) continue;
    for (const auto& named : piece.values) {
      auto exchange = setting.exchange;
      set_piece(piece, exchange.front().bytes, named.name);
      for (int i = 0; i < kTimesNamed; ++i) add(body, exchange);
    }
  }
  const auto fields = free_fields(setting);
  std::size_t time = 0;
  for (const auto& held : fields) {
    if (held.place != Place::kBytes) continue;
    for (const auto value : meant_by(held)) {
      for (std::size_t i = 0; i < kTimes; ++i, ++time) {
        const auto number = [&](const Field& field) {
          return field.offset == held.offset ? value : bytes_at(field, time);
        };
        add_told(body, setting, with_all(setting, fields, number));
      }
    }
  }
  return body;
}

/// On a stream; the message itself as often as bytes are waited for then.
Script Exercises::false_lengths(const Setting& setting) const {
  Script body;
  const auto& raw = setting.message.raw;
  const auto length = std::ranges::find_if(setting.message.fields, [&](const Field& field) {
    return field.place == Place::kBytes && field.width == 1 &&
           field_value(field, raw) == static_cast<std::int64_t>(raw.size()) - field.offset - 1;
  });
  if (material_.kind != LinkKind::kStream || length == setting.message.fields.end()) return body;
  for (int number = 0; number < 256; ++number) {
    auto other = raw;
    set_field_value(*length, other, number);
    add(body, sending(setting.exchange.front(), std::move(other)));
    for (std::size_t sent = 0; sent < raw.size() + static_cast<std::size_t>(number);
         sent += raw.size()) {
      add(body, setting.exchange);
    }
  }
  return body;
}

Script Exercises::all_codes(const Setting& setting) const {
  Script body;
  const auto& looks = repertoire_.looks();
  if (material_.kind != LinkKind::kBus || looks.empty()) return body;
  const auto& sent = setting.exchange.front();
  for (std::size_t code = 0; code < 256; ++code) {
    // What is asked before differs, for what is no code leaves that chosen.
    auto exchange = to(sent.id, looks[code % looks.size()]);
    exchange.insert(exchange.begin() + 1, sending(sent, {static_cast<std::byte>(code)}));
    add(body, exchange);
  }
  return body;
}

Script Exercises::two_codes(const Setting& setting) const {
  Script body;
  for (const auto& look : repertoire_.looks()) {
    for (const auto& other : repertoire_.looks()) {
      auto exchange = to(setting.exchange.front().id, look);
      const auto& codes = other.front().bytes;
      exchange.front().bytes.insert(exchange.front().bytes.end(), codes.begin(), codes.end());
      add(body, exchange);
    }
  }
  return body;
}

/// Cut by a byte, and with a number that it hardly takes.
std::vector<Script> Exercises::refused_forms(const Setting& setting) const {
  constexpr std::size_t kMostForms = 6;
  std::vector<Script> forms;
  const auto& bytes = setting.exchange.front().bytes;
  if (material_.kind == LinkKind::kStream) return forms;  // what comes next would be part of it
  if (bytes.size() > 1 && material_.kind == LinkKind::kBus) {
    forms.push_back({sending(setting.exchange.front(), cut(bytes, bytes.size() - 1))});
  }
  const auto& fields = setting.message.fields;
  for (const auto& field : fields) {
    const bool is_number = field.encoding != Encoding::kFloatLittle;
    if (&field == code_in(setting.message) || !is_number || !can_choose(setting, field)) continue;
    if (forms.size() < kMostForms) forms.push_back(with(setting, field, extreme_of(field, 2)));
  }
  return forms;
}

Script Exercises::mixed_pairs(const Setting& setting) const {
  Script body;
  std::vector<Script> firsts = refused_forms(setting);
  if (const auto fields = free_fields(setting); !fields.empty()) {
    firsts.push_back(with_all(setting, fields, all_bits));
  }
  std::size_t number = 0;
  for (const auto& first : firsts) {
    if (first.empty()) continue;
    for (const auto& kind : repertoire_.kinds()) {
      auto other = kind.front().exchange;
      if (material_.kind != LinkKind::kBus) other.front().id = setting.exchange.front().id;
      add(body, setting.back);
      add(body, first);
      add(body, other);
      if (kind.front().telling.empty()) {
        look(body, number++);
      } else {
        add(body, to(setting.exchange.front().id, kind.front().telling));
      }
    }
  }
  return body;
}

Script Exercises::marked(const Setting& setting) const {
  Script body;
  if (material_.kind != LinkKind::kStream) return body;
  std::vector<std::byte> marks;
  for (const auto& field : setting.message.fields) {
    if (field.encoding != Encoding::kLiteral || field.place != Place::kBytes) continue;
    const auto begin = setting.message.raw.begin() + field.offset;
    marks.insert(marks.end(), begin, begin + field.width);
  }
  std::ranges::sort(marks);
  const auto repeated = std::ranges::unique(marks);
  marks.erase(repeated.begin(), repeated.end());
  const auto fields = free_fields(setting);
  if (marks.empty() || fields.empty()) return body;
  const auto filled = with_all(setting, fields, all_bits);
  for (const auto& field : fields) {
    if (field.width < 2) continue;
    for (const auto one : marks) {
      for (const auto two : marks) {
        const auto pair =
            std::to_integer<std::int64_t>(one) << 8U | std::to_integer<std::int64_t>(two);
        for (const auto apart : {0, 8}) {
          const auto number = [&](const Field& any) {
            return any.offset == field.offset ? pair << apart : std::int64_t{0};
          };
          add(body, with_all(setting, fields, number));
          add(body, filled);
        }
      }
    }
  }
  return body;
}

Script Exercises::variants(const Setting& setting) const {
  Script body;
  for (const auto& one : setting.variants) {
    auto other = setting;
    other.exchange = to(setting.exchange.front().id, one);
    if (other.exchange != setting.exchange) add_told(body, setting, other.exchange);
    const auto dissector = material_.make_dissector();
    auto messages = messages_in(other.exchange.front(), *dissector);
    if (messages.size() != 1) continue;
    other.message = std::move(messages.front());
    const auto floats = floats_of(free_fields(other));
    if (!floats.empty()) add_told(body, setting, with_all(other, floats, all_bits));
  }
  return body;
}

Script Exercises::sweep(const Setting& setting) const {
  constexpr std::int64_t kMost = 48;
  constexpr float kPart = 0.5F;
  constexpr Duration kTick = 15ms;
  Script body;
  const auto floats = floats_of(free_fields(setting));
  if (floats.empty() || setting.telling.empty()) return body;
  for (auto number = -kMost; number <= kMost; ++number) {
    const auto exchange =
        with_all(setting, floats, [&](const Field& /*field*/) { return float_of(number, kPart); });
    if (exchange.empty()) continue;
    add(body, exchange);
    add(body, setting.telling.front(), kTick);
    add(body, Script(setting.telling.begin() + 1, setting.telling.end()));
  }
  return body;
}

Script Exercises::reads_again(const Setting& setting) const {
  constexpr int kTimes = 8;
  Script body;
  if (material_.kind != LinkKind::kBus) return body;
  const auto& exchange = setting.exchange;
  if (has_read(exchange)) {
    for (const auto count : {kTimes, 2, 3}) {
      add(body, exchange);
      for (int i = 0; i < count; ++i) add(body, exchange.back());
    }
    return body;
  }
  const auto fields = free_fields(setting);
  if (fields.empty() || setting.telling.empty()) return body;
  add(body, setting.telling);
  for (std::size_t i = 0; i < std::size_t{kTimes}; ++i) {
    add(body,
        with_all(setting, fields, [&](const Field& field) { return bytes_at(field, 11 * i); }));
    add(body, setting.telling.back());
  }
  return body;
}

Script Exercises::cut_copies(const Setting& setting) const {
  constexpr int kTimes = 8;
  constexpr std::size_t kShort = 2;
  Script body;
  const auto& bytes = setting.exchange.front().bytes;
  if (material_.kind != LinkKind::kBus || bytes.size() <= kShort) return body;
  for (const auto size : {kShort, bytes.size() - 1}) {
    add(body, setting.exchange);
    for (int i = 0; i < kTimes; ++i) {
      add(body, sending(setting.exchange.front(), cut(bytes, size)));
    }
    repertoire_.look_at_all(body, setting.exchange.front().id);
  }
  if (repertoire_.looks().empty()) return body;
  const auto ask = to(setting.exchange.front().id, repertoire_.looks().front());
  auto other = cut(bytes, kShort);
  for (int last = 0; last < 256; ++last) {
    other.back() = static_cast<std::byte>(last);
    add(body, ask.front());
    add(body, sending(setting.exchange.front(), other));
    add(body, ask.back());
  }
  return body;
}

}  // namespace armjig::campaign
