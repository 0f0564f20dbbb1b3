// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/error.hpp"
#include "harness/mealy/machine.hpp"

namespace armjig::mealy {

/// Whoever has the machine that is to be learned.
class Teacher {
 public:
  Teacher() = default;
  Teacher(const Teacher&) = delete;
  Teacher& operator=(const Teacher&) = delete;
  virtual ~Teacher() = default;

  /// What is said to the word by a machine that begins anew, one for each letter. Problems: it
  /// cannot be asked.
  [[nodiscard]] virtual Outcome<Said> ask(const Word& word) = 0;
};

/// What asking has cost.
struct Asked {
  std::size_t letters{};   ///< given to the teacher, all words together
  std::size_t words{};     ///< the same in words, each of which begins anew
  std::size_t tests{};     ///< words that tried whether the machine is the right one
  std::size_t unsteady{};  ///< words that were answered otherwise than before at least once
};

struct LearnOptions {
  std::uint64_t seed = 1;             ///< of the words that try the machine
  std::size_t most_letters = 10'000;  ///< given to the teacher, all words together
  std::size_t longest_middle = 4;     ///< of a try, between what leads to a state and what tells it
  std::function<bool()> must_stop = [] { return false; };
  /// Told of each word that the teacher was asked; `states` are those known so far.
  std::function<void(const Asked& asked, std::size_t states)> on_asked{};
};

struct Learned {
  /// Minimal; its states are called `state 0` and so on. Without states if it ended too soon.
  Machine machine;
  Asked asked;
  /// It was tried to the end. False: the letters were used up, or it had to stop.
  bool is_settled = false;
  /// What the teacher answered in two ways, again and again; it ended there. Empty: nothing.
  std::string contradiction{};
};

/// Learns the machine by asking (M. Kearns, U. Vazirani, 1994): a discrimination tree tells states
/// apart; a word that the machine so far gets wrong is searched for the letter that leads to a
/// state of its own (R. Rivest, R. Schapire, 1993). To find such words, walks cover all pairs of
/// letters in all states; then words lead to a state drawn at random, go on at random, most of them
/// for a letter or two, and tell by the tree where they have led. When as many as there are steps
/// have passed, the machine counts as right. No word is asked twice but one that is answered
/// otherwise than before. Of that one a few more answers are had: if one is as before, it counts.
/// If the letter in question is answered otherwise time and again, also when nothing follows it,
/// the answer of before was wrong (somebody was late), and what was learned from it is learned
/// again. Else the teacher does not answer the same each time.
///
/// Problems: those of the teacher.
[[nodiscard]] Outcome<Learned> learn(Teacher& teacher, const std::vector<std::string>& letters,
                                     const LearnOptions& options);

}  // namespace armjig::mealy
