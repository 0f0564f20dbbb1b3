// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/exercises.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>
#include <utility>

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

/// So often in the time in which something is watched.
constexpr int kTimesWatched = 7;
constexpr int kSomeTimes = 20;

/// As readers of numbers may or may not take them.
constexpr std::array<std::string_view, 24> kOddNumbers{"+1",
                                                       "01",
                                                       " 1",
                                                       "0x1",
                                                       "--1",
                                                       "1.0",
                                                       "1 ",
                                                       "1e1",
                                                       "1\v",
                                                       "08",
                                                       "-09",
                                                       "010",
                                                       "",
                                                       "-0",
                                                       " ",
                                                       "+",
                                                       "-",
                                                       "+-1",
                                                       "000000000000000000000001",
                                                       "12345678901234567890123",
                                                       "1234567890",
                                                       "-2147483649",
                                                       "4294967297",
                                                       "1\t"};

void repeat(Script& body, const KeptRecord& record, int count, Duration pause) {
  for (int i = 0; i < count; ++i) add(body, record, pause);
}

Script copies(const Script& exchange, int count) {
  Script body;
  for (int i = 0; i < count; ++i) add(body, exchange);
  return body;
}

}  // namespace

Script many_copies_of(const Script& exchange) {
  constexpr int kManyTimes = 1200;
  return copies(exchange, kManyTimes);
}

bool Exercises::can_choose(const Setting& setting, const Field& field) const {
  if (field.encoding == Encoding::kLiteral) return false;
  if (field.place == Place::kPiece) return true;
  auto other = setting.exchange.front();
  const auto& message = setting.message;
  set_number(material_, other, message, {&field, 1}, field_value(field, message.raw) ^ 1, 1);
  return other.bytes != setting.exchange.front().bytes;
}

void Exercises::look(Script& body, std::size_t which) const {
  if (!repertoire_.looks().empty())
    add(body, to(body.back().id, repertoire_.looks()[which % repertoire_.looks().size()]));
}

/// On a stream so far apart that what is late does not come together with what is next: of that,
/// no answer is sure.
void Exercises::add_apart(Script& body, const Script& exchange) const {
  constexpr Duration kApart = 6ms;
  for (const auto& record : exchange) {
    add(body, record, material_.kind == LinkKind::kStream ? kApart : kStep);
  }
}

/// What comes of it, for so long that it is not taken for what was before or comes next: on a
/// stream as its own answer, on a bus by what moves on.
void Exercises::add_watched(Script& body, const Script& odd) const {
  if (material_.kind == LinkKind::kStream) {
    return repeat(body, odd.front(), kTimesWatched, kWatched / kTimesWatched);
  }
  const auto address = odd.front().id;
  add(body, to(address, repertoire_.motion()));
  add(body, odd.front(), kSpeedUp);
  add(body, Script(odd.begin() + 1, odd.end()));
  repertoire_.look_at_all(body, address, kWatched);
}

bool Exercises::can_be_watched(const Setting& setting) const {
  return !strays(setting.before) &&
         (material_.kind == LinkKind::kStream || !repertoire_.motion().empty());
}

bool Exercises::strays(const Script& script) const {
  return material_.strays != nullptr && std::ranges::any_of(script, [this](const auto& record) {
           return is_sent(record) && material_.strays(record.bytes);
         });
}

Script Exercises::watched_lengths(const Setting& setting) const {
  Script body;
  if (material_.kind != LinkKind::kBus || !can_be_watched(setting)) return body;
  const auto size = setting.exchange.front().bytes.size();
  for (const auto other : {size + 1, size - 1, size - 2, size / 2}) {
    if (other == 0 || other > size + 1) continue;
    const Script odd{sending(setting.exchange.front(), cut(setting.exchange.front().bytes, other))};
    if (other < size || !strays(odd)) add_watched(body, odd);  // cut short it does nothing
  }
  return body;
}

Script Exercises::watched_pairs(const Setting& setting) const {
  Script body;
  if (material_.kind != LinkKind::kStream || !can_be_watched(setting) || strays(setting.exchange)) {
    return body;
  }
  for (const auto& kind : repertoire_.kinds()) {
    const auto& other = kind.front().exchange;
    if (strays(other)) continue;
    add(body, setting.exchange);
    add_watched(body, other);
    add_watched(body, {in_one_piece(setting.exchange.front(), other.front())});
  }
  return body;
}

