// SPDX-License-Identifier: Apache-2.0
#include "harness/mealy/learner.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <deque>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <tuple>
#include <utility>

namespace armjig::mealy {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kFewestTests = 200;
/// Letters of a walk that covers pairs of letters, after what leads to where it begins.
constexpr std::size_t kLongestWalk = 6;
/// Answers of before that may prove wrong: more of them, and the machine is not the same each time.
constexpr int kMostCorrections = 10;

Word joined(const Word& word, Letter letter) { return mealy::joined(word, Word{letter}); }

/// All that was said, by what had been asked until then, so that nothing is asked twice.
class Memory {
 public:
  Memory(Teacher& teacher, const std::vector<std::string>& letters, const LearnOptions& options)
      : teacher_{teacher}, letters_{letters}, options_{options} {}

  /// None: it may not be asked any more.
  [[nodiscard]] Outcome<std::optional<Said>> ask(const Word& word, std::size_t states) {
    if (auto known = recall(word)) return known;
    if (is_spent_ || asked_.letters + word.size() > options_.most_letters || options_.must_stop()) {
      is_spent_ = true;
      return std::nullopt;
    }
    auto said = ask_teacher(word, states);
    if (said && contradiction_in(word, *said)) {
      ++asked_.unsteady;
      said = ask_again(word, states);
    }
    if (!said) return tl::unexpected{said.error()};
    const auto place = contradiction_in(word, *said);
    if (place) {
      const Word doubted{word.begin(), word.begin() + static_cast<std::ptrdiff_t>(*place) + 1};
      const auto is_wrong = was_wrong(doubted, said->at(*place), states);
      if (!is_wrong) return tl::unexpected{is_wrong.error()};
      is_spent_ = true;
      if (*is_wrong && corrections_ < kMostCorrections) {
        ++corrections_;
        is_corrected_ = true;
        forget(doubted);
      } else {
        note_contradiction(word, *place, *said);
      }
      return std::nullopt;
    }
    keep(word, *said);
    return *std::move(said);
  }

  /// Whether an answer of before proved wrong and was forgotten, so that all that was made of it
  /// is to be made again. Asking may go on then.
  [[nodiscard]] bool take_corrected() noexcept {
    if (!std::exchange(is_corrected_, false)) return false;
    is_spent_ = false;
    return true;
  }

  [[nodiscard]] Asked& asked() noexcept { return asked_; }
  [[nodiscard]] bool is_spent() const noexcept { return is_spent_; }
  [[nodiscard]] const std::string& contradiction() const noexcept { return contradiction_; }

 private:
  struct Node {
    std::string said{};
    std::map<Letter, std::size_t> next{};
  };

  Outcome<Said> ask_teacher(const Word& word, std::size_t states) {
    asked_.letters += word.size();
    ++asked_.words;
    if (options_.on_asked) options_.on_asked(asked_, states);
    return teacher_.ask(word);
  }

  /// The first answer that is as those of before; if none of a few is, the last one.
  Outcome<Said> ask_again(const Word& word, std::size_t states) {
    constexpr int kTimes = 3;
    auto said = ask_teacher(word, states);
    for (int left = kTimes; left > 1 && said && contradiction_in(word, *said); --left) {
      said = ask_teacher(word, states);
    }
    return said;
  }

  /// Whether the word, by itself, is answered as it is now, time and again, and not as before.
  Outcome<bool> was_wrong(const Word& word, const std::string& now, std::size_t states) {
    constexpr int kTimes = 2;
    for (int left = kTimes; left > 0; --left) {
      const auto said = ask_teacher(word, states);
      if (!said) return tl::unexpected{said.error()};
      if (said->back() != now) return false;
    }
    return true;
  }

  /// What was said to the last letter of the word, and all that was asked beyond.
  void forget(const Word& word) {
    std::size_t node = 0;
    for (const auto letter : Word{word.begin(), word.end() - 1}) node = next(node, letter);
    nodes_[node].next.erase(word.back());
  }

  [[nodiscard]] std::size_t next(std::size_t node, Letter letter) const {
    const auto found = nodes_[node].next.find(letter);
    return found == nodes_[node].next.end() ? kNone : found->second;
  }

  [[nodiscard]] std::optional<Said> recall(const Word& word) const {
    Said said;
    std::size_t node = 0;
    for (const auto letter : word) {
      node = next(node, letter);
      if (node == kNone) return std::nullopt;
      said.push_back(nodes_[node].said);
    }
    return said;
  }

