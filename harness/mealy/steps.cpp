// SPDX-License-Identifier: Apache-2.0
#include "harness/mealy/steps.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace armjig::mealy {
namespace {

using Letters = std::vector<std::string>;

bool leads_from_everywhere(const Machine& machine, std::size_t letter) {
  if (machine.states.size() < 3) return false;
  const auto& first = machine.states.front().steps[letter];
  return std::ranges::all_of(machine.states,
                             [&](const State& state) { return state.steps[letter] == first; });
}

std::string line_of(const Letters& letters, const std::string& said) {
  return fmt::format("{} / {}", fmt::join(letters, ", "), said_in_words(said));
}

}  // namespace

ToldMachine told(const Drawing& drawing) {
  const auto& machine = drawing.machine;
  const auto& marked = drawing.comparison.steps;
  ToldMachine told;
  told.notes.resize(machine.states.size());
  told.is_marked.resize(machine.states.size());
  for (std::size_t i = 0; i < drawing.comparison.documented.size(); ++i) {
    told.is_marked[i] = !drawing.comparison.documented[i];
  }
  std::map<std::pair<std::size_t, std::string>, Letters> from_everywhere;
  std::map<std::tuple<std::size_t, std::size_t, bool, std::string>, Letters> steps;
  for (std::size_t j = 0; j < machine.letters.size(); ++j) {
    if (leads_from_everywhere(machine, j)) {
      const auto& step = machine.states.front().steps[j];
      from_everywhere[{step.to, step.said}].push_back(machine.letters[j]);
      continue;
    }
    for (std::size_t i = 0; i < machine.states.size(); ++i) {
      const auto& step = machine.states[i].steps[j];
      const bool is_marked = marked.contains({i, static_cast<Letter>(j)});
      steps[{i, step.to, is_marked, step.said}].push_back(machine.letters[j]);
    }
  }
  for (const auto& [place, letters] : from_everywhere) {
    told.notes[place.first].push_back("from all: " + line_of(letters, place.second));
  }
  for (const auto& [place, letters] : steps) {
    const auto& [from, to, is_marked, said] = place;
    auto line = line_of(letters, said);
    if (from == to && !is_marked) {
      told.notes[from].push_back(std::move(line));
      continue;
    }
    const auto fits = [&](const Arrow& arrow) {
      return arrow.from == from && arrow.to == to && arrow.is_marked == is_marked;
    };
    auto arrow = std::ranges::find_if(told.arrows, fits);
    if (arrow == told.arrows.end()) {
      arrow = told.arrows.insert(arrow, {from, to, {}, is_marked});
    }
    arrow->lines.push_back(std::move(line));
  }
  return told;
}

}  // namespace armjig::mealy
