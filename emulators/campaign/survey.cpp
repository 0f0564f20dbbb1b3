// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/survey.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <utility>

#include "emulators/sessions/dice.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

/// Between two things that are done.
constexpr Duration kStep = 3ms;
/// Lines that come no faster do not wait for a server that reads every 10 ms: a client that leaves
/// meanwhile may or may not have its answers.
constexpr Duration kTick = 12ms;
/// Sessions that are looked through for kinds of messages, and how many kinds are enough.
constexpr int kSessions = 60;
constexpr std::size_t kMostKinds = 32;
/// Records before a message, at most, where there is a choice.
constexpr std::size_t kFewBefore = 60;
/// Records that lead into a state again.
constexpr std::size_t kBack = 2;

void add(Script& body, KeptRecord record, Duration pause = kStep) {
  record.time = body.empty() ? Instant{} : body.back().time + pause;
  body.push_back(std::move(record));
}
void add(Script& body, const Script& more) {
  for (const auto& record : more) add(body, record);
}

/// What the record sends, in another form.
KeptRecord with(KeptRecord record, std::vector<std::byte> bytes) {
  record.bytes = std::move(bytes);
  return record;
}
Script with(Script exchange, std::vector<std::byte> bytes) {
  exchange.front().bytes = std::move(bytes);
  return exchange;
}

std::vector<std::byte> cut(std::vector<std::byte> bytes, std::size_t size) {
  bytes.resize(size);
  return bytes;
}

Script copies(const Script& exchange, int count) {
  Script body;
  for (int i = 0; i < count; ++i) add(body, exchange);
  return body;
}

Script last_sent(const Script& script, std::size_t count) {
  Script last;
  for (auto one = script.rbegin(); one != script.rend() && last.size() < count; ++one) {
    if (is_sent(*one)) last.push_back(*one);
  }
  std::ranges::reverse(last);
  return last;
}

/// Its name and that of its code; those without a name are of one kind.
std::string name_of(const Message& message) {
  std::string name{message.name};
  const auto* const code = code_in(message);
  if (code == nullptr) return name;
  const auto named =
      std::ranges::find(code->values, field_value(*code, message.raw), &NamedValue::value);
  return name.append(named == code->values.end() ? "?" : named->name);
}

}  // namespace

Survey::Survey(const Material& material, std::uint64_t seed) : material_{material} {
  if (material_.draw_session == nullptr) return;
  collect(seed);
  plan();
}

void Survey::collect(std::uint64_t seed) {
  std::map<std::string, Kind> found;
  sessions::Dice dice{seed};
  for (int i = 0; i < kSessions; ++i) {
    note_messages(session_of(dice.number<std::uint64_t>(0, INT64_MAX)), found);
  }
  for (auto& [name, kind] : found) {
    if (!kind.look.empty()) looks_.push_back(std::move(kind.look));
  }
  std::vector<Kind*> frequent;
  for (auto& [name, kind] : found) frequent.push_back(&kind);
  std::ranges::stable_sort(frequent, std::ranges::greater{}, &Kind::times);
  if (frequent.size() > kMostKinds) frequent.resize(kMostKinds);
  for (auto* const kind : frequent) kinds_.push_back(in_two_states(std::move(kind->settings)));
}

/// As it may be played here, without its pauses.
Script Survey::session_of(std::uint64_t seed) const {
  auto script =
      read_script(material_.draw_session(seed), "a session drawn at random").value_or(Script{});
  leave_out_unplayable(material_, script);
  make_playable(material_, script);
  hurry(script, kStep);
  for (auto& record : script) {
    if (record.kind != LinkKind::kBus || material_.addresses.empty()) continue;
    record.id = material_.addresses[record.id % material_.addresses.size()];
  }
  if (material_.permit) material_.permit(script);
  return script;
}