  /// The first letter that was answered otherwise before.
  [[nodiscard]] std::optional<std::size_t> contradiction_in(const Word& word,
                                                            const Said& said) const {
    std::size_t node = 0;
    for (std::size_t i = 0; i < word.size(); ++i) {
      node = next(node, word[i]);
      if (node == kNone) return std::nullopt;
      if (nodes_[node].said != said[i]) return i;
    }
    return std::nullopt;
  }

  void keep(const Word& word, const Said& said) {
    std::size_t node = 0;
    for (std::size_t i = 0; i < word.size(); ++i) {
      auto to = next(node, word[i]);
      if (to == kNone) {
        to = nodes_.size();
        nodes_[node].next.emplace(word[i], to);
        nodes_.push_back({said[i], {}});
      }
      node = to;
    }
  }

  void note_contradiction(const Word& word, std::size_t place, const Said& said) {
    const auto end = word.begin() + static_cast<std::ptrdiff_t>(place);
    const auto before = recall({word.begin(), end + 1})->back();
    contradiction_ =
        fmt::format("after {}, {} is answered with {}, and was with {}",
                    Machine{letters_, {}}.words_of({word.begin(), end}), letters_[word[place]],
                    said_in_words(said[place]), said_in_words(before));
  }

  Teacher& teacher_;
  const std::vector<std::string>& letters_;
  const LearnOptions& options_;
  std::vector<Node> nodes_{Node{}};
  Asked asked_;
  bool is_spent_ = false;
  bool is_corrected_ = false;
  int corrections_ = 0;
  std::string contradiction_;
};

class Learner {
 public:
  Learner(Memory& memory, const std::vector<std::string>& letters, const LearnOptions& options)
      : options_{options}, random_{options.seed}, memory_{memory} {
    machine_.letters = letters;
    machine_.states.push_back(state({}));
    tree_.push_back({.state = 0});
    leaves_.push_back(0);
    await_steps(0);
  }

  [[nodiscard]] Outcome<Learned> run() {
    Learned learned;
    for (;;) {
      if (auto closed = close(); !closed) return tl::unexpected{closed.error()};
      if (memory_.is_spent()) break;
      learned.machine = machine_;
      auto wrong = find_wrong();
      if (!wrong) return tl::unexpected{wrong.error()};
      if (wrong->empty()) {
        learned.is_settled = !memory_.is_spent();
        break;
      }
      if (auto put_right = learn_from(*wrong); !put_right) {
        return tl::unexpected{put_right.error()};
      }
      if (memory_.is_spent()) break;
    }
    learned.asked = memory_.asked();
    learned.contradiction = memory_.contradiction();
    return learned;
  }

 private:
  /// A leaf has a state; another node a word, and by what is said to it the node that comes next.
  struct Node {
    std::size_t state = kNone;
    Word suffix{};
    std::map<Said, std::size_t> next{};
    std::size_t parent = kNone;
  };
  using Pair = std::tuple<std::size_t, Letter, Letter>;  ///< of letters, from a state on
  struct Waiting {
    std::size_t state;
    Letter letter;
    std::size_t node;  ///< of the tree, from which on it is not known where it leads
  };

  State state(Word access) const {
    return {fmt::format("state {}", machine_.states.size()), std::move(access),
            std::vector<Step>(machine_.letters.size())};
  }

  Outcome<std::optional<Said>> ask(const Word& word) {
    return memory_.ask(word, machine_.states.size());
  }

  void await_steps(std::size_t state) {
    for (std::size_t i = 0; i < machine_.letters.size(); ++i) {
      waiting_.push_back({state, static_cast<Letter>(i), 0});
    }
  }

  std::size_t add_state(Word access, std::size_t leaf) {
    const auto added = machine_.states.size();
    machine_.states.push_back(state(std::move(access)));
    leaves_.push_back(leaf);
    await_steps(added);
    return added;
  }

  /// What is said to `suffix` after `word`; none as for `Memory::ask`.
  Outcome<std::optional<Said>> ask_after(const Word& word, const Word& suffix) {
    auto said = ask(mealy::joined(word, suffix));
    if (said && *said) (*said)->erase((*said)->begin(), (*said)->begin() + std::ssize(word));
    return said;
  }

  /// Finds out where each step leads that waits for it. It may be left undone if nothing may be
  /// asked any more.
  Outcome<void> close() {
    while (!waiting_.empty()) {
      const auto one = waiting_.front();
      waiting_.pop_front();
      const auto word = joined(machine_.states[one.state].access, one.letter);
      auto said = ask(word);
      if (!said) return tl::unexpected{said.error()};
      if (!*said) return {};
      auto to = sift(word, one.node);
      if (!to) return tl::unexpected{to.error()};
      if (*to == kNone) return {};
      auto& step = machine_.states[one.state].steps[one.letter];
      if (step.to != *to) uncover(one.state, one.letter);
      step = {*to, (*said)->back()};
    }
    return {};
  }

