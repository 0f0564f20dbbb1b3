// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/repertoire.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <utility>

#include "emulators/sessions/dice.hpp"

namespace armjig::campaign {
namespace {

/// Sessions that are looked through for kinds of messages, and how many kinds are enough.
constexpr int kSessions = 60;
constexpr std::size_t kEnoughKinds = 32;
/// Records before a message, at most, where there is a choice.
constexpr std::size_t kFewBefore = 60;
/// Records that lead into a state again.
constexpr std::size_t kBack = 2;

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
  if (code_in(message) == nullptr) return name;
  const auto* const named = name_of_code(message);
  return name.append(named == nullptr ? "?" : named->name);
}

}  // namespace

Repertoire::Repertoire(const Material& material, std::uint64_t seed)
    : material_{material}, rehearsal_{material} {
  if (material_.draw_session == nullptr) return;
  std::map<std::string, Kind> found;
  sessions::Dice dice{seed};
  for (int i = 0; i < kSessions; ++i) {
    note_messages(session_of(dice.number<std::uint64_t>(0, INT64_MAX)), found);
  }
  find_looks(found);
  std::vector<Kind*> frequent;
  for (auto& [name, kind] : found) frequent.push_back(&kind);
  std::ranges::stable_sort(frequent, std::ranges::greater{}, &Kind::times);
  if (frequent.size() > kEnoughKinds) frequent.resize(kEnoughKinds);
  for (auto* const kind : frequent) {
    keep_permitted(kind->settings);
    std::ranges::stable_sort(kind->settings, {},
                             [](const Setting& one) { return one.before.size(); });
    samples_.push_back(kind->settings.front().exchange);
  }
  // What a session has had before, only the session itself says.
  if (material_.kind != LinkKind::kSession) rehearsal_.begin_after(samples_);
  if (material_.kind == LinkKind::kBus) find_motion(frequent);
  for (auto* const kind : frequent) {
    auto& settings = kinds_.emplace_back(in_two_states(std::move(kind->settings)));
    for (auto& setting : settings) {
      setting.telling = telling_of(setting);
      for (const auto& [size, exchange] : kind->of_size) setting.variants.push_back(exchange);
    }
  }
  if (material_.kind == LinkKind::kStream && is_rehearsed()) find_mover();
}

void Repertoire::find_mover() {
  std::size_t most = 0;
  for (const auto& kind : kinds_) {
    const auto& exchange = kind.front().exchange;
    const bool strays = material_.strays != nullptr && material_.strays(exchange.front().bytes);
    if (strays || !is_permitted(material_, exchange)) continue;
    auto led = led_to(kind.front());
    const auto effect = effect_of(led);
    if (effect > most) mover_ = std::move(led);
    most = std::max(most, effect);
  }
}

/// Where some may be sent by themselves, only those.
void Repertoire::keep_permitted(std::vector<Setting>& settings) const {
  const auto may_be_sent = [this](const Setting& one) {
    return is_permitted(material_, one.exchange);
  };
  if (std::ranges::any_of(settings, may_be_sent)) std::erase_if(settings, std::not_fn(may_be_sent));
}

/// Of each kind of exchange that asks, the first.
void Repertoire::find_looks(const std::map<std::string, Kind>& found) {
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
bool Repertoire::is_look(const Script& exchange, const std::vector<Script>& others) const {
  if (!rehearsal_.is_possible()) return true;
  std::set<std::string> names;
  return std::ranges::all_of(others, [&](const Script& other) {
    const auto before = to(exchange.front().id, other);
    names.insert(rehearsal_.last_said(joined(before, exchange, kStep)));
    return names.size() == 1 && !names.contains("noise") && !names.contains("");
  });
}

/// As it may be played here, without its pauses.
Script Repertoire::session_of(std::uint64_t seed) const {
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

void Repertoire::note_messages(const Script& session, std::map<std::string, Kind>& found) const {
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
    kind.of_size.try_emplace(exchange.front().bytes.size(), exchange);
    if (exchange.size() > 1 && kind.looks.size() < kMostLooks) kind.looks.push_back(exchange);
    if (std::exchange(name_before, name) == name || ++times[name] > kMostOfOneSession) continue;
    if (kind.settings.size() >= kMostSettings) continue;
    Script before(session.begin(), begin);
    auto back = last_sent(before, kBack);
    kind.settings.push_back({std::move(before),
                             std::move(exchange),
                             std::move(back),
                             std::move(messages.front()),
                             {},
                             {}});
  }
}

/// Where it does most; or, if nobody knows, where much was done before it and where little was.
std::vector<Setting> Repertoire::in_two_states(std::vector<Setting> all) const {
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
Setting Repertoire::led_to(Setting setting) const {
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

std::size_t Repertoire::effect_of(const Setting& setting) const {
  return difference_of(said_after(setting, {}), said_after(setting, setting.exchange));
}

/// The first look that has another answer after it, and has it for some time; or, if there is none,
/// that has another one.
Script Repertoire::telling_of(const Setting& setting) const {
  Script telling;
  for (const auto& one : looks_) {
    const auto look = to(setting.exchange.front().id, one);
    const auto said = [&](const Script& exchange) {
      return rehearsal_.said_after(setting.before, exchange, joined(look, look, kWatched));
    };
    const auto after = said(setting.exchange);
    if (difference_of(said({}), after) == 0) continue;
    const auto is_lasting = [](const std::string& twice) {
      const auto half = twice.size() / 2;
      return twice.substr(0, half) == twice.substr(half);
    };
    if (std::ranges::all_of(after, is_lasting)) return look;
    if (telling.empty()) telling = look;
  }
  return telling;
}

/// And in another state than that.
std::vector<Setting> Repertoire::where_it_does_most(const std::vector<Setting>& all) const {
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

Rehearsal::Said Repertoire::said_after(const Setting& setting, const Script& exchange) const {
  Script questions;
  look_at_all(questions, setting.exchange.front().id);
  return rehearsal_.said_after(setting.before, exchange,
                               joined(std::move(questions), material_.harmless, kStep));
}

/// One or two messages after which what is read goes on changing, the first that there are.
void Repertoire::find_motion(const std::vector<Kind*>& kinds) {
  const auto goes_on = [&](const Script& script) {
    Script question;
    look_at_all(question, script.front().id);
    return rehearsal_.goes_on_after(script, question);
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
std::vector<Script> Repertoire::variants_of(const std::vector<Setting>& settings) const {
  constexpr std::size_t kMost = 5;
  std::vector<Script> variants;
  for (const auto& setting : settings) {
    const auto& exchange = setting.exchange;
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
    if (!floats.empty()) variants.push_back(with_number(material_, any, floats, number));
  }
  return variants;
}

void Repertoire::look_at_all(Script& body, std::uint32_t address, Duration pause) const {
  for (const auto& one : looks_) {
    const auto look = to(address, one);
    add(body, look.front(), std::exchange(pause, kStep));
    add(body, Script(look.begin() + 1, look.end()));
  }
}

Script with_number(const Material& material, const Setting& setting, std::span<const Field> fields,
                   std::int64_t number) {
  auto exchange = setting.exchange;
  set_number(material, exchange.front(), setting.message, fields, number, 1);
  return exchange;
}

}  // namespace armjig::campaign
