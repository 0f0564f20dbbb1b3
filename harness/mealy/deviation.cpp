// SPDX-License-Identifier: Apache-2.0
#include "harness/mealy/deviation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>

namespace armjig::mealy {
namespace {

/// Letters that the two states answer differently.
std::size_t unlike(const State& one, const State& other) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < one.steps.size(); ++i) {
    if (one.steps[i].said != other.steps[i].said) ++count;
  }
  return count;
}

class Comparing {
 public:
  Comparing(const Machine& learned, const Machine& documented)
      : learned_{learned}, documented_{documented} {}

  Comparison compare() {
    const auto shortest = difference(learned_, 0, documented_, 0);
    comparison_.documented.resize(learned_.states.size());
    if (!shortest) {
      name_alike();
      return std::move(comparison_);
    }
    name_by_likeness();
    for (std::size_t i = 0; i < learned_.states.size(); ++i) compare_steps(i);
    for (std::size_t i = 0; i < learned_.states.size(); ++i) {
      if (!comparison_.documented[i]) add_unwritten(i);
    }
    add_unseen();
    if (comparison_.deviations.empty()) add_shortest(*shortest);
    return std::move(comparison_);
  }

 private:
  /// Both are equal: each state is the one that its word leads to.
  void name_alike() {
    for (std::size_t i = 0; i < learned_.states.size(); ++i) {
      comparison_.documented[i] = documented_.state_after(learned_.states[i].access);
    }
  }

  /// How much two states differ; a letter weighs as much as all letters after one.
  [[nodiscard]] std::size_t distance(std::size_t learned, std::size_t documented) const {
    const auto& one = learned_.states[learned];
    const auto& other = documented_.states[documented];
    auto sum = unlike(one, other) * one.steps.size();
    for (std::size_t i = 0; i < one.steps.size(); ++i) {
      sum += unlike(learned_.states[one.steps[i].to], documented_.states[other.steps[i].to]);
    }
    return sum;
  }

  void name_by_likeness() {
    struct Likeness {
      std::size_t distance;
      std::size_t learned;
      std::size_t documented;
    };
    std::vector<Likeness> all;
    for (std::size_t i = 0; i < learned_.states.size(); ++i) {
      const auto expected = documented_.state_after(learned_.states[i].access);
      for (std::size_t j = 0; j < documented_.states.size(); ++j) {
        if (2 * unlike(learned_.states[i], documented_.states[j]) > learned_.letters.size())
          continue;
        // A state is rather the one that its word leads to, by as much as two letters weigh.
        const auto astray = j == expected ? 0 : 2 * learned_.letters.size();
        all.push_back({distance(i, j) + astray, i, j});
      }
    }
    std::ranges::sort(all, {}, [](const Likeness& one) {
      return std::tuple{one.distance, one.learned, one.documented};
    });
    std::vector<bool> is_taken(documented_.states.size());
    comparison_.documented[0] = 0;  // both begin there
    is_taken[0] = true;
    for (const auto& one : all) {
      if (comparison_.documented[one.learned] || is_taken[one.documented]) continue;
      comparison_.documented[one.learned] = one.documented;
      is_taken[one.documented] = true;
    }
  }

  [[nodiscard]] std::string name_of(std::size_t learned) const {
    const auto& known = comparison_.documented[learned];
    return known ? documented_.states[*known].name : learned_.states[learned].name;
  }

  void add_unwritten(std::size_t state) {
    const auto& access = learned_.states[state].access;
    const auto& expected = documented_.states[documented_.state_after(access)];
    const auto& name = learned_.states[state].name;
    comparison_.deviations.push_back(
        {.name = name,
         .sentence = fmt::format("{} leads to {}, a state that nobody wrote down",
                                 learned_.words_of(access), name),
         .documented = expected.name,
         .learned = name,
         .shown_by = access});
  }

