// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/symptom.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <memory>
#include <ranges>
#include <set>
#include <span>
#include <utility>

#include "emulators/campaign/talk.hpp"
#include "harness/compare/likeness.hpp"
#include "harness/compare/recording_diff.hpp"
#include "harness/wire/brief.hpp"

namespace armjig::campaign {
namespace {

std::string key_of(std::string_view asked, std::string_view answer, std::string_view part) {
  return fmt::format("{}\n{}\n{}", asked, answer, part);
}

/// What was done last before that moment.
std::string asked_before(const Script& script, Instant time, MakeDissector make_dissector) {
  const KeptRecord* last = nullptr;
  for (const auto& record : script) {
    if (record.time > time) break;
    if (record.kind != LinkKind::kBus || is_sent(record) || last == nullptr) last = &record;
  }
  return last == nullptr ? "the beginning" : words_of(*last, make_dissector);
}

std::string name_of(const RecordedMessage& one) {
  if (!one.message.fault.empty()) return "noise";
  if (one.message.name == "events") return "connection";
  return std::string{one.message.name};
}

/// What the difference is about: names of fields, or what became of the message.
std::vector<std::string> parts_of(const RecordingDifference& difference) {
  if (difference.change != Change::kChanged) return {std::string{to_string(difference.change)}};
  std::vector<std::string> parts;
  for (const auto& what : difference.what) parts.push_back(what.substr(0, what.find(':')));
  return parts;
}

/// The halves of `NAME: BEFORE, AFTER` sentences, as far as they are about these parts.
std::string side_of(const RecordedMessage* message) {
  if (message == nullptr) return "nothing";
  constexpr std::size_t kEnough = 240;
  auto line = message->message.name == "events" ? message->note : to_line(message->message);
  if (!message->note.empty() && message->message.name != "events") line += " " + message->note;
  if (line.size() > kEnough) line = line.substr(0, kEnough) + "...";
  return line;
}

/// In what both differ, as sentences of the comparison have it.
std::pair<std::string, std::string> sides_of(const RecordingDifference& difference,
                                             const std::vector<std::string>& parts) {
  if (difference.change != Change::kChanged) {
    return {side_of(difference.before), side_of(difference.after)};
  }
  std::string expected;
  std::string actual;
  for (const auto& what : difference.what) {
    const auto colon = what.find(": ");
    const auto comma = what.rfind(", ");
    if (colon == what.npos || comma == what.npos || comma < colon) continue;
    const auto name = what.substr(0, colon);
    if (std::ranges::find(parts, name) == parts.end()) continue;
    const auto blank = expected.empty() ? "" : "; ";
    expected += fmt::format("{}{} {}", blank, name, what.substr(colon + 2, comma - colon - 2));
    actual += fmt::format("{}{} {}", blank, name, what.substr(comma + 2));
  }
  return {expected, actual};
}

class Judge {
 public:
  /// `found`: what differs, so that it says nothing of which message is which.
  Judge(const Script& script, const Judging& judging, const Excuses& excuses, const Excuses& found)
      : script_{script}, judging_{judging}, excuses_{excuses}, aligning_{judging.rules} {
    std::ranges::copy(found.fields(), std::back_inserter(aligning_.fields));
  }

  [[nodiscard]] std::optional<Symptom> of_end(const BothHeard& heard) const {
    const auto has_ended = [](const Heard& model) { return model.end.has_value(); };
    if (std::ranges::any_of(heard.models, has_ended)) return std::nullopt;
    const auto last = script_.empty() ? Instant{} : script_.back().time;
    const auto why = std::string{describe(heard.target.end->code)};
    return excused({.asked = "the case",
                    .answer = "the end of the link",
                    .parts = {why},
                    .expected = "an answer",
                    .actual = why,
                    .time = last});
  }

  /// The first that differs from all models.
  [[nodiscard]] std::optional<Symptom> first_difference(const BothHeard& heard) const {
    std::optional<Symptom> first;
    each_difference(heard, [&](const Difference& one) {
      first = one.symptom;
      std::tie(first->expected, first->actual) = sides_of(one.difference, first->parts);
      return false;
    });
    return first;
  }

  [[nodiscard]] std::set<std::string> ways(const BothHeard& heard) const {
    std::set<std::string> all;
    const auto done = all_done();
    each_difference(heard, [&](Difference one) {
      // It may have been any of what was done before: an answer can come late.
      for (const auto& [time, words] : done) {
        if (time > one.symptom.time) break;
        one.symptom.asked = words;
        for (auto& way : one.symptom.ways()) all.insert(std::move(way));
      }
      return true;
    });
    return all;
  }

