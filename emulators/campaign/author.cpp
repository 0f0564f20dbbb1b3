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

/// As often below an eighth of the way as above half of it, also where the way is short.
std::int64_t mostly_few(Dice& dice, std::int64_t least, std::int64_t most) {
  constexpr std::int64_t kWay = 1000;
  const auto way = dice.between(0, kWay);
  return least + (most - least) * way / kWay * way / kWay * way / kWay;
}

/// How often something is repeated. Counters turn over at powers of two, so now and then so often.
std::size_t some_count(Dice& dice) {
  constexpr std::array<std::int64_t, 5> kTurns{65, 129, 257, 1025, 1200};
  const auto most = dice.one_in(8) ? dice.one_of(kTurns) : mostly_few(dice, 2, 60);
  return static_cast<std::size_t>(dice.one_in(2) ? most : dice.between(1, most));
}

/// One that sends bytes; nullptr if there is none.
KeptRecord* some_sent(Dice& dice, Script& script) {
  const auto places = sent_in(script);
  return places.empty() ? nullptr : &script[dice.one_of(places)];
}

std::size_t some_place(Dice& dice, const Script& script) {
  return dice.number<std::size_t>(0, std::ssize(script) - 1);
}

Duration some_pause(Dice& dice) {
  return std::chrono::microseconds{dice.one_in(3) ? mostly_few(dice, 500, 200'000)
                                                  : mostly_few(dice, 500, 20'000)};
}

/// The same before each of so many, short enough for most cases to have all of them.
Duration some_pause_of(Dice& dice, std::size_t count) {
  constexpr Duration kMostTogether = 5s;
  return std::min(some_pause(dice), kMostTogether / static_cast<std::int64_t>(count));
}

/// So many copies of what is from `first` to `last` after it, each `pause` after the one before;
/// what follows is later by as much. `change` may change each record of them.
template <class Change>
void insert_copies(Script& script, std::size_t first, std::size_t last, std::size_t count,
                   Duration pause, Change change) {
  const auto end = script.begin() + static_cast<std::ptrdiff_t>(last) + 1;
  const Script part(script.begin() + static_cast<std::ptrdiff_t>(first), end);
  const auto step = part.back().time - part.front().time + pause;
  Script copies;
  for (std::size_t i = 1; i <= count && script.size() + copies.size() < kMostRecords; ++i) {
    for (auto copy : part) {
      copy.time += step * static_cast<std::int64_t>(i);
      change(copy);
      copies.push_back(std::move(copy));
    }
  }
  shift_from(script, last + 1, step * static_cast<std::int64_t>(count));
  script.insert(script.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                std::make_move_iterator(copies.begin()), std::make_move_iterator(copies.end()));
}

/// Bits of a float that computations go wrong with.
std::int64_t odd_float(Dice& dice) { return dice.one_of(kOddFloats); }

std::int64_t edge(Dice& dice) {
  const auto place = dice.number<std::size_t>(0, kEdgeCount / 6 - 1) * 6;
  return edge_at(place + dice.number<std::size_t>(0, 2) + (dice.one_in(3) ? 3 : 0));
}

float some_part(Dice& dice) {
  constexpr std::array<float, 5> kParts{1, 0.5, 0.1F, 0.01F, 0.001F};
  return dice.one_of(kParts);
}

/// What is beside the number that is there, or has something to do with it.
std::int64_t beside(Dice& dice, std::int64_t value) {
  const std::array<std::int64_t, 6> others{value + 1, value - 1, -value,
                                           value / 2, value ^ 1, value * 2};
  return dice.one_of(others);
}

/// A byte that readers of text or of numbers may take otherwise.
std::byte odd_byte(Dice& dice) { return static_cast<std::byte>(dice.one_of(kOddBytes)); }

/// An end of the field's range, with or without a sign.
std::int64_t end_of(Dice& dice, const Field& field) {
  const auto top = std::int64_t{1} << (8U * field.width - 1U);
  const std::array<std::int64_t, 4> ends{top - 1, -top, 2 * top - 1, top};
  return dice.one_of(ends);
}

/// Those that say what a message is all about have values with names, and are few among many.
const Field& some_field(Dice& dice, std::span<const Field> fields) {
  std::vector<const Field*> named;
  for (const auto& field : fields) {
    if (!field.values.empty()) named.push_back(&field);
  }
  return named.empty() || !dice.one_in(4) ? dice.one_of(fields) : *dice.one_of(named);
}

void spoil_bytes_of(Dice& dice, const Field& field, std::span<std::byte> message) {
  if (field.offset + std::size_t{field.width} > message.size() || field.width == 0) return;
  const bool is_named = !field.values.empty() && !dice.one_in(3);
  const bool is_float = field.encoding == Encoding::kFloatLittle;
  const auto value = is_float && dice.one_in(2)    ? odd_float(dice)
                     : is_float && !dice.one_in(3) ? float_of(edge(dice), some_part(dice))
                     : is_named                    ? dice.one_of(field.values).value
                     : dice.one_in(4)              ? end_of(dice, field)
                     : dice.one_in(3)              ? edge(dice)
                     : dice.one_in(3)              ? beside(dice, field_value(field, message))
                                                   : sessions::odd_number(dice);
  set_field_value(field, message, value);
}

/// A number as programs write it, and as some do not expect it.
std::string number_as_text(Dice& dice) {
  auto number = std::to_string(dice.one_in(2) ? edge(dice) : sessions::odd_number(dice));
  if (!dice.one_in(8)) return number;
  constexpr std::array<std::string_view, 5> kBefore{"+", "0", " ", "0x", "--"};
  constexpr std::array<std::string_view, 5> kAfter{".0", " ", "e1", "\v", ""};
  return std::string{dice.one_of(kBefore)}.append(number).append(dice.one_of(kAfter));
}

void spoil_piece_of(Dice& dice, const Field& field, std::vector<std::byte>& line) {
  const bool is_named = !field.values.empty() && !dice.one_in(3);
  set_piece(field, line,
            is_named ? std::string{dice.one_of(field.values).name} : number_as_text(dice));
}

/// Of the same kind of number, as those of several joints or axes.
bool are_akin(const Field& one, const Field& other) {
  return one.encoding == other.encoding && one.width == other.width && one.unit == other.unit &&
         one.place == other.place && one.values.empty() && other.values.empty();
}

}  // namespace

Script Author::draw(std::uint64_t seed, const std::vector<Script>& worthy) const {
  constexpr std::array<std::pair<int, Change>, 11> kChanges{{{8, &Author::change_field},
                                                             {6, &Author::sweep},
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
  if (!worthy.empty() && dice.one_in(6)) splice(dice, script, dice.one_of(worthy));
  const auto changes = is_fresh && material_.draw_session != nullptr ? mostly_few(dice, 0, 5)
                                                                     : mostly_few(dice, 1, 12);
  for (auto left = changes; left > 0 && !script.empty(); --left) {
    const auto change = dice.weighted(kChanges, [](const auto& one) { return one.first; }).second;
    (this->*change)(dice, script);
  }
  fit(dice, script);
  const auto& epilogue = material_.epilogue;
  if (!epilogue.messages.empty() && dice.one_in(epilogue.one_in)) end(script);
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
  if (dice.one_in(3)) {
    return change_everywhere(dice, script, words_of(*record, material_.make_dissector));
  }
  for (auto left = dice.one_in(4) ? dice.between(2, 6) : 1; left > 0; --left) {
    change_a_field(dice, *record);
  }
}

/// Changes all messages of a kind alike: what comes of a number little by little, or is seen only
/// later, shows if it is always there.
void Author::change_everywhere(Dice& dice, Script& script, const std::string& kind) const {
  const auto seed = dice.number<std::uint64_t>(0, INT64_MAX);
  for (auto& record : script) {
    if (!is_sent(record) || record.bytes.empty()) continue;
    if (words_of(record, material_.make_dissector) != kind) continue;
    Dice same{seed};
    change_a_field(same, record);
  }
}

void Author::change_a_field(Dice& dice, KeptRecord& record) const {
  const auto dissector = material_.make_dissector();
  const auto messages = messages_in(record, *dissector);
  // Only where the bytes are one message is it known where its fields are.
  if (messages.empty() || messages.front().fields.empty()) return change_some_bytes(dice, record);
  spoil_field(dice, record, messages.front(), some_field(dice, messages.front().fields));
}

void Author::spoil_field(Dice& dice, KeptRecord& record, const Message& whole,
                         const Field& field) const {
  if (field.place == Place::kPiece) return spoil_piece_of(dice, field, record.bytes);
  auto message = whole.raw;
  spoil_bytes_of(dice, field, message);
  if (put(message, record) && !dice.one_in(4)) seal(material_, record);
}

void Author::change_bytes(Dice& dice, Script& script) const {
  auto* const record = some_sent(dice, script);
  if (record != nullptr) change_some_bytes(dice, *record);
}

void Author::change_some_bytes(Dice& dice, KeptRecord& record) const {
  for (auto left = mostly_few(dice, 1, 8); left > 0; --left) {
    auto& byte = dice.one_of(record.bytes);
    byte = dice.one_in(2) ? dice.byte()
                          : byte ^ static_cast<std::byte>(1U << dice.number<unsigned>(0, 7));
  }
  if (dice.one_in(2)) seal(material_, record);
}

/// One message many times, each with another value in one and the same field, and now and then in
/// others of its kind, or with another odd byte at one and the same place: what only one of them
/// does is met soon. Half of them go along the edges, so that none is missed for long.
void Author::sweep(Dice& dice, Script& script) const {
  const auto* const record = some_sent(dice, script);
  if (record == nullptr) return;
  const auto place = static_cast<std::size_t>(record - script.data());
  const auto last = end_of_exchange(script, place);
  const auto dissector = material_.make_dissector();
  const auto messages = messages_in(*record, *dissector);
  const bool has_fields = !messages.empty() && !messages.front().fields.empty();
  const auto* const field =
      has_fields && !dice.one_in(4) ? &some_field(dice, messages.front().fields) : nullptr;
  const auto byte_place = dice.one_in(2) ? std::max<std::int64_t>(0, std::ssize(record->bytes) - 2)
                                         : dice.between(0, std::ssize(record->bytes) - 1);
  const bool is_longer = dice.one_in(2);
  const auto original = *record;
  std::vector<Field> numbers;  ///< that go along the edges together
  if (field != nullptr && field->values.empty() && dice.one_in(2)) {
    const bool has_kin = dice.one_in(2);
    std::ranges::copy_if(
        messages.front().fields, std::back_inserter(numbers),
        [&](const Field& one) { return &one == field || (has_kin && are_akin(one, *field)); });
  }
  auto edge_place = dice.number<std::size_t>(0, kEdgeCount - 1);
  const auto part = some_part(dice);
  const auto vary = [&](KeptRecord& copy) {
    if (!numbers.empty()) {
      return set_number(material_, copy, messages.front(), numbers, edge_at(edge_place++), part);
    }
    if (field != nullptr) return spoil_field(dice, copy, messages.front(), *field);
    const auto at = copy.bytes.begin() + byte_place;
    if (is_longer) {
      copy.bytes.insert(at, odd_byte(dice));
    } else {
      *at = odd_byte(dice);
      if (!dice.one_in(4)) seal(material_, copy);
    }
  };
  // Each of them a few times in a row now and then, as for what a second one does, or an eighth.
  const auto times = static_cast<std::size_t>(dice.one_in(3) ? dice.between(2, 16) : 1);
  constexpr auto kMostValues = static_cast<std::int64_t>(kEdgeCount);
  const auto most = times > 1 ? 16 : numbers.empty() ? 40 : kMostValues;
  const auto values = static_cast<std::size_t>(dice.between(4, most));
  KeptRecord current;
  std::size_t left = 0;
  const auto pause = some_pause_of(dice, values * times);
  insert_copies(script, place, last, values * times, pause, [&](KeptRecord& copy) {
    if (copy.bytes != original.bytes || !is_sent(copy)) return;
    if (left == 0) {
      current = copy;
      vary(current);
      left = times;
    }
    copy.bytes = current.bytes;
    --left;
  });
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
  const auto more =
      dice.one_in(2) ? std::vector{odd_byte(dice)} : dice.bytes(1, dice.one_in(6) ? 300 : 8);
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
  constexpr std::size_t kMostTogether = 4;
  constexpr std::size_t kMany = 100;  // so often one thing only, or there is no time for all
  const auto* const record = some_sent(dice, script);
  if (record == nullptr) return;
  const auto place = static_cast<std::size_t>(record - script.data());
  auto last = end_of_exchange(script, place);
  const auto count = some_count(dice);
  if (count < kMany && dice.one_in(2)) {
    last = std::min(script.size() - 1, last + dice.number<std::size_t>(0, kMostTogether - 1));
  }
  insert_copies(script, place, last, count, some_pause_of(dice, count), [](KeptRecord&) {});
}

void Author::leave_out(Dice& dice, Script& script) const {
  const auto first = static_cast<std::ptrdiff_t>(some_place(dice, script));
  const auto count = std::min(mostly_few(dice, 1, 50), std::ssize(script) - first);
  script.erase(script.begin() + first, script.begin() + first + count);
}

/// Some of what another script does, in between.
void Author::splice(Dice& dice, Script& script, const Script& other) const {
  if (script.empty() || other.empty()) return;
  const auto first = static_cast<std::ptrdiff_t>(some_place(dice, other));
  const auto count = std::min(mostly_few(dice, 1, 60), std::ssize(other) - first);
  Script part(other.begin() + first, other.begin() + first + count);
  const auto place = some_place(dice, script);
  const auto shift = script[place].time + some_pause(dice) - part.front().time;
  for (auto& record : part) record.time += shift;
  shift_from(script, place + 1, part.back().time - script[place].time);
  script.insert(script.begin() + static_cast<std::ptrdiff_t>(place) + 1,
                std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
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
  campaign::hurry(script, std::chrono::microseconds{mostly_few(dice, 0, 20'000)});
}

/// What cannot be played there is left out, and what is too long ends.
void Author::fit(Dice& dice, Script& script) const {
  leave_out_unplayable(material_, script);
  const auto begin = script.empty() ? Instant{} : script.front().time;
  for (auto& record : script) record.time -= begin.time_since_epoch();
  // Where nothing can be close together, time is dear.
  if (material_.spacing.least > Duration{} && !dice.one_in(3)) hurry(dice, script);
  script = spaced(std::move(script), material_.spacing);
  // Most are short, for what takes long is rare, and time is dear.
  constexpr auto kShortPart = 8;
  constexpr auto kMiddlePart = 3;
  const auto part = dice.one_in(kShortPart) ? 1 : dice.one_in(4) ? kMiddlePart : kShortPart;
  const auto longest = material_.longest / part;
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
  make_playable(material_, script);
}

/// With the epilogue, from whoever sent something last.
void Author::end(Script& script) const {
  const auto places = sent_in(script);
  if (places.empty()) return;
  auto record = script[places.back()];
  record.time = script.back().time;
  for (const auto message : material_.epilogue.messages) {
    const auto bytes = std::as_bytes(std::span{message});
    record.time += material_.epilogue.pause;
    record.bytes.assign(bytes.begin(), bytes.end());
    script.push_back(record);
  }
}

}  // namespace armjig::campaign
