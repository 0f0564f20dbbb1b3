// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/author.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "emulators/sessions/odd_fields.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;
using sessions::Dice;

constexpr std::size_t kMostRecords = 3000;
constexpr std::size_t kMostBytes = 4096;  ///< of one record
/// What buses of Linux carry in one transaction.
constexpr std::int64_t kMostBusBytes = 255;

/// As often below an eighth of the way as above half of it, also where the way is short.
std::int64_t mostly_few(Dice& dice, std::int64_t least, std::int64_t most) {
  constexpr std::int64_t kWay = 1000;
  const auto way = dice.between(0, kWay);
  return least + (most - least) * way / kWay * way / kWay * way / kWay;
}

/// How often something is repeated. Counters turn over at powers of two, so now and then so often.
std::size_t some_count(Dice& dice) {
  constexpr std::array<std::int64_t, 3> kTurns{257, 1025, 1200};
  const auto most = dice.one_in(12) ? dice.one_of(kTurns) : mostly_few(dice, 2, 60);
  return static_cast<std::size_t>(dice.one_in(2) ? most : dice.between(1, most));
}

/// The places of the records that send bytes.
std::vector<std::size_t> sent_in(const Script& script) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < script.size(); ++i) {
    if (is_sent(script[i]) && !script[i].bytes.empty()) places.push_back(i);
  }
  return places;
}

/// One of them; nullptr if there is none.
KeptRecord* some_sent(Dice& dice, Script& script) {
  const auto places = sent_in(script);
  return places.empty() ? nullptr : &script[dice.one_of(places)];
}

std::size_t some_place(Dice& dice, const Script& script) {
  return dice.number<std::size_t>(0, std::ssize(script) - 1);
}

/// From a place on everything is later, or earlier as far as nothing overtakes.
void shift_from(Script& script, std::size_t place, Duration by) {
  if (place >= script.size()) return;
  const auto before = place == 0 ? Instant{} : script[place - 1].time;
  const auto shift = std::max(by, before - script[place].time);
  for (auto i = place; i < script.size(); ++i) script[i].time += shift;
}

/// Bits of a float that computations go wrong with.
std::int64_t odd_float(Dice& dice) {
  constexpr std::array<std::int64_t, 9> kBits{
      0x7FC0'0000, 0x7F80'0000, 0xFF80'0000, 0x8000'0000, 1,
      0x7F7F'FFFF, 0xFF7F'FFFF, 0x3F80'0000, 0x7F80'0001};  // NaN, inf, -inf, -0, denormal, ends, 1
  return dice.one_of(kBits);
}

/// An end of the field's range, with or without a sign.
std::int64_t end_of(Dice& dice, const Field& field) {
  const auto top = std::int64_t{1} << (8U * field.width - 1U);
  const std::array<std::int64_t, 4> ends{top - 1, -top, 2 * top - 1, top};
  return dice.one_of(ends);
}

void spoil_bytes_of(Dice& dice, const Field& field, std::span<std::byte> message) {
  if (field.offset + std::size_t{field.width} > message.size() || field.width == 0) return;
  const bool is_named = !field.values.empty() && !dice.one_in(3);
  const auto value = field.encoding == Encoding::kFloatLittle && dice.one_in(2) ? odd_float(dice)
                     : is_named       ? dice.one_of(field.values).value
                     : dice.one_in(4) ? end_of(dice, field)
                                      : sessions::odd_number(dice);
  set_field_value(field, message, value);
}

/// The piece of a line that colons divide, replaced.
void spoil_piece_of(Dice& dice, const Field& field, std::vector<std::byte>& line) {
  constexpr std::byte kColon{':'};
  auto begin = line.begin();
  for (auto left = field.offset; left > 0 && begin != line.end(); --left) {
    begin = std::find(begin, line.end(), kColon);
    if (begin != line.end()) ++begin;
  }
  const auto end = std::find_if(begin, line.end(), [](std::byte byte) {
    return byte == kColon || byte == std::byte{'\r'} || byte == std::byte{'\n'};
  });
  const bool is_named = !field.values.empty() && !dice.one_in(3);
  const auto text = is_named ? std::string{dice.one_of(field.values).name}
                             : std::to_string(sessions::odd_number(dice));
  const auto bytes = std::as_bytes(std::span{text});
  const auto place = line.erase(begin, end);
  line.insert(place, bytes.begin(), bytes.end());
}

}  // namespace

