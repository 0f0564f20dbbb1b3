// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/tour.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "emulators/campaign/talk.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

/// Nothing that a device does by itself takes longer.
constexpr Duration kPatience = 30s;
/// What is said in so much time at the end is what the state says: a beat comes each second.
constexpr Duration kAtEnd = 1200ms;
/// After the last news; so that what is late does not come together with what is next.
constexpr Duration kAfterNews = 150ms;
/// In the middle of what goes on for longer than that. What goes on and on has more time.
constexpr Duration kInTheMiddle = 40ms;
constexpr Duration kGoesOn = 600ms;
/// The connection that all is said on.
constexpr std::uint32_t kClient = 0;

/// The names and times of what is said, but for what rules ignore.
std::multimap<Instant, std::string_view> news_in(const RecordedMessages& said,
                                                 const ComparisonRules& rules) {
  std::multimap<Instant, std::string_view> news;
  for (const auto& [lane, messages] : said.lanes()) {
    for (const auto& one : messages) {
      if (!rules.ignores(one.message.name)) news.emplace(one.message.time, one.message.name);
    }
  }
  return news;
}

}  // namespace

Tour::Tour(const Material& material, const Repertoire& repertoire) : material_{material} {
  constexpr std::size_t kMostForms = 4;
  if (material.kind != LinkKind::kSession || !material.rehearse) return;
  for (const auto& kind : repertoire.kinds()) {
    const auto& setting = kind.front();
    const auto first = deeds_.size();
    deeds_.push_back({&setting, to(kClient, setting.exchange), first});
    for (const auto& form : setting.variants) {
      if (deeds_.size() == first + kMostForms) break;
      if (form.front().bytes != setting.exchange.front().bytes)
        deeds_.push_back({&setting, to(kClient, form), first});
    }
  }
  Script other_client;
  add(other_client, border("disconnect", kClient, "client-close"));
  add(other_client, border("connect", kClient, "ok"));
  deeds_.push_back({nullptr, std::move(other_client), deeds_.size()});
}

/// As if all that it began were ended.
Tour::Stop Tour::stop_after(Script script) const {
  const auto done = Instant{length_of(script)};
  auto waited = script;
  add(waited, border("disconnect", kClient, "client-close"), kPatience);
  const auto end = Instant{length_of(waited)};
  const auto said = messages_of(material_.rehearse(waited), material_.make_dissector);
  const auto news = news_in(said, material_.rules);
  const auto last = news.empty() ? done : std::max(done, news.rbegin()->first);
  std::string reply;
  const auto later = news.upper_bound(done + kInTheMiddle);
  for (auto one = news.lower_bound(done); one != later; ++one) reply.append(one->second) += ' ';
  const auto state = state_told(said, end - kAtEnd);
  const auto settled_at = last > end - kAtEnd ? done + kGoesOn : last;
  return {std::move(script), state, state, settled_at, 0, std::move(reply)};
}

std::optional<Tour::Stop> Tour::stop_after(const Stop& stop, std::size_t deed) const {
  const bool is_in_the_middle = stop.depth > 0;
  const auto done = Instant{length_of(stop.script)};
  const auto begin = is_in_the_middle ? done + kInTheMiddle / 2 : stop.settled_at + kAfterNews;
  auto script = joined(stop.script, deeds_[deed].script, begin - done);
  script = spaced(std::move(script), material_.spacing);
  auto permitted = script;
  if (material_.permit_case) material_.permit_case(permitted);
  if (permitted.size() < script.size()) return std::nullopt;
  auto after = stop_after(std::move(script));
  if (after.settled_at < Instant{length_of(after.script)} + kInTheMiddle) return after;
  const auto later = after.settled_at - stop.settled_at;
  const bool is_same = is_in_the_middle && after.settled == stop.settled &&
                       std::max(later, -later) < kInTheMiddle / 2;
  after.depth = stop.depth + (is_same ? 0 : 1);
  after.state = is_same ? stop.state : stop.state * 1'000'003 + deed + 1;
  return after;
}

/// Where only beats tell the state.
void Tour::hear_a_beat(Stop& stop) const {
  if (material_.rules.ignored_messages.empty()) return;
  stop.settled_at = std::max(stop.settled_at, Instant{length_of(stop.script)}) + kAtEnd;
}

Tour::Stop Tour::waited(Stop stop) const {
  stop.state = stop.settled;
  stop.depth = 0;
  return stop;
}

/// That which took the shortest time where it was done before.
std::optional<std::size_t> Tour::untried_in(State state) const {
  const auto known = known_.find(state);
  std::optional<std::size_t> shortest;
  for (std::size_t deed = 0; deed < deeds_.size(); ++deed) {
    const bool is_enough = passing_.contains(state) && deeds_[deed].first_form != deed;
    if (is_enough || (known != known_.end() && known->second.contains(deed))) continue;
    if (!shortest || deeds_[deed].takes < deeds_[*shortest].takes) shortest = deed;
  }
  return shortest;
}