 private:
  /// Where nobody knows exactly when the target got something: apart from what is no news, the
  /// model comes past that.
  [[nodiscard]] bool is_only_early_or_late(const RecordingDifference& difference,
                                           const Symptom& symptom,
                                           const RecordedMessages& model) const {
    if (judging_.rules.time_tolerance == Duration{}) return false;
    auto rules = judging_.rules;
    for (auto& part : parts_of(difference)) {
      if (std::ranges::find(symptom.parts, part) != symptom.parts.end()) continue;
      rules.fields.push_back(
          {.message = symptom.answer, .name = std::move(part), .is_ignored = true});
    }
    return Likeness{rules}.is_come_past_by(*difference.after, model.lanes().at(difference.lane));
  }

  /// Whether a message without a counterpart is one of as many as there should be, where models say
  /// this and that, and the other side comes past it. Of numbers that change one in this tick and
  /// one in the next no model has all at once, so that nobody can tell which message is which.
  [[nodiscard]] bool is_only_out_of_step(const RecordingDifference& difference,
                                         const std::vector<RecordedMessages>& models,
                                         const RecordedMessages& target) const {
    const bool is_missing = difference.after == nullptr;
    const bool is_extra = difference.before == nullptr;
    if (is_missing == is_extra || judging_.rules.time_tolerance == Duration{}) return false;
    const auto& message = is_missing ? *difference.before : *difference.after;
    const auto alike_in = [&](const RecordedMessages& some) {
      return all_named(message.message.name, message.message.fault, difference.lane, some);
    };
    const auto said = alike_in(target);
    std::vector<MessagesInOrder> expected;
    for (const auto& model : models) expected.push_back(alike_in(model));
    const auto [fewest, most] = std::ranges::minmax(expected, {}, &MessagesInOrder::size);
    if (said.size() < fewest.size() || said.size() > most.size()) return false;
    const auto& own = is_missing ? expected.front() : said;
    if (agree_on(std::ranges::find(own, &message) - own.begin(), expected)) return false;
    return is_missing ? comes_past(message, said)
                      : std::ranges::any_of(expected, [&](const MessagesInOrder& model) {
                          return comes_past(message, model);
                        });
  }

  [[nodiscard]] bool comes_past(const RecordedMessage& message,
                                const MessagesInOrder& others) const {
    const auto itself = [](const auto* one) -> const RecordedMessage& { return *one; };
    return Likeness{judging_.rules}.is_come_past_by(message, std::views::transform(others, itself));
  }

  /// Whether all say as much and, in that place, the same.
  [[nodiscard]] bool agree_on(std::ptrdiff_t place, const std::vector<MessagesInOrder>& all) const {
    const auto at = static_cast<std::size_t>(place);
    return std::ranges::all_of(all, [&](const MessagesInOrder& said) {
      return at < said.size() && at < all.front().size() &&
             Likeness{judging_.rules}.has_same_content(*all.front()[at], *said[at]);
    });
  }

  [[nodiscard]] std::vector<std::pair<Instant, std::string>> all_done() const {
    std::vector<std::pair<Instant, std::string>> all{{Instant::min(), "the beginning"}};
    for (const auto& record : script_) {
      auto words = words_of(record, judging_.make_dissector);
      if (words != all.back().second) all.emplace_back(record.time, std::move(words));
    }
    return all;
  }

  struct Difference {
    Symptom symptom;
    RecordingDifference difference;
    bool is_timing{};       ///< a model comes past what the target says, a little earlier or later
    bool is_agreed = true;  ///< all models say the same there, so that it is no matter of time
  };

  /// What no model explains, in order of time, as long as `goes_on(difference)` says so. Each
  /// moment of a live target may have been as any model had it, whichever had the moment before:
  /// what came close together came in one tick here and in two there. So it is asked of each
  /// message, not of all of them together, whether a model says the same.
  template <class GoesOn>
  void each_difference(const BothHeard& heard, GoesOn goes_on) const {
    const auto target = messages_of(heard.target.said, judging_.make_dissector);
    std::vector<RecordedMessages> models;
    for (const auto& model : heard.models) {
      models.push_back(messages_of(model.said, judging_.make_dissector));
    }
    if (models.empty()) return;
    auto common = differences(models.front(), target);
    for (const auto& model : std::span{models}.subspan(1)) {
      if (common.empty()) break;
      const auto found = differences(model, target);
      std::erase_if(common, [&](Difference& one) { return !is_among(one, found, models.front()); });
    }
    std::ranges::move(differences_of_beats(models, target), std::back_inserter(common));
    std::ranges::move(differences_of_intervals(models, target), std::back_inserter(common));
    std::ranges::stable_sort(common, {}, [](const auto& one) { return one.symptom.time; });
    for (auto& one : common) {
      if (one.is_timing && !(one.is_agreed && heard.models.size() > 1)) continue;
      if (is_only_out_of_step(one.difference, models, target)) continue;
      if (!goes_on(std::move(one))) return;
    }
  }