void Survey::note_messages(const Script& session, std::map<std::string, Kind>& found) const {
  constexpr std::size_t kMostSettings = 24;
  for (const auto place : sent_in(session)) {
    const auto dissector = material_.make_dissector();
    auto messages = messages_in(session[place], *dissector);
    if (messages.size() != 1 || !messages.front().fault.empty()) continue;
    auto& kind = found[name_of(messages.front())];
    ++kind.times;
    const auto begin = session.begin() + static_cast<std::ptrdiff_t>(place);
    const auto last = static_cast<std::ptrdiff_t>(end_of_exchange(session, place));
    Script exchange(begin, session.begin() + last + 1);
    if (exchange.size() > 1 && kind.look.empty()) kind.look = exchange;
    if (kind.settings.size() >= kMostSettings) continue;
    Script before(session.begin(), begin);
    auto back = last_sent(before, kBack);
    kind.settings.push_back(
        {std::move(before), std::move(exchange), std::move(back), std::move(messages.front())});
  }
}

/// Where much was done before it, and where little was.
std::vector<Survey::Setting> Survey::in_two_states(std::vector<Setting> all) {
  std::ranges::stable_sort(all, {}, [](const Setting& one) { return one.before.size(); });
  while (all.size() > 2 && all.back().before.size() > kFewBefore) all.pop_back();
  std::vector<Setting> two{all[all.size() * 3 / 4]};
  if (all.size() > 1) two.push_back(all[all.size() / 4]);
  return two;
}

void Survey::plan() {
  const auto of_all = [this](std::size_t state, std::initializer_list<Body> bodies) {
    for (const auto& kind : kinds_) {
      if (state >= kind.size()) continue;
      for (const auto body : bodies) plan(kind[state], body);
    }
  };
  of_all(0, {&Survey::pairs, &Survey::some_copies, &Survey::lengths, &Survey::odd_bytes});
  plan_values(0);
  of_all(1, {&Survey::pairs, &Survey::some_copies});
  of_all(0, {&Survey::sizes});
  if (!kinds_.empty()) plan(kinds_.front().front(), &Survey::long_gap);
  plan_values(1);
  of_all(0, {&Survey::many_copies, &Survey::long_gap});
}

void Survey::plan(const Setting& setting, Body body) {
  cases_.emplace_back([this, &setting, body] { return whole(setting, (this->*body)(setting)); });
}

/// A field of each kind, then another of each.
void Survey::plan_values(std::size_t state) {
  bool is_one_left = true;
  for (std::size_t number = 0; std::exchange(is_one_left, false); ++number) {
    for (const auto& kind : kinds_) {
      if (state >= kind.size() || number >= kind[state].message.fields.size()) continue;
      is_one_left = true;
      const auto& setting = kind[state];
      const auto& field = setting.message.fields[number];
      const bool is_code = &field == code_in(setting.message);
      if (!can_choose(setting, field) || (is_code && &kind != &kinds_.front())) continue;
      cases_.emplace_back(
          [this, &setting, &field] { return whole(setting, values(setting, field)); });
    }
  }
}

/// Not what is always the same, or made right again.
bool Survey::can_choose(const Setting& setting, const Field& field) const {
  if (field.encoding == Encoding::kLiteral) return false;
  if (field.place == Place::kPiece) return true;
  auto other = setting.exchange.front();
  const auto& message = setting.message;
  set_number(material_, other, message, {&field, 1}, field_value(field, message.raw) ^ 1, 1);
  return other.bytes != setting.exchange.front().bytes;
}

Script Survey::whole(const Setting& setting, const Script& body) const {
  auto script = joined(setting.before, body, kStep);
  look_at_all(script);
  if (material_.kind == LinkKind::kSession) script = spaced(std::move(script), {.least = kTick});
  script = spaced(std::move(script), material_.spacing);
  std::erase_if(script,
                [&](const KeptRecord& one) { return one.time > Instant{material_.longest}; });
  if (material_.permit) material_.permit(script);
  return script;
}