Script Author::draw(std::uint64_t seed, const std::vector<Script>& worthy) const {
  constexpr std::array<std::pair<int, Change>, 10> kChanges{{{8, &Author::change_field},
                                                             {3, &Author::change_bytes},
                                                             {2, &Author::cut_bytes},
                                                             {2, &Author::add_bytes},
                                                             {3, &Author::split},
                                                             {4, &Author::repeat},
                                                             {4, &Author::leave_out},
                                                             {2, &Author::swap},
                                                             {3, &Author::move_time},
                                                             {2, &Author::hurry}}};
  Dice dice{seed};
  const bool is_fresh = worthy.empty() || dice.one_in(2);
  auto script = is_fresh ? fresh(dice) : dice.one_of(worthy);
  if (!is_fresh && dice.one_in(5)) script = joined(std::move(script), dice.one_of(worthy), 10ms);
  const auto changes =
      is_fresh && material_.draw_session != nullptr ? dice.between(0, 1) : mostly_few(dice, 1, 12);
  for (auto left = changes; left > 0 && !script.empty(); --left) {
    const auto change = dice.weighted(kChanges, [](const auto& one) { return one.first; }).second;
    (this->*change)(dice, script);
  }
  fit(dice, script);
  if (material_.permit) material_.permit(script);
  return script;
}

Script Author::fresh(Dice& dice) const {
  if (material_.draw_session == nullptr || dice.one_in(16)) return harmless_ones(dice);
  const auto seed = dice.number<std::uint64_t>(0, INT64_MAX);
  const auto script = read_script(material_.draw_session(seed), "a session drawn at random");
  return script ? *script : harmless_ones(dice);
}

Script Author::harmless_ones(Dice& dice) const {
  Script script;
  const auto pause = mostly_few(dice, 1'000, 100'000);
  for (auto left = mostly_few(dice, 1, 60); left > 0; --left) {
    script = joined(std::move(script), material_.harmless, std::chrono::microseconds{pause});
  }
  return script;
}

void Author::change_field(Dice& dice, Script& script) const {
  auto* const record = some_sent(dice, script);
  if (record == nullptr) return;
  const auto dissector = material_.make_dissector();
  const auto messages = messages_in(*record, *dissector);
  // Only where the bytes are one message is it known where its fields are.
  const std::size_t head = record->kind == LinkKind::kBus ? 1 : 0;
  if (messages.empty() || messages.front().fields.empty()) return change_bytes(dice, script);
  auto message = messages.front().raw;
  const auto& field = dice.one_of(messages.front().fields);
  if (field.place == Place::kPiece) {
    spoil_piece_of(dice, field, record->bytes);
    return;
  }
  if (message.size() > record->bytes.size() + head) return;
  spoil_bytes_of(dice, field, message);
  if (material_.seal != nullptr && !dice.one_in(4)) material_.seal(message);
  std::copy(message.begin() + static_cast<std::ptrdiff_t>(head), message.end(),
            record->bytes.begin());
}

void Author::change_bytes(Dice& dice, Script& script) const {
  auto* const record = some_sent(dice, script);
  if (record == nullptr) return;
  for (auto left = mostly_few(dice, 1, 8); left > 0; --left) {
    auto& byte = dice.one_of(record->bytes);
    byte = dice.one_in(2) ? dice.byte()
                          : byte ^ static_cast<std::byte>(1U << dice.number<unsigned>(0, 7));
  }
  if (material_.seal != nullptr && dice.one_in(2)) material_.seal(record->bytes);
}

void Author::cut_bytes(Dice& dice, Script& script) const {
  auto* const record = some_sent(dice, script);
  if (record == nullptr) return;
  record->bytes.resize(dice.number<std::size_t>(0, std::ssize(record->bytes) - 1));
  if (record->bytes.empty() && record->kind != LinkKind::kBus) record->bytes.push_back(dice.byte());
}

void Author::add_bytes(Dice& dice, Script& script) const {
  auto* const record = some_sent(dice, script);
  if (record == nullptr || record->bytes.size() > kMostBytes) return;
  const auto more = dice.bytes(1, dice.one_in(6) ? 300 : 8);
  const auto place = dice.number<std::ptrdiff_t>(0, std::ssize(record->bytes));
  record->bytes.insert(record->bytes.begin() + place, more.begin(), more.end());
}

