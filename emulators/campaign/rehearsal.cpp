// SPDX-License-Identifier: Apache-2.0
#include "emulators/campaign/rehearsal.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <string_view>
#include <utility>

#include "emulators/campaign/edit.hpp"
#include "emulators/campaign/talk.hpp"
#include "harness/compare/recording_diff.hpp"

namespace armjig::campaign {
namespace {

using namespace std::chrono_literals;

/// After that time a message has done what it does.
constexpr Duration kSettled = 500ms;

Script in_a_row(const std::vector<Script>& scripts) {
  Script all;
  for (const auto& script : scripts) all = joined(std::move(all), script, kStep);
  return all;
}

std::size_t bytes_that_differ(std::string_view one, std::string_view other) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i)
    count += one[i] != other[i] ? 1U : 0U;
  return count;
}

}  // namespace

void Rehearsal::begin_after(const std::vector<Script>& samples) {
  pasts_ = {in_a_row(samples), in_a_row({samples.rbegin(), samples.rend()})};
}

std::vector<KeptRecord> Rehearsal::heard(const Script& script) const {
  return is_possible() ? material_.rehearse(script) : std::vector<KeptRecord>{};
}

Rehearsal::Said Rehearsal::said_after(const Script& before, const Script& exchange,
                                      const Script& questions) const {
  Said all;
  for (const auto& past : pasts_) {
    auto script = joined(past, before, kStep);
    const auto asked_at = length_of(script) + kSettled;
    if (!exchange.empty()) script = joined(std::move(script), exchange, kStep);
    for (auto question : questions) {
      question.time += asked_at;
      script.push_back(std::move(question));
    }
    std::string said;
    for (const auto& record : heard(script)) {
      if (record.time < Instant{asked_at}) continue;
      for (const auto byte : record.bytes) said.push_back(static_cast<char>(byte));
    }
    all.push_back(std::move(said));
  }
  return all;
}

bool Rehearsal::goes_on_after(const Script& script, const Script& question) const {
  if (!is_possible() || !is_permitted(material_, script)) return false;
  return std::ranges::all_of(pasts_,
                             [&](const Script& past) { return goes_on(past, script, question); });
}

bool Rehearsal::goes_on(const Script& past, const Script& script, const Script& question) const {
  auto asked = joined(past, script, kStep);
  std::array<Instant, 4> begins;  // the last is asked so that all before it is heard
  for (auto& begin : begins) {
    const auto pause = &begin == begins.data() ? kSpeedUp : kWatched;
    begin = Instant{length_of(asked) + pause};
    asked = joined(std::move(asked), question, pause);
  }
  std::array<std::vector<KeptRecord>, begins.size() - 1> said;
  for (auto record : heard(asked)) {
    const auto next = std::ranges::upper_bound(begins, record.time);
    if (next == begins.begin() || next == begins.end()) continue;
    record.time = Instant{};
    said.at(static_cast<std::size_t>(next - begins.begin()) - 1).push_back(std::move(record));
  }
  const auto changes_after = [&](std::size_t i) {
    const auto before = messages_of(said.at(i), material_.make_dissector);
    const auto after = messages_of(said.at(i + 1), material_.make_dissector);
    const auto all = diff(before, after, material_.rules);
    return std::ranges::any_of(all, [](const auto& one) { return !one.what.empty(); });
  };
  return changes_after(0) && changes_after(1);
}

std::string Rehearsal::last_said(const Script& script) const {
  const Message* last = nullptr;
  const auto said = messages_of(heard(script), material_.make_dissector);
  for (const auto& [lane, messages] : said.lanes()) {
    for (const auto& one : messages) {
      if (last == nullptr || one.message.time >= last->time) last = &one.message;
    }
  }
  return last == nullptr ? std::string{} : std::string{last->name};
}

std::size_t difference_of(const Rehearsal::Said& some, const Rehearsal::Said& others) {
  auto fewest = std::numeric_limits<std::size_t>::max();
  for (std::size_t i = 0; i < std::min(some.size(), others.size()); ++i) {
    fewest = std::min(fewest, bytes_that_differ(some[i], others[i]));
  }
  return fewest;
}

}  // namespace armjig::campaign
