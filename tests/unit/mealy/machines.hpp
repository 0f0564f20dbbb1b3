// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "harness/mealy/documented.hpp"
#include "harness/mealy/learner.hpp"

namespace armjig::mealy {

/// Has the machine, and counts what it is asked.
class Owner final : public Teacher {
 public:
  explicit Owner(Machine machine) : machine_{std::move(machine)} {}

  Outcome<Said> ask(const Word& word) override {
    ++asked;
    return machine_.answers(word);
  }

  std::size_t asked = 0;

 private:
  Machine machine_;
};

/// A turnstile: a coin opens it, pushing it goes through. It takes no second coin.
inline constexpr Row kTurnstileRows[] = {{"shut", "coin", "clicks", "open"},
                                         {"shut", "push", "", ""},
                                         {"open", "coin", "returned", ""},
                                         {"open", "push", "turns", "shut"}};
inline constexpr Table kTurnstile[] = {{"shut", kTurnstileRows}};
inline const std::vector<std::string> kTurnstileLetters{"coin", "push"};

inline Machine turnstile() {
  return documented(kTurnstile, kTurnstileLetters, "turnstile").value();
}

/// Steps and answers at random; each state is reached, and some may answer alike.
inline Machine drawn_machine(unsigned seed, std::size_t states, std::size_t letters,
                             std::size_t answers) {
  std::mt19937 random{seed};
  const auto below = [&](std::size_t limit) { return random() % limit; };
  Machine machine;
  for (std::size_t i = 0; i < letters; ++i)
    machine.letters.push_back("letter " + std::to_string(i));
  for (std::size_t i = 0; i < states; ++i) {
    State state{"drawn " + std::to_string(i), {}, {}};
    for (std::size_t j = 0; j < letters; ++j) {
      state.steps.push_back({below(states), "answer " + std::to_string(below(answers))});
    }
    machine.states.push_back(std::move(state));
  }
  for (std::size_t i = 0; i + 1 < states; ++i) {
    machine.states[i].steps[below(letters)].to = i + 1;
  }
  return machine;
}

}  // namespace armjig::mealy
