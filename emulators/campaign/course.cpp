// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/course.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "emulators/campaign/edit.hpp"
#include "emulators/campaign/talk.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

/// So far apart that what is late does not come together with what is next.
constexpr Duration kBetweenPieces = 6ms;
/// Not where it is just now, but where that is for so long.
constexpr int kSeconds = 3;

/// The message again and again for so long that its answers are not taken for others.
void add_held(Script& body, const Script& exchange, int times, Duration time) {
  for (int i = 0; i < times; ++i) add(body, exchange.front(), time / times);
}

}  // namespace

Courses::Courses(const Material& material, const Repertoire& repertoire) : material_{material} {
  if (material.kind != LinkKind::kStream || material.strays == nullptr) return;
  if (!material.rehearse || !material.permit_case || !material.can_be_reset) return;
  for (const auto& kind : repertoire.kinds()) {
    const auto& setting = kind.front();
    const bool strays = material.strays(setting.exchange.front().bytes);
    auto& those = !is_permitted(material, setting.exchange) ? closed_ : strays ? deeds_ : others_;
    those.push_back(&setting);
  }
}

std::vector<Script> Courses::steered() const {
  std::vector<Script> all;
  for (const auto* const closed : closed_) {
    for (const auto* const deed : deeds_) {
      auto script = steered(*closed, *deed);
      if (script.empty()) continue;
      all.push_back(std::move(script));
      break;
    }
  }
  return all;
}

/// What was sent last may begin the deed again, or end it: others are tried after it.
Script Courses::steered(const Setting& closed, const Setting& deed) const {
  for (const auto* const other : others_) {
    const auto ended = to_its_end(deed, *other);
    if (!ended) continue;
    const auto told = told_after(*ended);
    const auto wheel = wheel_of(closed, *ended, told);
    if (wheel) return joined(*ended, legs(*wheel, told, permitted(deed.before)), kBetweenPieces);
  }
  return {};
}

Courses::Told Courses::told_after(const Script& script) const {
  Told told;
  const auto said =
      messages_of(material_.rehearse(joined(script, material_.harmless, kBetweenPieces)),
                  material_.make_dissector);
  for (const auto& [lane, messages] : said.lanes()) {
    if (messages.empty()) continue;
    const auto& last = messages.back().message;
    for (const auto& field : last.fields) {
      if (field.place == Place::kBytes) {
        told.insert_or_assign(std::string{field.name}, field_value(field, last.raw));
      }
    }
  }
  for (const auto& rule : material_.rules.fields) {
    if (rule.is_ignored) told.erase(rule.name);
  }
  return told;
}

std::optional<Script> Courses::to_its_end(const Setting& deed, const Setting& other) const {
  constexpr std::array kTimes{10s, 15s, 20s, 25s, 30s, 35s, 40s, 45s};
  auto begun = joined(permitted(deed.before), deed.exchange, kStep);
  add(begun, other.exchange.front(), kBetweenPieces);
  for (const auto time : kTimes) {
    auto script = joined(begun, material_.harmless, time);
    const auto told = told_after(script);
    auto later = script;
    bool is_over = true;
    for (int i = 0; i < kSeconds && is_over; ++i) {
      later = joined(std::move(later), material_.harmless, 1s);
      is_over = told_after(later) == told;
    }
    if (is_over) return joined(begun, material_.harmless, time * 3 / 2);
  }
  return std::nullopt;
}

Script Courses::permitted(Script script) const {
  material_.permit_case(script);
  return script;
}

bool Courses::is_permitted_after(const Script& before, const Script& exchange) const {
  const auto script = joined(before, exchange, kBetweenPieces);
  return permitted(script).size() == script.size();
}

Script Courses::with(const Wheel& wheel, const Told& numbers) const {
  auto exchange = wheel.setting->exchange;
  for (const auto* const fields : {&wheel.places, &wheel.numbers, &wheel.bits}) {
    for (const auto& field : *fields) {
      const auto number = numbers.find(field.name);
      if (number == numbers.end()) continue;
      set_field_value(field, exchange.front().bytes, number->second);
    }
  }
  seal(material_, exchange.front());
  return exchange;
}

std::optional<Courses::Wheel> Courses::wheel_of(const Setting& setting, const Script& before,
                                                const Told& told) const {
  constexpr std::int64_t kFar = 5000;
  Wheel wheel{&setting, {}, {}, {}};
  const auto* const code = code_in(setting.message);
  for (const auto& field : setting.message.fields) {
    const bool is_fixed = field.place != Place::kBytes || field.encoding == Encoding::kLiteral;
    if (&field == code || is_fixed) continue;
    if (told.contains(field.name) && field.width > 1) {
      wheel.numbers.push_back(field);
    } else if (!field.bits.empty()) {
      wheel.bits.push_back(field);
    }
  }
  if (wheel.numbers.empty() || !is_permitted_after(before, with(wheel, told))) return std::nullopt;
  std::vector<Field> numbers;
  for (const auto& field : wheel.numbers) {
    auto far = told;
    far.find(field.name)->second += kFar;
    auto& those = is_permitted_after(before, with(wheel, far)) ? numbers : wheel.places;
    those.push_back(field);
  }
  wheel.numbers = std::move(numbers);
  return wheel;
}

/// On each leg some go up, some down and some stay, and all other numbers are the same; then it is
/// held until all has come to rest. `back` is sent before the next one, as before the deed.
Script Courses::legs(const Wheel& wheel, Told at, const Script& back) const {
  constexpr std::size_t kLegs = 48;
  constexpr int kPieces = 24;
  constexpr std::int64_t kPiece = 20;
  constexpr std::array<std::int64_t, 16> kNumbers{0,    1,   -1,   128,   -128,  255,  256,  -256,
                                                  1000, 127, -999, 0x101, -4096, 4096, 2000, -2000};
  Script body;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    for (std::size_t i = 0; i < wheel.numbers.size(); ++i) {
      at.insert_or_assign(std::string{wheel.numbers[i].name},
                          leg % 3 == 0 ? 0 : kNumbers[(leg + 5 * i) % kNumbers.size()]);
    }
    for (const auto& field : wheel.bits) {
      const auto own = field_value(field, wheel.setting->message.raw);
      at.insert_or_assign(std::string{field.name},
                          leg % 2 == 0 ? own : static_cast<std::int64_t>(leg * 37 % 256));
    }
    for (int piece = 0; piece < kPieces; ++piece) {
      for (std::size_t i = 0; i < wheel.places.size(); ++i) {
        const auto direction = static_cast<std::int64_t>((leg / (i + 3) + i) % 3) - 1;
        at.find(wheel.places[i].name)->second += direction * kPiece;
      }
      add(body, with(wheel, at).front(), kBetweenPieces);
    }
    add_held(body, with(wheel, at), 4, 120ms);
    const auto& other = others_[leg % others_.size()]->exchange;
    add_held(body, other, 2, 2 * kBetweenPieces);
    body = joined(std::move(body), back, kBetweenPieces);
  }
  return body;
}

}  // namespace armjig::campaign