  /// The state that the word leads to, a new one perhaps; `kNone` as for `Memory::ask`.
  Outcome<std::size_t> sift(const Word& word, std::size_t node) {
    while (tree_[node].state == kNone) {
      auto said = ask_after(word, tree_[node].suffix);
      if (!said) return tl::unexpected{said.error()};
      if (!*said) return kNone;
      const auto found = tree_[node].next.find(**said);
      if (found == tree_[node].next.end()) return add_state(word, add_leaf(node, **said));
      node = found->second;
    }
    return tree_[node].state;
  }

  /// Of the state that is about to be added.
  std::size_t add_leaf(std::size_t parent, const Said& said) {
    const auto leaf = tree_.size();
    tree_[parent].next.emplace(said, leaf);
    tree_.push_back({.state = machine_.states.size(), .suffix = {}, .next = {}, .parent = parent});
    return leaf;
  }

  /// From a word that the machine gets wrong at its last letter. Between its first letter and its
  /// last is one from which on the machine is right: there the machine is in the wrong state.
  Outcome<void> learn_from(const Word& wrong) {
    const auto right = ask(wrong);
    if (!right || !*right) return right ? Outcome<void>{} : tl::unexpected{right.error()};
    const auto expected = machine_.answers(wrong).back();
    std::size_t low = 0;
    auto high = wrong.size() - 1;
    while (high - low > 1) {
      const auto middle = low + (high - low) / 2;
      const Word begin{wrong.begin(), wrong.begin() + static_cast<std::ptrdiff_t>(middle)};
      const Word rest{wrong.begin() + static_cast<std::ptrdiff_t>(middle), wrong.end()};
      auto said = ask_after(machine_.states[machine_.state_after(begin)].access, rest);
      if (!said || !*said) return said ? Outcome<void>{} : tl::unexpected{said.error()};
      ((*said)->back() == expected ? high : low) = middle;
    }
    const Word begin{wrong.begin(), wrong.begin() + static_cast<std::ptrdiff_t>(low)};
    const Word suffix{wrong.begin() + static_cast<std::ptrdiff_t>(low) + 1, wrong.end()};
    const auto before = machine_.state_after(begin);
    return split(machine_.states[before].steps[wrong[low]].to,
                 joined(machine_.states[before].access, wrong[low]), suffix);
  }

  /// What `access` leads to is not that state: `suffix` tells them apart.
  Outcome<void> split(std::size_t old, const Word& access, const Word& suffix) {
    auto of_old = ask_after(machine_.states[old].access, suffix);
    if (!of_old || !*of_old) return of_old ? Outcome<void>{} : tl::unexpected{of_old.error()};
    auto of_new = ask_after(access, suffix);
    if (!of_new || !*of_new) return of_new ? Outcome<void>{} : tl::unexpected{of_new.error()};
    assert(**of_old != **of_new);
    const auto node = leaves_[old];
    tree_[node].state = kNone;
    tree_[node].suffix = suffix;
    leaves_[old] = tree_.size();
    tree_[node].next.emplace(**of_old, leaves_[old]);
    tree_.push_back({.state = old, .suffix = {}, .next = {}, .parent = node});
    for (std::size_t i = 0; i < machine_.states.size(); ++i) {
      for (std::size_t j = 0; j < machine_.letters.size(); ++j) {
        if (machine_.states[i].steps[j].to == old) {
          waiting_.push_back({i, static_cast<Letter>(j), node});
        }
      }
    }
    add_state(access, add_leaf(node, **of_new));
    return {};
  }

  /// A word that the machine gets wrong, up to the letter; empty: none was found.
  Outcome<Word> find_wrong() {
    for (auto walk = next_walk(); !walk.empty(); walk = next_walk()) {
      auto wrong = wrong_in(walk);
      if (!wrong || !wrong->empty() || memory_.is_spent()) {
        for (const auto& pair : walked_) covered_.erase(pair);  // beyond what was wrong is nothing
        return wrong;
      }
    }
    const auto steps = machine_.states.size() * machine_.letters.size();
    for (std::size_t i = 0; i < std::max(kFewestTests, steps); ++i) {
      auto wrong = wrong_in(draw());
      if (!wrong || !wrong->empty() || memory_.is_spent()) return wrong;
    }
    return Word{};
  }