Script Exercises::watched_values(const Setting& setting, const Field& field) const {
  Script body;
  if (!can_be_watched(setting) || strays(setting.exchange) || field.place == Place::kPiece) {
    return body;
  }
  if (field.encoding == Encoding::kFloatLittle) {
    for (const auto bits : kOddFloats) add_watched(body, with_bits(setting, field, bits));
    return body;
  }
  const auto top = std::int64_t{1} << (8U * field.width);
  const std::array<std::int64_t, 12> numbers{0,    1,    -1,     -128,  127,         255,
                                             -256, 1000, -32769, 32768, top / 2 - 1, -top / 2};
  for (const auto number : numbers) {
    if (number < top && number >= -top) {
      add_watched(body, with(setting, field, number));
    }
  }
  return body;
}

Script Exercises::pairs(const Setting& setting) const {
  Script body;
  std::size_t number = 0;
  for (const auto& kind : repertoire_.kinds()) {
    auto other = kind.front().exchange;
    if (material_.kind != LinkKind::kBus) other.front().id = setting.exchange.front().id;
    add(body, setting.back);
    add(body, setting.exchange);
    add(body, other);
    look(body, number++);
    if (material_.kind == LinkKind::kBus) continue;
    add(body, setting.back);
    add(body, in_one_piece(setting.exchange.front(), other.front()));
    if (material_.kind == LinkKind::kSession) add(body, setting.exchange);
  }
  return body;
}

Script Exercises::some_copies(const Setting& setting) const {
  if (repertoire_.looks().empty()) return copies(setting.exchange, kSomeTimes);
  Script body;
  for (const auto& one : repertoire_.looks()) {
    const auto look = to(setting.exchange.front().id, one);
    add(body, look);
    for (int i = 0; i < kSomeTimes; ++i) {
      add(body, setting.exchange.front());
      add(body, look.back());
    }
  }
  return body;
}

Script Exercises::many_copies(const Setting& setting) const {
  return many_copies_of(setting.exchange);
}

bool Exercises::has_sum(const Setting& setting) const {
  auto record = setting.exchange.front();
  record.bytes.back() ^= std::byte{1};
  seal(material_, record);
  return record == setting.exchange.front();
}

Script Exercises::spoiled_copies(const Setting& setting) const {
  if (material_.kind != LinkKind::kStream && !has_sum(setting)) return {};
  auto bytes = setting.exchange.front().bytes;
  bytes.back() ^= std::byte{1};
  return copies(sending(setting.exchange, std::move(bytes)), kSomeTimes);
}

Script Exercises::sums(const Setting& setting) const {
  Script body;
  const auto& fields = setting.message.fields;
  const auto field = std::ranges::find_if(fields, [&](const Field& one) {
    return one.place == Place::kBytes && one.width > 1 && can_choose(setting, one);
  });
  if (field == fields.end() || !has_sum(setting)) return body;
  const auto own = field_value(*field, setting.message.raw);
  for (int low = 0; low < 256; ++low) {
    auto raw = setting.message.raw;
    set_field_value(*field, raw, (own & ~std::int64_t{255}) | low);
    add(body, with_message(setting, raw));
    look(body, static_cast<std::size_t>(low));
  }
  return body;
}

Script Exercises::lengths(const Setting& setting) const {
  constexpr std::size_t kMost = 40;
  const auto& bytes = setting.exchange.front().bytes;
  Script body;
  for (std::size_t size = bytes.size() + 4; size > 0; --size) {
    if (size + kMost < bytes.size() || size == bytes.size()) continue;
    add(body, setting.back);
    add(body, sending(setting.exchange, cut(bytes, size)));
    add(body, setting.telling);
    add(body, setting.exchange);
    look(body, size);
  }
  return body;
}

