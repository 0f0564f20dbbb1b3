// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/survey.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "emulators/campaign/tour.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

/// Lines that come no faster do not wait for a server that reads every 10 ms: a client that leaves
/// meanwhile may or may not have its answers.
constexpr Duration kTick = 12ms;

/// Whether the names are the same but for a number, as of `speed.j1` and `speed.j2`.
bool are_of_a_row(const Field& one, const Field& other) {
  const auto without_number = [](std::string_view name) {
    return name.substr(0, name.find_last_not_of("0123456789") + 1);
  };
  return without_number(one.name) == without_number(other.name);
}

/// Those that take little time, the shortest first, and the others.
std::pair<std::vector<Script>, std::vector<Script>> parted(std::vector<Script> scripts) {
  constexpr Duration kLittle = 500ms;
  std::ranges::stable_sort(scripts, {}, length_of);
  const auto others = std::ranges::upper_bound(scripts, kLittle, {}, length_of);
  std::vector<Script> long_ones{others, scripts.end()};
  scripts.erase(others, scripts.end());
  return {std::move(scripts), std::move(long_ones)};
}

}  // namespace

Survey::Survey(const Material& material, std::uint64_t seed)
    : material_{material}, repertoire_{material, seed}, exercises_{material, repertoire_} {
  plan();
}

void Survey::put_last(const std::function<bool(const Script& script)>& is_one) {
  std::ranges::stable_partition(cases_, [&](const Case& one) { return !is_one(one.script()); });
}

Script Survey::questions() const {
  Script questions;
  for (const auto address : material_.addresses) repertoire_.look_at_all(questions, address);
  if (material_.permit) material_.permit(questions);
  return questions;
}

void Survey::plan() {
  const auto [short_ones, long_ones] = parted(material_.written);
  plan_all(nowhere_, short_ones);
  const auto of_all = [this](std::size_t state, std::initializer_list<Exercise> exercises) {
    for (const auto exercise : exercises) {
      for (const auto& kind : repertoire_.kinds()) {
        if (state < kind.size()) plan(kind[state], exercise);
      }
    }
  };
  const auto of_first = [this](std::initializer_list<Exercise> exercises) {
    if (repertoire_.kinds().empty()) return;
    for (const auto exercise : exercises) plan(repertoire_.kinds().front().front(), exercise);
  };
  const auto of_one = [this](Exercise exercise) {
    for (const auto& kind : repertoire_.kinds()) {
      if (plan(kind.front(), exercise)) return;
    }
  };
  of_all(0, {&Exercises::some_copies, &Exercises::spoiled_copies});
  of_first({&Exercises::sequences, &Exercises::bursts, &Exercises::after_runs, &Exercises::padded,
            &Exercises::odd_ends, &Exercises::marked, &Exercises::in_one_segment});
  of_one(&Exercises::odd_numbers);
  of_first(
      {&Exercises::blanks, &Exercises::cut_across, &Exercises::half_lines, &Exercises::misspelt});
  of_all(0,
         {&Exercises::all_fields, &Exercises::variants, &Exercises::reads_again, &Exercises::sums});
  if (material_.kind == LinkKind::kSession) {
    of_all(0, {&Exercises::held_codes});
  } else {
    of_one(&Exercises::held_codes);
  }
  of_one(&Exercises::false_lengths);
  of_first({&Exercises::all_codes, &Exercises::two_codes});
  if (!repertoire_.kinds().empty()) {
    plan_all(repertoire_.kinds().front().front(), exercises_.told_sequences());
  }
  of_all(0, {&Exercises::watched_pairs});
  const auto many_at_once = cases_.size();
  for (const auto& one : long_ones) {
    cases_.push_back({[this, one] { return whole(nowhere_, one); }});
  }
  of_all(0, {&Exercises::watched_lengths, &Exercises::pairs, &Exercises::half_lines,
             &Exercises::mixed_pairs, &Exercises::cut_copies, &Exercises::sweep});
  const auto idle_ones = plan_values(0, &Exercises::values);
  of_all(0, {&Exercises::lengths, &Exercises::odd_bytes});
  for (const auto& one : repertoire_.looks()) {
    cases_.push_back({[this, &one] { return whole(nowhere_, many_copies_of(one)); }});
  }
  const auto watched_idle_ones = plan_values(0, &Exercises::watched_values);
  of_first({&Exercises::long_gap});
  const auto other_idle_ones = plan_values(1, &Exercises::values);
  of_all(1, {&Exercises::some_copies, &Exercises::pairs});
  of_all(0, {&Exercises::sizes, &Exercises::many_copies, &Exercises::long_gap});
  put_short_ones_first(many_at_once);
  auto tours = tour_cases();
  cases_.insert(cases_.begin() + static_cast<std::ptrdiff_t>(many_at_once),
                std::make_move_iterator(tours.begin()), std::make_move_iterator(tours.end()));
  const auto idle = cases_.size();
  for (const auto* const late : {&idle_ones, &other_idle_ones, &watched_idle_ones}) {
    cases_.insert(cases_.end(), late->begin(), late->end());
  }
  put_short_ones_first(idle);
}

/// Single messages in each state, then in the middle of what they began; and more of what is
/// answered otherwise in a state that takes time to come to.
std::vector<Survey::Case> Survey::tour_cases() {
  std::vector<Case> cases;
  Tour tour{material_, repertoire_};
  const auto add_parts = [&] {
    const auto longest = material_.longest_tour;
    for (auto part = tour.next(longest); !part.empty(); part = tour.next(longest)) {
      cases.push_back({[part] { return part; }});
    }
  };
  add_parts();
  seldom_ = tour.where_seldom_answered();
  tour.go_deeper();
  add_parts();
  for (const auto exercise : {&Exercises::odd_numbers, &Exercises::some_copies, &Exercises::pairs,
                              &Exercises::all_fields}) {
    for (const auto& setting : seldom_) {
      if (auto one = case_of(setting, exercise)) cases.push_back(*std::move(one));
    }
  }
  return cases;
}