  /// Up to the letter that the machine gets wrong, and without what is not needed for it; empty: it
  /// gets none wrong, or nothing may be asked any more.
  Outcome<Word> wrong_in(const Word& word) {
    auto wrong = up_to_wrong(word);
    ++memory_.asked().tests;
    if (!wrong || wrong->size() < 2) return wrong;
    for (auto from = wrong->end() - 1; from != wrong->begin(); --from) {
      const auto& access = machine_.states[machine_.state_after({wrong->begin(), from})].access;
      auto shorter = mealy::joined(access, {from, wrong->end()});
      if (shorter.size() >= wrong->size()) continue;
      auto still_wrong = up_to_wrong(shorter);
      if (!still_wrong || !still_wrong->empty()) return still_wrong;
    }
    return wrong;
  }

  Outcome<Word> up_to_wrong(Word word) {
    auto said = ask(word);
    if (!said) return tl::unexpected{said.error()};
    if (!*said) return Word{};
    const auto expected = machine_.answers(word);
    const auto [place, _] = std::ranges::mismatch(**said, expected);
    if (place == (*said)->end()) return Word{};
    word.resize(static_cast<std::size_t>(place - (*said)->begin()) + 1);
    return word;
  }

  /// Covers a pair of letters from a state on that no walk has covered, and more of them behind it;
  /// empty: all are covered.
  Word next_walk() {
    const auto count = machine_.letters.size();
    for (std::size_t state = 0; state < machine_.states.size(); ++state) {
      const auto first = below(count);
      for (std::size_t i = 0; i < count; ++i) {
        const auto letter = static_cast<Letter>((first + i) % count);
        if (uncovered(state, letter)) return walk_from(state, letter);
      }
    }
    return {};
  }

  Word walk_from(std::size_t state, Letter letter) {
    auto word = joined(machine_.states[state].access, letter);
    walked_.clear();
    for (std::size_t i = 1; i < kLongestWalk; ++i) {
      const auto next = uncovered(state, letter);
      if (!next) break;
      walked_.emplace_back(state, letter, *next);
      covered_.insert(walked_.back());
      word.push_back(*next);
      state = machine_.states[state].steps[letter].to;
      letter = *next;
    }
    return word;
  }

  /// A letter that no walk has had after that one in that state.
  std::optional<Letter> uncovered(std::size_t state, Letter letter) {
    const auto count = machine_.letters.size();
    const auto first = below(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto next = static_cast<Letter>((first + i) % count);
      if (!covered_.contains({state, letter, next})) return next;
    }
    return std::nullopt;
  }

  /// The step leads elsewhere: what was covered behind it was covered behind another one.
  void uncover(std::size_t state, Letter letter) {
    std::erase_if(covered_, [&](const auto& pair) {
      return std::get<0>(pair) == state && std::get<1>(pair) == letter;
    });
  }

  std::size_t below(std::size_t limit) { return static_cast<std::size_t>(random_() % limit); }

  /// To a state, on at random, and what tells where that has led.
  Word draw() {
    auto word = machine_.states[below(machine_.states.size())].access;
    std::size_t middle = 1;
    while (middle < options_.longest_middle && below(2) == 0) ++middle;
    for (std::size_t i = 0; i < middle; ++i) {
      word.push_back(static_cast<Letter>(below(machine_.letters.size())));
    }
    std::vector<const Word*> telling;
    const auto leaf = leaves_[machine_.state_after(word)];
    for (auto node = tree_[leaf].parent; node != kNone; node = tree_[node].parent) {
      telling.push_back(&tree_[node].suffix);
    }
    if (telling.empty()) return joined(word, static_cast<Letter>(below(machine_.letters.size())));
    return mealy::joined(std::move(word), *telling[below(telling.size())]);
  }

  const LearnOptions& options_;
  std::mt19937_64 random_;
  Machine machine_;
  Memory& memory_;
  std::vector<Node> tree_;
  std::vector<std::size_t> leaves_;  ///< of each state, in the tree
  std::deque<Waiting> waiting_;
  std::set<Pair> covered_;    ///< by walks
  std::vector<Pair> walked_;  ///< covered by the last of them
};

}  // namespace

Outcome<Learned> learn(Teacher& teacher, const std::vector<std::string>& letters,
                       const LearnOptions& options) {
  Memory memory{teacher, letters, options};
  for (;;) {
    auto learned = Learner{memory, letters, options}.run();
    if (!learned || !memory.take_corrected()) return learned;
  }
}

}  // namespace armjig::mealy