  [[nodiscard]] std::vector<Difference> differences(const RecordedMessages& model,
                                                    const RecordedMessages& target) const {
    std::vector<Difference> all;
    const auto end = script_.empty() ? Instant{} : script_.back().time;
    for (auto& difference : diff(model, target, judging_.rules, aligning_)) {
      const bool is_one_sided = difference.change != Change::kChanged;
      if (is_one_sided && difference.time() > end + judging_.horizon) continue;
      auto symptom = symptom_at(difference);
      if (!symptom) continue;
      const bool is_timing = !is_one_sided && is_only_early_or_late(difference, *symptom, model);
      all.push_back({*std::move(symptom), std::move(difference), is_timing, !is_one_sided});
    }
    return all;
  }

  /// Where nobody knows to the microsecond when something came, the rules may let intervals pass.
  [[nodiscard]] std::vector<Difference> differences_of_intervals(
      const std::vector<RecordedMessages>& models, const RecordedMessages& target) const {
    std::vector<Difference> all;
    if (!judging_.told_interval || judging_.rules.time_tolerance == Duration{}) return all;
    for (auto& difference : false_intervals(*judging_.told_interval, models, target)) {
      auto symptom = symptom_at(difference);
      if (symptom) all.push_back({*std::move(symptom), std::move(difference), false, true});
    }
    return all;
  }

  /// When something was done or said, but for what rules ignore.
  [[nodiscard]] std::set<Instant> times_of_news(const std::vector<RecordedMessages>& models,
                                                const RecordedMessages& target) const {
    std::set<Instant> times;
    for (const auto& record : script_) times.insert(record.time);
    const auto add_all = [&](const RecordedMessages& said) {
      for (const auto& [lane, messages] : said.lanes()) {
        for (const auto& one : messages) {
          if (!judging_.rules.ignores(one.message.name)) times.insert(one.message.time);
        }
      }
    };
    std::ranges::for_each(models, add_all);
    add_all(target);
    return times;
  }

  /// What rules ignore since only the device knows when it is due. Whenever that is: as long as
  /// nothing is done or said, it says the same.
  [[nodiscard]] std::vector<Difference> differences_of_beats(
      const std::vector<RecordedMessages>& models, const RecordedMessages& target) const {
    std::vector<Difference> all;
    if (judging_.rules.ignored_messages.empty()) return all;
    const ComparisonRules whenever{.time_tolerance = Duration::max() / 2};
    const auto news = times_of_news(models, target);
    for (const auto& [lane, messages] : target.lanes()) {
      for (const auto& beat : messages) {
        if (!judging_.rules.ignores(beat.message.name)) continue;
        const auto* const expected = beat_agreed_on(models, lane, beat, news);
        if (expected == nullptr || expected->message.raw == beat.message.raw) continue;
        RecordingDifference difference{Change::kChanged, lane, expected, &beat};
        difference.what = Likeness{whenever}.differences(*expected, beat);
        auto symptom = symptom_at(difference);
        if (symptom) all.push_back({*std::move(symptom), std::move(difference), false, true});
      }
    }
    return all;
  }

  /// What all models say there, if nothing happens between that and `beat`; nullptr: they do not.
  [[nodiscard]] const RecordedMessage* beat_agreed_on(const std::vector<RecordedMessages>& models,
                                                      const std::string& lane,
                                                      const RecordedMessage& beat,
                                                      const std::set<Instant>& news) const {
    const RecordedMessage* agreed = nullptr;
    for (const auto& model : models) {
      const auto said = model.lanes().find(lane);
      if (said == model.lanes().end()) return nullptr;
      const auto speaks_for_it = [&](const RecordedMessage& one) {
        if (one.message.name != beat.message.name) return false;
        const auto [begin, end] = std::minmax(one.message.time, beat.message.time);
        const auto next = news.lower_bound(begin - judging_.rules.time_tolerance);
        return next == news.end() || *next > end + judging_.rules.time_tolerance;
      };
      const auto found = std::ranges::find_if(said->second, speaks_for_it);
      if (found == said->second.end()) return nullptr;
      if (agreed != nullptr && agreed->message.raw != found->message.raw) return nullptr;
      if (agreed == nullptr) agreed = &*found;
    }
    return agreed;
  }

  /// None: it is excused.
  [[nodiscard]] std::optional<Symptom> symptom_at(const RecordingDifference& difference) const {
    const auto& message = difference.before != nullptr ? *difference.before : *difference.after;
    return excused({.asked = asked_before(script_, difference.time(), judging_.make_dissector),
                    .answer = name_of(message),
                    .parts = parts_of(difference),
                    .expected = {},
                    .actual = {},
                    .time = difference.time()});
  }