void Author::split(Dice& dice, Script& script) const {
  auto* const record = some_sent(dice, script);
  if (record == nullptr || record->kind == LinkKind::kBus || record->bytes.size() < 2) return;
  const auto place = record - script.data();
  const auto size = dice.number<std::ptrdiff_t>(1, std::ssize(record->bytes) - 1);
  auto rest = *record;
  rest.bytes.erase(rest.bytes.begin(), rest.bytes.begin() + size);
  record->bytes.resize(static_cast<std::size_t>(size));
  script.insert(script.begin() + place + 1, std::move(rest));
  shift_from(script, static_cast<std::size_t>(place) + 1,
             std::chrono::microseconds{mostly_few(dice, 0, 20'000)});
}

void Author::repeat(Dice& dice, Script& script) const {
  const auto* const record = some_sent(dice, script);
  if (record == nullptr) return;
  const auto count = some_count(dice);
  const auto place = static_cast<std::size_t>(record - script.data());
  const auto pause = std::chrono::microseconds{mostly_few(dice, 500, 20'000)};
  auto last = place;
  if (record->kind == LinkKind::kBus && place + 1 < script.size() &&
      script[place + 1].kind == LinkKind::kBus && !is_sent(script[place + 1])) {
    ++last;  // a choice and what it chose are read together
  }
  const Script part(script.begin() + static_cast<std::ptrdiff_t>(place),
                    script.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  const auto step = part.back().time - part.front().time + pause;
  Script copies;
  for (std::size_t i = 1; i <= count && script.size() + copies.size() < kMostRecords; ++i) {
    for (auto copy : part) {
      copy.time += step * static_cast<std::int64_t>(i);
      copies.push_back(std::move(copy));
    }
  }
  shift_from(script, last + 1, step * static_cast<std::int64_t>(count));
  script.insert(script.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                std::make_move_iterator(copies.begin()), std::make_move_iterator(copies.end()));
}

void Author::leave_out(Dice& dice, Script& script) const {
  const auto first = static_cast<std::ptrdiff_t>(some_place(dice, script));
  const auto count = std::min(mostly_few(dice, 1, 50), std::ssize(script) - first);
  script.erase(script.begin() + first, script.begin() + first + count);
}

void Author::swap(Dice& dice, Script& script) const {
  auto& one = script[some_place(dice, script)];
  auto& other = script[some_place(dice, script)];
  std::swap(one, other);
  std::swap(one.time, other.time);
}

void Author::move_time(Dice& dice, Script& script) const {
  const auto by = std::chrono::microseconds{dice.one_in(3) ? -mostly_few(dice, 1, 1'000'000)
                                                           : mostly_few(dice, 1, 1'000'000)};
  shift_from(script, some_place(dice, script), by);
}

void Author::hurry(Dice& dice, Script& script) const {
  const auto longest = std::chrono::microseconds{mostly_few(dice, 0, 20'000)};
  Duration saved{};
  Instant last{};
  for (auto& record : script) {
    const auto gap = record.time - last;
    last = record.time;
    saved += std::max(Duration{}, gap - longest);
    record.time -= saved;
  }
}

/// What cannot be played there is left out, and what is too long ends.
void Author::fit(Dice& dice, Script& script) const {
  std::erase_if(script, [&](const KeptRecord& one) {
    return (one.kind != material_.kind && one.kind != LinkKind::kEvents) ||
           (is_by_hand(one) && !material_.has_hands);
  });
  const auto begin = script.empty() ? Instant{} : script.front().time;
  for (auto& record : script) record.time -= begin.time_since_epoch();
  for (std::size_t i = 1; i < script.size(); ++i) {
    const auto missing = material_.least_gap - (script[i].time - script[i - 1].time);
    if (missing > Duration{}) shift_from(script, i, missing);
  }
  // Most are short, for what takes long is rare, and time is dear.
  constexpr auto kShortPart = 8;
  const auto longest = dice.one_in(kShortPart) ? material_.longest : material_.longest / kShortPart;
  std::erase_if(script, [&](const KeptRecord& one) { return one.time > Instant{longest}; });
  if (script.size() > kMostRecords) script.resize(kMostRecords);
  if (material_.kind != LinkKind::kBus) return;
  std::map<std::uint32_t, std::uint32_t> there;  ///< in place of those that were drawn
  for (auto& record : script) {
    if (record.kind != LinkKind::kBus) continue;
    if (!material_.addresses.empty() && !there.contains(record.id)) {
      const bool is_stranger = dice.one_in(12);
      there[record.id] = is_stranger ? record.id : dice.one_of(material_.addresses);
    }
    if (!there.empty()) record.id = there[record.id];
  }
  if (material_.has_operations) return;
  // A transaction of its own for each, of a size that adapters take.
  std::erase_if(script, [](const KeptRecord& one) {
    const auto wanted = is_sent(one) ? std::ssize(one.bytes) : number_in(one, "n", 0);
    return one.kind == LinkKind::kBus && (wanted == 0 || wanted > kMostBusBytes);
  });
  for (auto& record : script) {
    const auto goes_on = record.details.find(R"(,"stop":false)");
    if (goes_on != std::string::npos) record.details.resize(goes_on);
  }
}

}  // namespace armjig::campaign
