// SPDX-License-Identifier: Apache-2.0
#include "harness/mealy/machine.hpp"

#include <fmt/core.h>

#include <deque>
#include <set>
#include <utility>

namespace armjig::mealy {

std::size_t Machine::state_after(const Word& word, std::size_t from) const {
  for (const auto letter : word) from = states[from].steps[letter].to;
  return from;
}

Said Machine::answers(const Word& word, std::size_t from) const {
  Said said;
  for (const auto letter : word) {
    const auto& step = states[from].steps[letter];
    said.push_back(step.said);
    from = step.to;
  }
  return said;
}

std::string Machine::words_of(const Word& word) const {
  std::string text;
  for (const auto letter : word) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", letters[letter]);
  }
  return text.empty() ? "nothing" : text;
}

std::optional<Word> difference(const Machine& one, std::size_t from_one, const Machine& other,
                               std::size_t from_other) {
  struct Pair {
    std::size_t one;
    std::size_t other;
    Word word;
  };
  std::deque<Pair> waiting{{from_one, from_other, {}}};
  std::set<std::pair<std::size_t, std::size_t>> seen{{from_one, from_other}};
  for (; !waiting.empty(); waiting.pop_front()) {
    const auto& at = waiting.front();
    for (std::size_t i = 0; i < one.letters.size(); ++i) {
      const auto& left = one.states[at.one].steps[i];
      const auto& right = other.states[at.other].steps[i];
      auto word = joined(at.word, Word{static_cast<Letter>(i)});
      if (left.said != right.said) return word;
      if (seen.emplace(left.to, right.to).second) {
        waiting.push_back({left.to, right.to, std::move(word)});
      }
    }
  }
  return std::nullopt;
}

Word joined(Word word, const Word& more) {
  word.insert(word.end(), more.begin(), more.end());
  return word;
}

std::string said_in_words(const std::string& said) { return said.empty() ? "nothing" : said; }

}  // namespace armjig::mealy