/// As many of them in each case as it has time for.
void Survey::plan_all(const Setting& setting, const std::vector<Script>& bodies) {
  Script part;
  const auto add_part = [&] {
    if (!part.empty()) cases_.push_back({[this, &setting, part] { return whole(setting, part); }});
    part.clear();
  };
  for (const auto& body : bodies) {
    const auto length = length_of(setting.before) + length_of(part) + length_of(body) + 4 * kStep;
    if (length > material_.longest) add_part();
    part = part.empty() ? body : joined(part, body, kStep);
  }
  add_part();
}

/// From that place on: in the time of a long one several short ones tell more, but for messages of
/// many fields, of which more can be wrong.
void Survey::put_short_ones_first(std::size_t begin) {
  constexpr std::array<Duration, 4> kClasses{500ms, 1000ms, 2000ms, 4000ms};
  constexpr std::size_t kManyFields = 4;
  auto fewest = std::numeric_limits<std::size_t>::max();
  for (const auto& kind : repertoire_.kinds()) {
    fewest = std::min(fewest, kind.front().message.fields.size());
  }
  std::vector<std::pair<std::ptrdiff_t, Case>> ranked;
  for (auto i = begin; i < cases_.size(); ++i) {
    const auto more = cases_[i].fields - std::min(cases_[i].fields, fewest);
    const auto length = length_of(cases_[i].script()) * kManyFields / (kManyFields + more);
    const auto place = std::ranges::lower_bound(kClasses, length);
    ranked.emplace_back(place - kClasses.begin(), std::move(cases_[i]));
  }
  std::ranges::stable_sort(ranked, {}, [](const auto& one) { return one.first; });
  for (auto& [rank, one] : ranked) cases_[begin++] = std::move(one);
}

/// False: there is nothing of the kind on this link, or that the guard lets pass.
bool Survey::plan(const Setting& setting, Exercise exercise) {
  auto one = case_of(setting, exercise);
  if (!one) return false;
  cases_.push_back(*std::move(one));
  return true;
}

std::optional<Survey::Case> Survey::case_of(const Setting& setting, Exercise exercise) const {
  auto body = (exercises_.*exercise)(setting);
  if (material_.permit) material_.permit(body);
  if (body.empty()) return std::nullopt;
  return Case{
      [this, &setting, exercise] { return whole(setting, (exercises_.*exercise)(setting)); },
      setting.message.fields.size()};
}

/// `of_field` of a field of each kind, then of another of each. Those that change nothing are for
/// later, and so are further ones of a row, as `speed.j2`.
std::vector<Survey::Case> Survey::plan_values(std::size_t state, OfField of_field) {
  std::vector<Case> idle_ones;
  bool is_one_left = true;
  for (std::size_t number = 0; std::exchange(is_one_left, false); ++number) {
    for (const auto& kind : repertoire_.kinds()) {
      if (state >= kind.size() || number >= kind[state].message.fields.size()) continue;
      is_one_left = true;
      const auto& setting = kind[state];
      const auto& field = setting.message.fields[number];
      // The code of one message makes another of it: once is enough.
      if (&field == code_in(setting.message) && &kind != &repertoire_.kinds().front()) continue;
      if (!exercises_.can_choose(setting, field)) continue;
      auto body = (exercises_.*of_field)(setting, field);
      if (material_.permit) material_.permit(body);
      if (body.empty()) continue;
      auto& cases = matters_first(setting, field) ? cases_ : idle_ones;
      cases.push_back({[this, &setting, &field, of_field] {
                         return whole(setting, (exercises_.*of_field)(setting, field));
                       },
                       setting.message.fields.size()});
    }
  }
  return idle_ones;
}

/// Whether a sound device says something else after another number. Where nobody knows, each does.
bool Survey::matters(const Setting& setting, const Field& field) {
  if (!repertoire_.is_rehearsed() || field.place == Place::kPiece) return true;
  const auto [known, is_new] = matter_.try_emplace({&setting, &field});
  if (!is_new) return known->second;
  const auto as_it_is = repertoire_.said_after(setting, setting.exchange);
  const auto top = std::int64_t{1} << (8U * field.width - 1U);
  const std::array numbers{std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, top - 1, -top};
  known->second = std::ranges::any_of(numbers, [&](std::int64_t number) {
    return repertoire_.said_after(setting, with_number(material_, setting, {&field, 1}, number)) !=
           as_it_is;
  });
  return known->second;
}

/// And none of the same row does before it.
bool Survey::matters_first(const Setting& setting, const Field& field) {
  const auto does_too = [&](const Field& before) {
    return &before < &field && are_of_a_row(before, field) && matters(setting, before);
  };
  return matters(setting, field) && std::ranges::none_of(setting.message.fields, does_too);
}

Script Survey::whole(const Setting& setting, const Script& body) const {
  auto script = joined(setting.before, body, setting.rest);
  const bool is_led_there = setting.rest > kStep;
  const auto longest =
      material_.longest + (is_led_there ? length_of(setting.before) + setting.rest : Duration{});
  if (!body.empty()) repertoire_.look_at_all(script, body.back().id);
  if (material_.kind == LinkKind::kSession) script = spaced(std::move(script), {.least = kTick});
  script = spaced(std::move(script), material_.spacing);
  std::erase_if(script, [&](const KeptRecord& one) { return one.time > Instant{longest}; });
  if (material_.permit) material_.permit(script);
  return script;
}

}  // namespace armjig::campaign