  /// Whether another model differs there, too: from the same message of the target, or by one of
  /// the same kind that the target lacks. Only what is wrong by both stays wrong. `model` is what
  /// `one` was found beside.
  [[nodiscard]] bool is_among(Difference& one, const std::vector<Difference>& others,
                              const RecordedMessages& model) const {
    const auto other = std::ranges::find_if(others, [&](const Difference& some) {
      if (one.difference.after != some.difference.after) return false;
      if (one.difference.after != nullptr) return true;
      return one.difference.lane == some.difference.lane &&
             one.symptom.answer == some.symptom.answer && is_one_place(one, some, model);
    });
    if (other == others.end()) return false;
    std::vector<std::string> both;
    std::ranges::copy_if(one.symptom.parts, std::back_inserter(both), [&](const auto& part) {
      return std::ranges::find(other->symptom.parts, part) != other->symptom.parts.end();
    });
    if (!both.empty()) one.symptom.parts = std::move(both);
    one.is_timing = one.is_timing || other->is_timing;
    one.is_agreed = one.is_agreed && other->is_agreed &&
                    sides_of(one.difference, one.symptom.parts).first ==
                        sides_of(other->difference, one.symptom.parts).first;
    return true;
  }

  /// Of many on end that are alike, nobody can say which one is missing.
  [[nodiscard]] bool is_one_place(const Difference& one, const Difference& other,
                                  const RecordedMessages& model) const {
    const auto [begin, end] = std::minmax(one.symptom.time, other.symptom.time);
    if (end - begin <= 2 * judging_.rules.time_tolerance) return true;
    return std::ranges::all_of(model.lanes().at(one.difference.lane), [&](const auto& said) {
      const auto time = said.message.time;
      return time < begin || time > end || name_of(said) == one.symptom.answer;
    });
  }

  /// The symptom without what is no news; none if nothing is left.
  [[nodiscard]] std::optional<Symptom> excused(Symptom symptom) const {
    std::erase_if(symptom.parts, [&](const std::string& part) {
      return excuses_.has(symptom.asked, symptom.answer, part);
    });
    if (symptom.parts.empty()) return std::nullopt;
    return symptom;
  }

  const Script& script_;
  const Judging& judging_;
  const Excuses& excuses_;
  ComparisonRules aligning_;
};

/// `2 messages at once, the last command jog` without the first words.
std::string_view last_of(std::string_view asked) {
  constexpr std::string_view kLast = " at once, the last ";
  const auto place = asked.find(kLast);
  return place == asked.npos ? asked : asked.substr(place + kLast.size());
}

/// As opposed to what became of a whole message.
bool is_field(std::string_view part) {
  constexpr std::array<std::string_view, 7> kOthers{"missing", "extra", "moved", "time",
                                                    "note",    "rest",  "bytes"};
  return std::ranges::find(kOthers, part) == kOthers.end();
}

}  // namespace

std::string Symptom::key() const {
  return fmt::format("after {}: {}: {}", asked, answer, fmt::join(parts, ", "));
}

std::vector<std::string> Symptom::ways() const {
  std::vector<std::string> all;
  for (const auto& part : parts) {
    all.push_back(is_field(part) ? fmt::format("{}: {}", answer, part)
                                 : fmt::format("after {}: {}: {}", last_of(asked), answer, part));
  }
  return all;
}

void Excuses::add(std::string_view asked, std::string_view answer, std::string_view part) {
  keys_.insert(key_of(asked, answer, part));
  const auto is_it = [&](const auto& one) { return one.message == answer && one.name == part; };
  if (std::ranges::any_of(fields_, is_it)) return;
  fields_.push_back(
      {.message = std::string{answer}, .name = std::string{part}, .is_ignored = true});
}

bool Excuses::has(std::string_view asked, std::string_view answer, std::string_view part) const {
  return keys_.contains(key_of(asked, answer, part)) || keys_.contains(key_of({}, answer, part));
}

std::optional<Symptom> symptom_of(const Script& script, const BothHeard& heard,
                                  const Judging& judging, const Excuses& excuses) {
  const Judge judge{script, judging, excuses, excuses};
  if (heard.target.end) return judge.of_end(heard);
  return judge.first_difference(heard);
}

std::vector<std::string> all_ways(const Script& script, const BothHeard& heard,
                                  const Judging& judging, const Excuses& excuses,
                                  const Excuses& found) {
  const Judge judge{script, judging, excuses, found};
  if (heard.target.end) {
    const auto symptom = judge.of_end(heard);
    return symptom ? symptom->ways() : std::vector<std::string>{};
  }
  const auto ways = judge.ways(heard);
  return {ways.begin(), ways.end()};
}

}  // namespace armjig::campaign