Script Exercises::odd_bytes(const Setting& setting) const {
  Script body;
  if (material_.kind == LinkKind::kBus) return body;
  const auto& bytes = setting.exchange.front().bytes;
  for (const auto odd : kOddBytes) {
    for (const auto place : {std::size_t{0}, bytes.size() / 2,
                             bytes.size() - std::min<std::size_t>(2, bytes.size())}) {
      auto other = bytes;
      other.insert(other.begin() + static_cast<std::ptrdiff_t>(place), static_cast<std::byte>(odd));
      add(body, sending(setting.exchange, std::move(other)));
    }
    add(body, setting.back);
  }
  return body;
}

Script Exercises::sizes(const Setting& setting) const {
  constexpr std::size_t kMost = 140;
  Script body;
  if (material_.kind == LinkKind::kBus) return body;
  const auto& bytes = setting.exchange.front().bytes;
  auto filler = bytes;
  while (filler.size() < kMost) filler.insert(filler.end(), bytes.begin(), bytes.end());
  for (std::size_t size = 1; size <= kMost; ++size) {
    add(body, sending(setting.exchange.front(), cut(filler, size)));
  }
  return body;
}

Script Exercises::long_gap(const Setting& setting) const {
  constexpr Duration kBefore = 300ms;
  auto body = setting.exchange;
  add(body, setting.exchange.front(), std::max(kStep, material_.longest - kBefore));
  return body;
}

Script Exercises::values(const Setting& setting, const Field& field) const {
  Script body;
  std::size_t number = 0;
  const auto put_value = [&](std::int64_t value) { add(body, with(setting, field, value)); };
  const auto add_value = [&](std::int64_t value) {
    put_value(value);
    look(body, number++);
  };
  const auto add_text = [&](std::string_view text) {
    auto exchange = setting.exchange;
    set_piece(field, exchange.front().bytes, text);
    add(body, exchange);
  };
  if (field.place == Place::kPiece) {
    for (const auto& named : field.values) add_text(named.name);
    for (const auto odd : kOddNumbers) add_text(odd);
    if (!field.values.empty()) return body;
  }
  if (field.encoding == Encoding::kFloatLittle) {
    for (const auto bits : kOddFloats) {
      add(body, with_bits(setting, field, bits));
      repertoire_.look_at_all(body, setting.exchange.front().id);
    }
  }
  if (field.place == Place::kBytes && field.width == 1) {
    constexpr int kTimes = 9;
    for (int value = 0; value < 256; ++value) add_value(value);
    for (int value = 0; value < 256; value += 17) {
      for (int i = 0; i < kTimes; ++i) put_value(value);
      look(body, number++);
    }
    return body;
  }
  const auto top = std::int64_t{1} << (8U * field.width + (field.width == 0 ? 32U : 0U));
  // What is next to an edge is hardly another float.
  const std::size_t step = field.encoding == Encoding::kFloatLittle ? 3 : 1;
  for (std::size_t i = step / 2; i < kEdgeCount; i += step) {
    const auto value = edge_at(i);
    if (value < top && value >= -top) add_value(value);
  }
  for (const auto value : {top - 1, top / 2 - 1, -top / 2}) add_value(value);
  return body;
}

/// So far apart that each answer is known by its time.
Script Exercises::odd_numbers(const Setting& setting) const {
  Script body;
  const auto& fields = setting.message.fields;
  const auto number = std::ranges::find_if(fields, [](const Field& field) {
    return field.place == Place::kPiece && field.values.empty();
  });
  if (number == fields.end()) return body;
  const auto apart = std::max(material_.rules.time_tolerance, kStep) + kStep;
  for (const auto odd : kOddNumbers) {
    auto record = setting.exchange.front();
    set_piece(*number, record.bytes, odd);
    add(body, std::move(record), apart);
    add(body, setting.exchange.front(), apart);
  }
  return body;
}

Script Exercises::with(const Setting& setting, const Field& field, std::int64_t number) const {
  return with_number(material_, setting, {&field, 1}, number);
}

/// With those bits in a field that is a float.
Script Exercises::with_bits(const Setting& setting, const Field& field, std::int64_t bits) const {
  auto raw = setting.message.raw;
  set_field_value(field, raw, bits);
  return with_message(setting, raw);
}

/// With that message in place of its own, made right again.
Script Exercises::with_message(const Setting& setting, Bytes raw) const {
  auto exchange = setting.exchange;
  if (put(raw, exchange.front())) seal(material_, exchange.front());
  return exchange;
}

}  // namespace armjig::campaign