void Survey::look(Script& body, std::size_t which) const {
  if (!looks_.empty()) add(body, looks_[which % looks_.size()]);
}

void Survey::look_at_all(Script& body) const {
  for (const auto& one : looks_) add(body, one);
}

Script Survey::pairs(const Setting& setting) const {
  Script body;
  std::size_t number = 0;
  for (const auto& kind : kinds_) {
    auto other = kind.front().exchange;
    if (material_.kind != LinkKind::kBus) other.front().id = setting.exchange.front().id;
    add(body, setting.back);
    add(body, setting.exchange);
    add(body, other);
    look(body, number++);
    if (material_.kind == LinkKind::kBus) continue;
    add(body, setting.back);
    auto both = setting.exchange.front();
    const auto& next = other.front().bytes;
    both.bytes.insert(both.bytes.end(), next.begin(), next.end());
    add(body, std::move(both));
  }
  return body;
}

Script Survey::some_copies(const Setting& setting) const { return copies(setting.exchange, 20); }

/// More than a counter of ten bits counts.
Script Survey::many_copies(const Setting& setting) const { return copies(setting.exchange, 1200); }

Script Survey::lengths(const Setting& setting) const {
  constexpr std::size_t kMost = 40;
  const auto& bytes = setting.exchange.front().bytes;
  Script body;
  for (std::size_t size = bytes.size() + 4; size > 0; --size) {
    if (size + kMost < bytes.size() || size == bytes.size()) continue;
    add(body, setting.back);
    add(body, with(setting.exchange, cut(bytes, size)));
    add(body, setting.exchange);
    look(body, size);
  }
  return body;
}

Script Survey::odd_bytes(const Setting& setting) const {
  Script body;
  if (material_.kind == LinkKind::kBus) return body;
  const auto& bytes = setting.exchange.front().bytes;
  for (const auto odd : kOddBytes) {
    for (const auto place : {std::size_t{0}, bytes.size() / 2,
                             bytes.size() - std::min<std::size_t>(2, bytes.size())}) {
      auto other = bytes;
      other.insert(other.begin() + static_cast<std::ptrdiff_t>(place), static_cast<std::byte>(odd));
      add(body, with(setting.exchange, std::move(other)));
    }
    add(body, setting.back);
  }
  return body;
}

Script Survey::sizes(const Setting& setting) const {
  constexpr std::size_t kMost = 140;
  Script body;
  if (material_.kind == LinkKind::kBus) return body;
  const auto& bytes = setting.exchange.front().bytes;
  auto filler = bytes;
  while (filler.size() < kMost) filler.insert(filler.end(), bytes.begin(), bytes.end());
  for (std::size_t size = 1; size <= kMost; ++size) {
    add(body, with(setting.exchange.front(), cut(filler, size)));
  }
  return body;
}

Script Survey::long_gap(const Setting& setting) const {
  constexpr Duration kBefore = 300ms;
  auto body = setting.exchange;
  add(body, setting.exchange.front(), std::max(kStep, material_.longest - kBefore));
  return body;
}

Script Survey::values(const Setting& setting, const Field& field) const {
  const auto& message = setting.message;
  Script body;
  std::size_t number = 0;
  const auto put_value = [&](std::int64_t value) {
    auto exchange = setting.exchange;
    set_number(material_, exchange.front(), message, {&field, 1}, value, 1);
    add(body, exchange);
  };
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
    for (const auto* const odd : {"+1", "01", " 1", "0x1", "--1", "1.0", "1 ", "1e1", "1\v", ""}) {
      add_text(odd);
    }
    if (!field.values.empty()) return body;
  }
  if (field.encoding == Encoding::kFloatLittle) {
    for (const auto bits : kOddFloats) {
      auto raw = message.raw;
      set_field_value(field, raw, bits);
      auto exchange = setting.exchange;
      if (put(raw, exchange.front())) seal(material_, exchange.front());
      add(body, exchange);
      look_at_all(body);
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

}  // namespace armjig::campaign
