// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "emulators/campaign/alphabet.hpp"
#include "emulators/campaign/stage.hpp"
#include "harness/mealy/learner.hpp"

namespace armjig::campaign {

/// Asks the target of a stage words of an alphabet. Each word is one script; what came between the
/// beginnings of two letters is the answer to the first of them, but for replies that were late
/// (`Learnable::is_reply`). A word begins on a target that is
/// as new, or that `Learnable::reset` has led to its beginning.
class Questions final : public mealy::Teacher {
 public:
  /// All of them outlive this. `quiet` takes the place of the entry's if it is not zero.
  Questions(Stage& stage, const Learnable& machine, MakeDissector make_dissector, Duration quiet);

  /// Problems: those of the stage; `kUnsupported` if nobody can bring the target to its beginning;
  /// why the link ended.
  [[nodiscard]] Outcome<mealy::Said> ask(const mealy::Word& word) override;

 private:
  struct Asked {
    Script script;
    std::vector<Instant> begins;  ///< of each letter
  };
  struct Answers {
    mealy::Said said;
    bool is_whole{};  ///< no reply is missing
  };
  /// On a target that is where it begins.
  [[nodiscard]] Outcome<BothHeard> play(const Script& script);
  [[nodiscard]] Asked script_of(const mealy::Word& word) const;
  [[nodiscard]] bool give_back_replies(const std::vector<Message>& messages, const Asked& asked,
                                       std::vector<std::size_t>& letters) const;
  [[nodiscard]] Answers answers_in(const Heard& heard, const Asked& asked) const;

  Stage& stage_;
  const Learnable& machine_;
  MakeDissector make_dissector_;
  Duration quiet_;
  bool was_begun_ = false;
};

/// The names of the letters.
[[nodiscard]] std::vector<std::string> letters_of(const Learnable& machine);

}  // namespace armjig::campaign