std::optional<Tour::Deeds> Tour::deeds_to(State from,
                                          const std::function<bool(State)>& is_it) const {
  constexpr int kOftenEnough = 4;
  std::set<State> seen{from};
  std::deque<std::pair<State, Deeds>> ways{{from, {}}};
  for (; !ways.empty(); ways.pop_front()) {
    const auto [state, deeds] = ways.front();
    if (is_it(state)) return deeds;
    const auto known = known_.find(state);
    if (known == known_.end()) continue;
    for (const auto& [deed, way] : known->second) {
      if (way.times > kOftenEnough) continue;
      for (const auto end : way.ends) {
        if (!seen.insert(end).second) continue;
        auto longer = deeds;
        longer.push_back(deed);
        ways.emplace_back(end, std::move(longer));
      }
    }
  }
  return std::nullopt;
}

std::optional<std::size_t> Tour::next_deed(State from) const {
  if (const auto untried = untried_in(from)) return untried;
  const auto deeds = deeds_to(from, [this](State state) { return untried_in(state).has_value(); });
  return deeds ? std::optional{deeds->front()} : std::nullopt;
}

/// Whether a form of a message does there what another form of it did.
bool Tour::is_like_another(const Stop& from, std::size_t deed, const Stop& after) {
  const auto takes = after.settled_at - Instant{length_of(after.script)};
  const auto [first, is_new] = seen_.try_emplace(
      {from.state, deeds_[deed].first_form, after.settled, takes / kInTheMiddle}, deed);
  return first->second != deed;
}

std::optional<Tour::Stop> Tour::way_to(State state) const {
  std::optional stop = beginning();
  const auto deeds = deeds_to(stop->state, [&](State one) { return one == state; });
  if (!deeds) return std::nullopt;
  for (const auto deed : *deeds) {
    stop = deed == waiting() ? waited(*std::move(stop)) : stop_after(*stop, deed);
    if (!stop) return std::nullopt;
    if (stop->depth > depth_) stop = waited(*std::move(stop));
  }
  return stop->state == state ? stop : std::nullopt;
}

std::vector<Setting> Tour::where_seldom_answered() const {
  std::vector<Setting> settings;
  for (const auto& [deed, answers] : answered_) {
    if (deeds_[deed].setting == nullptr) continue;
    const auto most =
        std::ranges::max_element(answers, {}, [](const auto& one) { return one.second.times; });
    for (const auto& [reply, answered] : answers) {
      if (reply == most->first) continue;
      const auto stop = way_to(answered.state);
      if (!stop) continue;
      auto& setting = settings.emplace_back(*deeds_[deed].setting);
      setting.exchange = deeds_[deed].script;
      setting.before = stop->script;
      setting.back = {};
      setting.rest = stop->settled_at + kAfterNews - Instant{length_of(stop->script)};
    }
  }
  return settings;
}

void Tour::go_deeper() {
  ++depth_;
  for (const auto& [state, deed] : std::exchange(passed_by_, {})) known_[state].erase(deed);
}

Tour::Stop Tour::beginning() const { return stop_after({border("connect", kClient, "ok")}); }

/// Where the tour goes on; none: where it was.
std::optional<Tour::Stop> Tour::noted(const Stop& before, std::size_t deed, Stop after) {
  auto& way = known_[before.state][deed];
  const bool is_first = ++way.times == 1 && way.ends.empty();
  if (is_like_another(before, deed, after)) return std::nullopt;
  if (is_first && before.depth == 0) {
    auto& answers = answered_[deeds_[deed].first_form];
    ++answers.try_emplace(after.reply, Answered{0, before.state}).first->second.times;
  }
  if (after.depth > depth_) {
    passed_by_.emplace(before.state, deed);
    after = waited(std::move(after));
  }
  if (after.depth > 0) {
    passing_.insert(after.state);
    known_[after.state][waiting()].ends.insert(after.settled);
  } else if (is_first && after.state != before.state) {
    hear_a_beat(after);
  }
  way.ends.insert(after.state);
  return after;
}

Script Tour::next(Duration longest) {
  if (deeds_.empty()) return {};
  for (auto& [state, ways] : known_) {
    for (auto& [deed, way] : ways) way.times = 0;
  }
  auto stop = beginning();
  bool has_news = false;
  while (const auto deed = next_deed(stop.state)) {
    if (*deed == waiting()) {
      stop = waited(std::move(stop));
      continue;
    }
    const bool is_new = !known_[stop.state].contains(*deed);
    auto after = stop_after(stop, *deed);
    if (after) deeds_[*deed].takes = after->settled_at - Instant{length_of(stop.script)};
    if (after && after->settled_at - stop.settled_at > longest / 2) after.reset();
    if (after && after->settled_at + kAfterNews > Instant{longest}) break;
    has_news = has_news || is_new;
    if (!after) {
      known_[stop.state].try_emplace(*deed);  // it cannot be done there
    } else if (auto next = noted(stop, *deed, *std::move(after))) {
      stop = *std::move(next);
    }
  }
  if (!has_news) return {};
  const auto rest = stop.settled_at + kAfterNews - Instant{length_of(stop.script)};
  add(stop.script, border("disconnect", kClient, "client-close"), rest);
  return std::move(stop.script);
}

}  // namespace armjig::campaign
