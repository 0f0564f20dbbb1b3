// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Machines that answer each input with an output (Mealy machines), over an alphabet of letters.
namespace armjig::mealy {

/// By its place in the alphabet.
using Letter = std::uint16_t;
using Word = std::vector<Letter>;
/// What is said to a word: one for each letter.
using Said = std::vector<std::string>;

struct Step {
  std::size_t to{};  ///< a state, by its place
  std::string said{};

  friend bool operator==(const Step&, const Step&) = default;
};

struct State {
  std::string name;
  Word access{};              ///< leads to it from the first one
  std::vector<Step> steps{};  ///< one for each letter
};

/// Complete: each state has a step for each letter. The first state is where it begins.
struct Machine {
  std::vector<std::string> letters{};
  std::vector<State> states{};

  [[nodiscard]] std::size_t state_after(const Word& word, std::size_t from = 0) const;
  [[nodiscard]] Said answers(const Word& word, std::size_t from = 0) const;
  /// `QuitEStop, Initialize`; of no letter `nothing`.
  [[nodiscard]] std::string words_of(const Word& word) const;
};

/// The shortest word that both answer differently, each from that state; none: there is none. Both
/// have the same alphabet.
[[nodiscard]] std::optional<Word> difference(const Machine& one, std::size_t from_one,
                                             const Machine& other, std::size_t from_other);

[[nodiscard]] Word joined(Word word, const Word& more);

/// What is said in words: `nothing` if it is empty.
[[nodiscard]] std::string said_in_words(const std::string& said);

}  // namespace armjig::mealy
