// SPDX-License-Identifier: Apache-2.0
// Which faults there are, how they are called, and what they change.
#include "emulators/kinovazed/defects/faults.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <utility>

#include "harness/core/nearest.hpp"

namespace armjig::kinovazed::emulation {
namespace {

using Flag = bool Behaviour::*;
constexpr std::array kFlags{Named<Flag>{"ignores-bad-lines", &Behaviour::ignores_bad_lines},
                            Named<Flag>{"accepts-before-event", &Behaviour::accepts_before_event},
                            Named<Flag>{"repeats-events", &Behaviour::repeats_events},
                            Named<Flag>{"beat-asks-supervision", &Behaviour::beat_asks_supervision},
                            Named<Flag>{"shares-objective", &Behaviour::shares_objective},
                            Named<Flag>{"sticks-when-folded", &Behaviour::sticks_when_folded},
                            Named<Flag>{"dies", &Behaviour::dies},
                            Named<Flag>{"dies-of-resets", &Behaviour::dies_of_resets}};

using namespace std::chrono_literals;
using Spoil = void (*)(Behaviour& behaviour);
constexpr std::array kFigures{
    Named<Spoil>{"beat-900-ms", [](Behaviour& b) { b.beat_period = 900ms; }},
    Named<Spoil>{"beat-1100-ms", [](Behaviour& b) { b.beat_period = 1100ms; }},
    Named<Spoil>{"beat-500-ms", [](Behaviour& b) { b.beat_period = 500ms; }},
    Named<Spoil>{"mode-settles-400-ms", [](Behaviour& b) { b.mode_settles = 400ms; }},
    Named<Spoil>{"mode-settles-700-ms", [](Behaviour& b) { b.mode_settles = 700ms; }},
    Named<Spoil>{"reach-500-mm", [](Behaviour& b) { b.reach.metres = 0.5F; }},
    Named<Spoil>{"reach-3-rad", [](Behaviour& b) { b.reach.radians = 3; }},
    Named<Spoil>{"stick-dead", [](Behaviour& b) { b.units_per_full = 0; }},
    Named<Spoil>{"stick-weak", [](Behaviour& b) { b.units_per_full /= 4; }},
    Named<Spoil>{"objectives-other", [](Behaviour& b) {
                   b.objective_count = b.objective_count == kDocumentedObjectives
                                           ? kObjectiveNames.size()
                                           : kDocumentedObjectives;
                 }}};

std::optional<std::uint8_t> bit_of(std::string_view text) noexcept {
  if (text.size() != 1 || text[0] < '0' || text[0] > '7') return std::nullopt;
  return static_cast<std::uint8_t>(text[0] - '0');
}

std::string line_of(std::string_view word) { return std::string{word} + "\r\n"; }

/// Calls `change` with the flags of each heartbeat.
template <class Change>
auto on_beats(Change change) {
  return [change](Saying& saying, QuirkMemory&, State) {
    const auto message = decode_message(saying.text.substr(0, saying.text.size() - 1));
    if (!message || !std::holds_alternative<Heartbeat>(*message)) return;
    auto beat = std::get<Heartbeat>(*message);
    beat.flags = change(beat.flags);
    saying.text = encode(beat).view();
  };
}

// Each reads what stands behind its word and the colon. False: there is no such thing.
struct Draft {
  ServerOptions& options;
  std::vector<Quirk>& quirks;
};
using Add = bool (*)(std::string_view text, const Draft& draft);

bool add_row(std::string_view text, const Draft& draft) {
  const auto state = find_word<State>(kStateNames, take_until(text, '.'));
  const auto verb = find_word<Verb>(kVerbNames, take_until(text, '.'));
  const auto next = find_word<State>(kStateNames, text);
  if (!state || !verb || !is_answered(*verb)) return false;
  if (!next && text != "rejected") return false;
  draft.options.machine
      .commands[static_cast<std::size_t>(*state)][static_cast<std::size_t>(*verb)] = next;
  return true;
}

bool add_end(std::string_view text, const Draft& draft) {
  const auto state = find_word<State>(kStateNames, take_until(text, '.'));
  bool is_known = false;
  for (auto& row : draft.options.machine.arm) {
    if (row.state != state) continue;
    is_known = true;
    if (text == "silent") row.reaction.said.reset();
    if (text == "ignored") row.reaction = {.next = row.state};
  }
  return is_known && (text == "silent" || text == "ignored");
}

using Say = void (*)(Saying& saying);
constexpr std::array kSayings{
    Named<Say>{"missing", [](Saying& saying) { saying.text.clear(); }},
    Named<Say>{"twice", [](Saying& saying) { saying.text += std::string{saying.text}; }},
    Named<Say>{"late", [](Saying& saying) { saying.delay += 700ms; }},
    Named<Say>{"misspelled", [](Saying& saying) {
                 saying.text[0] =
                     static_cast<char>(std::tolower(static_cast<unsigned char>(saying.text[0])));
               }}};

template <std::size_t index>
bool add_saying(std::string_view text, const Draft& draft) {
  if (!find_word<Event>(kEventNames, text)) return false;
  const auto change = kSayings[index].meaning;
  draft.quirks.push_back(
      {.say = [change, line = line_of(text)](Saying& saying, QuirkMemory&, State) {
        if (saying.text == line) change(saying);
      }});
  return true;
}

template <bool is_high>
bool add_bit(std::string_view text, const Draft& draft) {
  const auto bit = bit_of(text);
  if (!bit) return false;
  const auto mask = static_cast<std::uint8_t>(1U << *bit);
  draft.quirks.push_back({.say = on_beats([mask](std::uint8_t flags) {
                            return static_cast<std::uint8_t>(is_high ? flags | mask
                                                                     : flags & ~mask);
                          })});
  return true;
}

bool add_swapped_bits(std::string_view text, const Draft& draft) {
  const auto a = bit_of(take_until(text, '+'));
  const auto b = bit_of(text);
  if (!a || !b) return false;
  draft.quirks.push_back({.say = on_beats([a = *a, b = *b](std::uint8_t flags) {
                            const auto differs = ((flags >> a) ^ (flags >> b)) & 1U;
                            return static_cast<std::uint8_t>(flags ^ (differs << a) ^
                                                             (differs << b));
                          })});
  return true;
}

/// Where a word stands in a line: a verb in front, anything else behind a colon.
bool add_deaf(std::string_view text, const Draft& draft) {
  const bool is_verb = find_word<Verb>(kVerbNames, text).has_value();
  const bool is_argument =
      find_word<Mode>(kModeNames, text) || find_word<Objective>(kObjectiveNames, text);
  if (!is_verb && !is_argument) return false;
  const auto word = (is_verb ? "" : ":") + std::string{text};
  draft.quirks.push_back({.hear = [word, is_verb](std::string& segment, QuirkMemory&, State) {
    for (auto at = segment.find(word); at != std::string::npos; at = segment.find(word, at + 2)) {
      const auto behind = at + word.size();
      const bool begins = !is_verb || at == 0 || segment[at - 1] == '\n';
      const bool ends = behind == segment.size() || segment[behind] == '\r' ||
                        segment[behind] == '\n' || segment[behind] == ':';
      if (begins && ends) segment.insert(at + 1, "?");
    }
  }});
  return true;
}

bool add_first_point(std::string_view text, const Draft& draft) {
  const auto objective = find_word<Objective>(kObjectiveNames, text);
  auto paths = draft.options.objectives.paths();
  const auto path = std::ranges::find_if(
      paths, [&](const ObjectivePath& one) { return one.objective == objective; });
  if (!objective || path == paths.end() || path->points.size() < 2) return false;
  path->points.resize(1);
  draft.options.objectives = ObjectiveSet{std::move(paths)};
  return true;
}

bool add_behaviour(std::string_view text, const Draft& draft) {
  const auto* const found = find_named(kFlags, text);
  if (found == nullptr) return false;
  auto& flag = draft.options.behaviour.*found->meaning;
  flag = !flag;
  return true;
}

bool add_figure(std::string_view text, const Draft& draft) {
  const auto* const found = find_named(kFigures, text);
  if (found != nullptr) found->meaning(draft.options.behaviour);
  return found != nullptr;
}

template <auto all>
bool add_quirk(std::string_view text, const Draft& draft) {
  const auto found = std::ranges::find(all(), text, &Quirk::name);
  if (found == all().end()) return false;
  draft.quirks.push_back(*found);
  return true;
}

constexpr std::array kForms{
    Named<Add>{"row", add_row},
    Named<Add>{"end", add_end},
    Named<Add>{kSayings[0].name, add_saying<0>},
    Named<Add>{kSayings[1].name, add_saying<1>},
    Named<Add>{kSayings[2].name, add_saying<2>},
    Named<Add>{kSayings[3].name, add_saying<3>},
    Named<Add>{"bit-low", add_bit<false>},
    Named<Add>{"bit-high", add_bit<true>},
    Named<Add>{"swapped-bits", add_swapped_bits},
    Named<Add>{"deaf", add_deaf},
    Named<Add>{"first-point", add_first_point},
    Named<Add>{"behaviour", add_behaviour},
    Named<Add>{"figure", add_figure},
    Named<Add>{"quirk", add_quirk<&quirks>},
    Named<Add>{"rare", add_quirk<&rare_quirks>},
};

/// Where a verb leads in the states that accept it.
std::string_view elsewhere(std::size_t verb) {
  const auto& rows = shipped_machine().commands;
  const auto row =
      std::ranges::find_if(rows, [&](const auto& one) { return one[verb].has_value(); });
  return to_string(*(*row)[verb]);
}

/// Every cell of the table, wrong: what is accepted is refused, and what is refused leads to where
/// the verb leads elsewhere.
void list_rows(std::vector<NamedFault>& all) {
  for (std::size_t s = 0; s < kStateNames.size(); ++s) {
    for (std::size_t v = 0; v < kAnsweredVerbs; ++v) {
      const auto is_accepted = shipped_machine().commands[s][v].has_value();
      all.push_back({fmt::format("row:{}.{}.{}", kStateNames[s], kVerbNames[v],
                                 is_accepted ? "rejected" : elsewhere(v)),
                     "States"});
    }
  }
  for (const auto& row : shipped_machine().arm) {
    if (!row.reaction.said) continue;
    for (const auto* how : {"silent", "ignored"}) {
      const auto name = fmt::format("end:{}.{}", to_string(row.state), how);
      if (std::ranges::find(all, name, &NamedFault::name) == all.end()) {
        all.push_back({name, "Interrupts and ends"});
      }
    }
  }
}

void list_messages(std::vector<NamedFault>& all) {
  for (const auto& saying : kSayings) {
    for (const auto word : kEventNames) {
      all.push_back({fmt::format("{}:{}", saying.name, word), "Replies and events"});
    }
  }
  for (int bit = 0; bit < 8; ++bit) {
    all.push_back({fmt::format("bit-low:{}", bit), "Heartbeats"});
    all.push_back({fmt::format("bit-high:{}", bit), "Heartbeats"});
    if (bit > 0) all.push_back({fmt::format("swapped-bits:{}+{}", bit - 1, bit), "Heartbeats"});
  }
}

void list_words(std::vector<NamedFault>& all) {
  // A console command that is not known is as silent as one that is.
  for (const auto word : std::span{kVerbNames}.first<kAnsweredVerbs>()) {
    all.push_back({fmt::format("deaf:{}", word), "Lines"});
  }
  for (const auto word : kModeNames) all.push_back({fmt::format("deaf:{}", word), "Joystick"});
  for (const auto word : kObjectiveNames) {
    all.push_back({fmt::format("deaf:{}", word), "Objectives"});
  }
  const auto objectives = published_objectives();
  for (const auto& path : objectives.paths()) {
    if (path.points.size() < 2) continue;
    all.push_back({fmt::format("first-point:{}", to_string(path.objective)), "Objectives"});
  }
}

}  // namespace

Outcome<void> add_fault(std::string_view text, ServerOptions& options, std::vector<Quirk>& quirks) {
  auto rest = text;
  const auto* const form = find_named(kForms, take_until(rest, ':'));
  if (form != nullptr && form->meaning(rest, {options, quirks})) return {};
  return problem(ErrorCode::kBadValue, fmt::format("fault '{}'", text),
                 did_you_mean(text, all_faults(), &NamedFault::name) +
                     "'armjig conformance mutants kinovazed --list' shows all");
}

std::vector<NamedFault> all_faults() {
  std::vector<NamedFault> all;
  list_rows(all);
  list_messages(all);
  list_words(all);
  for (const auto& [name, flag] : kFlags)
    all.push_back({fmt::format("behaviour:{}", name), "Lines"});
  for (const auto& [name, figure] : kFigures) {
    all.push_back({fmt::format("figure:{}", name), "Times"});
  }
  for (const auto& quirk : quirks()) {
    all.push_back({fmt::format("quirk:{}", quirk.name), quirk.section});
  }
  return all;
}

}  // namespace armjig::kinovazed::emulation
