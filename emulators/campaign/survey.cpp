// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/survey.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "emulators/sessions/dice.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

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
/// So often in the time in which something is watched.
constexpr int kTimesWatched = 7;
constexpr int kSomeTimes = 20;
/// More than a counter of ten bits counts.
constexpr int kManyTimes = 1200;

void add(Script& body, KeptRecord record, Duration pause = kStep) {
  record.time = body.empty() ? Instant{} : body.back().time + pause;
  body.push_back(std::move(record));
}
void add(Script& body, const Script& more) {
  for (const auto& record : more) add(body, record);
}
void repeat(Script& body, const KeptRecord& record, int count, Duration pause) {
  for (int i = 0; i < count; ++i) add(body, record, pause);
}

/// The same, all of it to the device there.
Script to(std::uint32_t address, Script script) {
  for (auto& record : script) record.id = address;
  return script;
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

KeptRecord in_one_piece(KeptRecord one, const KeptRecord& next) {
  one.bytes.insert(one.bytes.end(), next.bytes.begin(), next.bytes.end());
  return one;
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

/// What is said more than twice on end.
void leave_out_repetitions(Script& script) {
  std::size_t kept = 0;
  const auto is_same = [](const KeptRecord& one, const KeptRecord& other) {
    return one.kind == other.kind && one.direction == other.direction && one.id == other.id &&
           one.bytes == other.bytes && one.details == other.details;
  };
  for (std::size_t i = 0; i < script.size(); ++i) {
    if (kept >= 2 && is_same(script[i], script[kept - 1]) && is_same(script[i], script[kept - 2])) {
      continue;
    }
    if (kept != i) script[kept] = std::move(script[i]);
    ++kept;
  }
  script.resize(kept);
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

Survey::Survey(const Material& material, std::uint64_t seed)
    : material_{material}, rehearsal_{material} {
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
  find_looks(found);
  std::vector<Kind*> frequent;
  for (auto& [name, kind] : found) frequent.push_back(&kind);
  std::ranges::stable_sort(frequent, std::ranges::greater{}, &Kind::times);
  if (frequent.size() > kMostKinds) frequent.resize(kMostKinds);
  for (auto* const kind : frequent) {
    keep_permitted(kind->settings);
    std::ranges::stable_sort(kind->settings, {},
                             [](const Setting& one) { return one.before.size(); });
    samples_.push_back(kind->settings.front().exchange);
  }
  // What a session has had before, only the session itself says.
  if (material_.kind != LinkKind::kSession) rehearsal_.begin_after(samples_);
  if (material_.kind == LinkKind::kBus) find_motion(frequent);
  for (auto* const kind : frequent) kinds_.push_back(in_two_states(std::move(kind->settings)));
}

/// Where some may be sent by themselves, only those.
void Survey::keep_permitted(std::vector<Setting>& settings) const {
  if (!material_.permit) return;
  const auto is_permitted = [this](const Setting& one) {
    auto exchange = one.exchange;
    material_.permit(exchange);
    return exchange.size() == one.exchange.size();
  };
  if (std::ranges::any_of(settings, is_permitted))
    std::erase_if(settings, std::not_fn(is_permitted));
}

/// Of each kind of exchange that asks, the first.
void Survey::find_looks(const std::map<std::string, Kind>& found) {
  std::vector<Script> others;
  for (const auto& [name, kind] : found) {
    if (!kind.looks.empty()) others.push_back(kind.looks.front());
  }
  for (const auto& [name, kind] : found) {
    const auto look =
        std::ranges::find_if(kind.looks, [&](const Script& one) { return is_look(one, others); });
    if (look != kind.looks.end()) looks_.push_back(*look);
  }
}

/// Whatever was chosen before, it chooses what is read.
bool Survey::is_look(const Script& exchange, const std::vector<Script>& others) const {
  if (!rehearsal_.is_possible()) return true;
  std::set<std::string> names;
  return std::ranges::all_of(others, [&](const Script& other) {
    const auto before = to(exchange.front().id, other);
    names.insert(rehearsal_.last_said(joined(before, exchange, kStep)));
    return names.size() == 1 && !names.contains("noise") && !names.contains("");
  });
}

/// As it may be played here, without its pauses.
Script Survey::session_of(std::uint64_t seed) const {
  auto script =
      read_script(material_.draw_session(seed), "a session drawn at random").value_or(Script{});
  leave_out_unplayable(material_, script);
  make_playable(material_, script);
  leave_out_repetitions(script);
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
  constexpr std::size_t kMostLooks = 8;
  constexpr int kMostOfOneSession = 4;
  std::map<std::string, int> times;
  std::string name_before;
  for (const auto place : sent_in(session)) {
    const auto dissector = material_.make_dissector();
    auto messages = messages_in(session[place], *dissector);
    if (messages.size() != 1 || !messages.front().fault.empty()) continue;
    const auto name = name_of(messages.front());
    auto& kind = found[name];
    ++kind.times;
    const auto begin = session.begin() + static_cast<std::ptrdiff_t>(place);
    const auto last = static_cast<std::ptrdiff_t>(end_of_exchange(session, place));
    Script exchange;
    add(exchange, Script(begin, session.begin() + last + 1));
    if (exchange.size() > 1 && kind.looks.size() < kMostLooks) kind.looks.push_back(exchange);
    if (std::exchange(name_before, name) == name || ++times[name] > kMostOfOneSession) continue;
    if (kind.settings.size() >= kMostSettings) continue;
    Script before(session.begin(), begin);
    auto back = last_sent(before, kBack);
    kind.settings.push_back(
        {std::move(before), std::move(exchange), std::move(back), std::move(messages.front())});
  }
}

/// Where it does most; or, if nobody knows, where much was done before it and where little was.
std::vector<Survey::Setting> Survey::in_two_states(std::vector<Setting> all) const {
  const bool is_known = rehearsal_.is_possible() && material_.kind != LinkKind::kSession;
  if (is_known) {
    all.push_back(led_to(all.front()));
    std::ranges::stable_sort(all, {}, [](const Setting& one) { return one.before.size(); });
  }
  while (all.size() > 2 && all.back().before.size() > kFewBefore) all.pop_back();
  if (is_known) return where_it_does_most(all);
  std::vector<Setting> two{all[all.size() * 3 / 4]};
  if (all.size() > 1) two.push_back(all[all.size() / 4]);
  return two;
}

/// The same message after one or two others, of which each makes it do more.
Survey::Setting Survey::led_to(Setting setting) const {
  constexpr int kMost = 2;
  setting.before.clear();
  auto most = effect_of(setting);
  for (int i = 0; i < kMost; ++i) {
    auto best = setting;
    for (const auto& sample : samples_) {
      auto led = setting;
      led.before = joined(sample, setting.before, kStep);
      if (material_.kind == LinkKind::kStream)
        led.before.insert(led.before.begin(), sample.begin(), sample.end());
      const auto effect = effect_of(led);
      if (effect <= most) continue;
      most = effect;
      best = std::move(led);
    }
    setting.before = std::move(best.before);
  }
  setting.back = last_sent(setting.before, kBack);
  return setting;
}

std::size_t Survey::effect_of(const Setting& setting) const {
  return difference_of(said_after(setting, {}), said_after(setting, setting.exchange));
}

/// And in another state than that.
std::vector<Survey::Setting> Survey::where_it_does_most(const std::vector<Setting>& all) const {
  std::vector<Trial> trials;
  for (const auto& setting : all) {
    auto without = said_after(setting, {});
    const auto effect = difference_of(without, said_after(setting, setting.exchange));
    trials.push_back({&setting, std::move(without), effect});
  }
  // Where it does not answer, as after half a message, nothing is seen.
  const auto size_of = [](const Trial& one) {
    return std::ranges::min(one.without, {}, &std::string::size).size();
  };
  const auto most = size_of(std::ranges::max(trials, {}, size_of));
  std::erase_if(trials, [&](const Trial& one) { return 2 * size_of(one) < most; });
  std::ranges::stable_sort(trials, std::ranges::greater{}, &Trial::effect);
  std::vector<Setting> two{*trials.front().setting};
  const auto other = std::ranges::find_if(
      trials, [&](const Trial& one) { return one.without != trials.front().without; });
  if (other != trials.end()) two.push_back(*other->setting);
  return two;
}

/// What a sound device says then, asked for all that it tells.
Rehearsal::Said Survey::said_after(const Setting& setting, const Script& exchange) const {
  Script questions;
  look_at_all(questions, setting.exchange.front().id);
  return rehearsal_.said_after(setting.before, exchange,
                               joined(std::move(questions), material_.harmless, kStep));
}

/// One or two messages after which what is read goes on changing, the first that there are.
void Survey::find_motion(const std::vector<Kind*>& kinds) {
  const auto goes_on = [&](const Script& script) {
    Script question;
    look_at_all(question, script.front().id);
    return rehearsal_.evolution_of(script, question, material_.rules) > 0;
  };
  std::vector<Script> seconds;
  for (const auto* const kind : kinds) {
    std::ranges::move(variants_of(kind->settings), std::back_inserter(seconds));
  }
  std::vector<Script> all = seconds;
  for (const auto& first : samples_) {
    for (const auto& second : seconds) {
      add(all.emplace_back(first), to(first.front().id, second));
    }
  }
  const auto found = std::ranges::find_if(all, goes_on);
  if (found != all.end()) motion_ = *found;
}

/// With some numbers of sessions, and with larger ones.
std::vector<Script> Survey::variants_of(const std::vector<Setting>& settings) const {
  constexpr std::size_t kMost = 5;
  std::vector<Script> variants;
  for (const auto& [before, exchange, back, message] : settings) {
    const auto is_same = [&](const Script& one) {
      return one.front().bytes == exchange.front().bytes;
    };
    if (std::ranges::none_of(variants, is_same)) variants.push_back(exchange);
    if (variants.size() == kMost) break;
  }
  const auto& any = settings.front();
  std::vector<Field> floats;
  std::ranges::copy_if(any.message.fields, std::back_inserter(floats),
                       [](const Field& field) { return field.encoding == Encoding::kFloatLittle; });
  for (const auto number : {20, -20}) {
    if (!floats.empty()) variants.push_back(with_number(any, floats, number));
  }
  return variants;
}

void Survey::plan() {
  const auto of_all = [this](std::size_t state, std::initializer_list<Body> bodies) {
    for (const auto body : bodies) {
      for (const auto& kind : kinds_) {
        if (state < kind.size()) plan(kind[state], body);
      }
    }
  };
  of_all(0, {&Survey::some_copies, &Survey::spoiled_copies, &Survey::watched_lengths,
             &Survey::watched_pairs, &Survey::pairs});
  const auto idle_ones = plan_values(0, &Survey::values);
  of_all(0, {&Survey::lengths, &Survey::odd_bytes});
  for (const auto& one : looks_) {
    cases_.emplace_back([this, &one] { return whole({}, copies(one, kManyTimes)); });
  }
  const auto watched_idle_ones = plan_values(0, &Survey::watched_values);
  if (!kinds_.empty()) plan(kinds_.front().front(), &Survey::long_gap);
  of_all(0, {&Survey::sums});
  const auto other_idle_ones = plan_values(1, &Survey::values);
  of_all(1, {&Survey::some_copies, &Survey::pairs});
  of_all(0, {&Survey::sizes});
  for (const auto* const late : {&idle_ones, &other_idle_ones, &watched_idle_ones}) {
    cases_.insert(cases_.end(), late->begin(), late->end());
  }
  of_all(0, {&Survey::many_copies, &Survey::long_gap});
}

void Survey::plan(const Setting& setting, Body body) {
  if ((this->*body)(setting).empty()) return;  // nothing of the kind on this link
  cases_.emplace_back([this, &setting, body] { return whole(setting, (this->*body)(setting)); });
}

/// `of_field` of a field of each kind, then of another of each. Those that change nothing are for
/// later.
std::vector<Survey::Case> Survey::plan_values(std::size_t state, OfField of_field) {
  std::vector<Case> idle_ones;
  bool is_one_left = true;
  for (std::size_t number = 0; std::exchange(is_one_left, false); ++number) {
    for (const auto& kind : kinds_) {
      if (state >= kind.size() || number >= kind[state].message.fields.size()) continue;
      is_one_left = true;
      const auto& setting = kind[state];
      const auto& field = setting.message.fields[number];
      const bool is_code = &field == code_in(setting.message);
      if (!can_choose(setting, field) || (is_code && &kind != &kinds_.front())) continue;
      if ((this->*of_field)(setting, field).empty()) continue;
      auto& cases = matters(setting, field) ? cases_ : idle_ones;
      cases.emplace_back([this, &setting, &field, of_field] {
        return whole(setting, (this->*of_field)(setting, field));
      });
    }
  }
  return idle_ones;
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

/// Whether a sound device says something else after another number. Where nobody knows, each does.
bool Survey::matters(const Setting& setting, const Field& field) {
  if (!rehearsal_.is_possible() || field.place == Place::kPiece) return true;
  const auto [known, is_new] = matter_.try_emplace({&setting, &field});
  if (!is_new) return known->second;
  const auto as_it_is = said_after(setting, setting.exchange);
  const auto top = std::int64_t{1} << (8U * field.width - 1U);
  const std::array numbers{std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, top - 1, -top};
  known->second = std::ranges::any_of(numbers, [&](std::int64_t number) {
    return said_after(setting, with_number(setting, {&field, 1}, number)) != as_it_is;
  });
  return known->second;
}

Script Survey::whole(const Setting& setting, const Script& body) const {
  auto script = joined(setting.before, body, kStep);
  if (!body.empty()) look_at_all(script, body.back().id);
  if (material_.kind == LinkKind::kSession) script = spaced(std::move(script), {.least = kTick});
  script = spaced(std::move(script), material_.spacing);
  std::erase_if(script,
                [&](const KeptRecord& one) { return one.time > Instant{material_.longest}; });
  if (material_.permit) material_.permit(script);
  return script;
}

void Survey::look(Script& body, std::size_t which) const {
  if (!looks_.empty()) add(body, to(body.back().id, looks_[which % looks_.size()]));
}

void Survey::look_at_all(Script& body, std::uint32_t address, Duration pause) const {
  for (const auto& one : looks_) {
    const auto look = to(address, one);
    add(body, look.front(), std::exchange(pause, kStep));
    add(body, Script(look.begin() + 1, look.end()));
  }
}

/// What comes of it, for so long that it is not taken for what was before or comes next: on a
/// stream as its own answer, on a bus by what moves on.
void Survey::add_watched(Script& body, const Script& odd) const {
  if (material_.kind == LinkKind::kStream) {
    return repeat(body, odd.front(), kTimesWatched, kWatched / kTimesWatched);
  }
  const auto address = odd.front().id;
  add(body, to(address, motion_));
  add(body, odd.front(), kSpeedUp);
  add(body, Script(odd.begin() + 1, odd.end()));
  look_at_all(body, address, kWatched);
}

bool Survey::can_be_watched() const {
  return material_.kind == LinkKind::kStream || !motion_.empty();
}

Script Survey::watched_lengths(const Setting& setting) const {
  Script body;
  if (motion_.empty()) return body;
  const auto size = setting.exchange.front().bytes.size();
  for (const auto other : {size + 1, size - 1, size - 2, size / 2}) {
    if (other == 0 || other > size + 1) continue;
    add_watched(body, {with(setting.exchange.front(), cut(setting.exchange.front().bytes, other))});
  }
  return body;
}

Script Survey::watched_pairs(const Setting& setting) const {
  Script body;
  if (material_.kind != LinkKind::kStream) return body;
  for (const auto& kind : kinds_) {
    const auto& other = kind.front().exchange;
    add(body, setting.exchange);
    add_watched(body, other);
    add_watched(body, {in_one_piece(setting.exchange.front(), other.front())});
  }
  return body;
}

Script Survey::watched_values(const Setting& setting, const Field& field) const {
  Script body;
  if (!can_be_watched() || field.place == Place::kPiece) return body;
  if (field.encoding == Encoding::kFloatLittle) {
    for (const auto bits : kOddFloats) add_watched(body, with_bits(setting, field, bits));
    return body;
  }
  const auto top = std::int64_t{1} << (8U * field.width);
  const std::array<std::int64_t, 12> numbers{0,    1,    -1,     -128,  127,         255,
                                             -256, 1000, -32769, 32768, top / 2 - 1, -top / 2};
  for (const auto number : numbers) {
    if (number < top && number >= -top) {
      add_watched(body, with_number(setting, {&field, 1}, number));
    }
  }
  return body;
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
    add(body, in_one_piece(setting.exchange.front(), other.front()));
    if (material_.kind == LinkKind::kSession) add(body, setting.exchange);
  }
  return body;
}

/// On a bus with something that was chosen before read after each.
Script Survey::some_copies(const Setting& setting) const {
  if (looks_.empty()) return copies(setting.exchange, kSomeTimes);
  Script body;
  for (const auto& one : looks_) {
    const auto look = to(setting.exchange.front().id, one);
    add(body, look);
    for (int i = 0; i < kSomeTimes; ++i) {
      add(body, setting.exchange.front());
      add(body, look.back());
    }
  }
  return body;
}

Script Survey::many_copies(const Setting& setting) const {
  return copies(setting.exchange, kManyTimes);
}

/// With another last byte, which no checksum has.
Script Survey::spoiled_copies(const Setting& setting) const {
  auto bytes = setting.exchange.front().bytes;
  bytes.back() ^= std::byte{1};
  return copies(with(setting.exchange, std::move(bytes)), kSomeTimes);
}

/// Each value of a checksum of one byte.
Script Survey::sums(const Setting& setting) const {
  Script body;
  const auto& fields = setting.message.fields;
  const auto field = std::ranges::find_if(fields, [&](const Field& one) {
    return one.place == Place::kBytes && one.width > 1 && can_choose(setting, one);
  });
  if (material_.seal == nullptr || field == fields.end()) return body;
  const auto own = field_value(*field, setting.message.raw);
  for (int low = 0; low < 256; ++low) {
    auto raw = setting.message.raw;
    set_field_value(*field, raw, (own & ~std::int64_t{255}) | low);
    auto exchange = setting.exchange;
    if (put(raw, exchange.front())) seal(material_, exchange.front());
    add(body, exchange);
    look(body, static_cast<std::size_t>(low));
  }
  return body;
}

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
  Script body;
  std::size_t number = 0;
  const auto put_value = [&](std::int64_t value) {
    add(body, with_number(setting, {&field, 1}, value));
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
      add(body, with_bits(setting, field, bits));
      look_at_all(body, setting.exchange.front().id);
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

Script Survey::with_number(const Setting& setting, std::span<const Field> fields,
                           std::int64_t number) const {
  auto exchange = setting.exchange;
  set_number(material_, exchange.front(), setting.message, fields, number, 1);
  return exchange;
}

/// With those bits in a field that is a float.
Script Survey::with_bits(const Setting& setting, const Field& field, std::int64_t bits) const {
  auto raw = setting.message.raw;
  set_field_value(field, raw, bits);
  auto exchange = setting.exchange;
  if (put(raw, exchange.front())) seal(material_, exchange.front());
  return exchange;
}

}  // namespace armjig::campaign