  void compare_steps(std::size_t state) {
    const auto known = comparison_.documented[state];
    if (!known) return;
    for (std::size_t i = 0; i < learned_.letters.size(); ++i) {
      const auto& is = learned_.states[state].steps[i];
      const auto& should = documented_.states[*known].steps[i];
      const auto& there = comparison_.documented[is.to];
      const bool leads_there = there && are_alike(*there, should.to);
      if (is.said == should.said && leads_there) continue;
      const auto letter = static_cast<Letter>(i);
      comparison_.steps.emplace(state, letter);
      comparison_.deviations.push_back(
          {.name = fmt::format("{}.{}", name_of(state), learned_.letters[i]),
           .sentence = fmt::format("in {}, {} is answered with {} and leads to {}", name_of(state),
                                   learned_.letters[i], said_in_words(is.said), name_of(is.to)),
           .documented = fmt::format("{} and {}", said_in_words(should.said),
                                     documented_.states[should.to].name),
           .learned = fmt::format("{} and {}", said_in_words(is.said), name_of(is.to)),
           .shown_by = shown_by(state, letter, *known)});
    }
  }

  /// A word whose last letter both answer differently, if the step leads to one.
  [[nodiscard]] Word shown_by(std::size_t state, Letter letter, std::size_t known) const {
    auto word = joined(learned_.states[state].access, {letter});
    const auto& is = learned_.states[state].steps[letter];
    const auto& should = documented_.states[known].steps[letter];
    if (is.said != should.said) return word;
    const auto rest = difference(learned_, is.to, documented_, should.to);
    return rest ? joined(std::move(word), *rest) : word;
  }

  /// A document may have two names for what answers alike.
  [[nodiscard]] bool are_alike(std::size_t one, std::size_t other) const {
    return one == other || !difference(documented_, one, documented_, other);
  }

  /// Documented states that no learned one is, nor one that answers alike.
  void add_unseen() {
    const auto is_met = [this](std::size_t documented) {
      return std::ranges::any_of(comparison_.documented, [&](const auto& known) {
        return known && are_alike(*known, documented);
      });
    };
    const State* first = nullptr;
    std::string names;
    for (std::size_t i = 0; i < documented_.states.size(); ++i) {
      if (is_met(i)) continue;
      const auto& state = documented_.states[i];
      if (first == nullptr) first = &state;
      names += fmt::format("{}{}", names.empty() ? "" : "; ", state.name);
    }
    if (first == nullptr) return;
    comparison_.deviations.push_back(
        {.name = "not-met",
         .sentence = fmt::format("no letters lead to {}", names),
         .documented =
             fmt::format("{} leads to {}", documented_.words_of(first->access), first->name),
         .learned = fmt::format("it leads to {}", name_of(learned_.state_after(first->access))),
         .shown_by = first->access});
  }

  void add_shortest(const Word& word) {
    const Word begin{word.begin(), word.end() - 1};
    const auto letter = learned_.letters[word.back()];
    const auto is = learned_.answers(word).back();
    comparison_.deviations.push_back(
        {.name = fmt::format("{}.{}", name_of(learned_.state_after(begin)), letter),
         .sentence = fmt::format("after {}, {} is answered with {}", learned_.words_of(begin),
                                 letter, said_in_words(is)),
         .documented = said_in_words(documented_.answers(word).back()),
         .learned = said_in_words(is),
         .shown_by = word});
  }

  const Machine& learned_;
  const Machine& documented_;
  Comparison comparison_;
};

}  // namespace

Comparison compare(const Machine& learned, const Machine& documented) {
  return Comparing{learned, documented}.compare();
}

Machine named(Machine learned, const Machine& documented, const Comparison& comparison) {
  for (std::size_t i = 0; i < learned.states.size(); ++i) {
    if (const auto known = comparison.documented[i]) {
      learned.states[i].name = documented.states[*known].name;
    }
  }
  return learned;
}

}  // namespace armjig::mealy
