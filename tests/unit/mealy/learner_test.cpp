// SPDX-License-Identifier: Apache-2.0
#include "harness/mealy/learner.hpp"

#include <gtest/gtest.h>

#include "tests/unit/mealy/machines.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig::mealy {
namespace {

TEST(Learner, LearnsATurnstile) {
  Owner owner{turnstile()};
  const auto learned = learn(owner, kTurnstileLetters, {}).value();
  EXPECT_TRUE(learned.is_settled);
  EXPECT_EQ(learned.machine.states.size(), 2U);
  EXPECT_FALSE(difference(learned.machine, 0, turnstile(), 0));
}

TEST(Learner, LearnsAMachineThatAlwaysAnswersAlike) {
  constexpr Row kRows[] = {{"", "", "no", ""}};
  const Table kTables[] = {{"mute", kRows}};
  Owner owner{documented(kTables, {"a", "b"}, "mute").value()};
  const auto learned = learn(owner, {"a", "b"}, {}).value();
  EXPECT_TRUE(learned.is_settled);
  EXPECT_EQ(learned.machine.states.size(), 1U);
}

/// A lock that opens after four right digits: nothing tells its states apart before.
TEST(Learner, FindsAStateThatOnlyALongWordTells) {
  constexpr Row kRows[] = {{"0", "a", "", "1"},
                           {"1", "b", "", "2"},
                           {"2", "a", "", "3"},
                           {"3", "b", "opens", "0"},
                           {"", "", "", "0"}};
  const Table kTables[] = {{"0", kRows}};
  const auto lock = documented(kTables, {"a", "b"}, "lock").value();
  Owner owner{lock};
  const auto learned = learn(owner, {"a", "b"}, {}).value();
  EXPECT_EQ(learned.machine.states.size(), 4U);
  EXPECT_FALSE(difference(learned.machine, 0, lock, 0));
}

TEST(Learner, LearnsMachinesDrawnAtRandom) {
  test::for_all([] {
    const auto machine =
        drawn_machine(*rc::gen::arbitrary<unsigned>(), *rc::gen::inRange<std::size_t>(1, 16),
                      *rc::gen::inRange<std::size_t>(2, 9), *rc::gen::inRange<std::size_t>(2, 5));
    Owner owner{machine};
    const auto learned = learn(owner, machine.letters, {.most_letters = 100'000}).value();
    RC_ASSERT(learned.is_settled);
    RC_ASSERT(!difference(learned.machine, 0, machine, 0).has_value());
    RC_ASSERT(learned.machine.states.size() <= machine.states.size());
    RC_ASSERT(owner.asked == learned.asked.words);
  });
}

TEST(Learner, GivesNoMoreLettersThanItMay) {
  const auto machine = drawn_machine(3, 12, 6, 2);
  for (const std::size_t most : {0U, 10U, 100U, 300U}) {
    Owner owner{machine};
    const auto learned = learn(owner, machine.letters, {.most_letters = most}).value();
    EXPECT_LE(learned.asked.letters, most);
    EXPECT_FALSE(learned.is_settled);
  }
}

TEST(Learner, AsksTheSameForTheSameSeed) {
  const auto machine = drawn_machine(5, 10, 5, 3);
  Owner one{machine};
  Owner other{machine};
  const auto first = learn(one, machine.letters, {.seed = 9}).value();
  const auto second = learn(other, machine.letters, {.seed = 9}).value();
  EXPECT_EQ(first.asked.letters, second.asked.letters);
  EXPECT_EQ(first.asked.tests, second.asked.tests);
}

/// Answers the first letter of some words otherwise.
class Moody final : public Teacher {
 public:
  /// `is_moody` is told the word and how many were asked before.
  explicit Moody(bool (*is_moody)(const Word& word, std::size_t asked)) : is_moody_{is_moody} {}
  Outcome<Said> ask(const Word& word) override {
    auto said = turnstile().answers(word);
    if (is_moody_(word, asked_++)) said.front() = "growls";
    return said;
  }

 private:
  bool (*is_moody_)(const Word& word, std::size_t asked);
  std::size_t asked_ = 0;
};

TEST(Learner, SaysWhatIsNotTheSameEachTime) {
  Moody teacher{[](const Word& word, std::size_t /*asked*/) { return word.size() > 3; }};
  const auto learned = learn(teacher, kTurnstileLetters, {}).value();
  EXPECT_FALSE(learned.is_settled);
  EXPECT_NE(learned.contradiction.find("growls"), std::string::npos) << learned.contradiction;
}

TEST(Learner, AsksAgainWhatWasAnsweredOtherwiseOnce) {
  Moody teacher{[](const Word& /*word*/, std::size_t asked) { return asked == 6; }};
  const auto learned = learn(teacher, kTurnstileLetters, {}).value();
  EXPECT_EQ(learned.contradiction, "");
  EXPECT_EQ(learned.asked.unsteady, 1U);
  EXPECT_FALSE(difference(learned.machine, 0, turnstile(), 0));
}

/// What was heard wrongly first contradicts all that is heard later.
TEST(Learner, LearnsAgainWhatWasMadeOfAWrongAnswer) {
  for (const std::size_t wrong : {0U, 1U, 3U, 5U}) {
    static std::size_t at;
    at = wrong;
    Moody teacher{[](const Word& /*word*/, std::size_t asked) { return asked == at; }};
    const auto learned = learn(teacher, kTurnstileLetters, {}).value();
    EXPECT_EQ(learned.contradiction, "") << wrong;
    EXPECT_TRUE(learned.is_settled) << wrong;
    EXPECT_FALSE(difference(learned.machine, 0, turnstile(), 0)) << wrong;
  }
}

TEST(Learner, LearnsFromATeacherWhoIsOftenWrong) {
  Moody teacher{[](const Word& word, std::size_t asked) {
    return (asked * 2'654'435'761U + word.size()) % 97 < 4;
  }};
  const auto learned = learn(teacher, kTurnstileLetters, {}).value();
  EXPECT_EQ(learned.contradiction, "");
  EXPECT_GT(learned.asked.unsteady, 0U);
  EXPECT_FALSE(difference(learned.machine, 0, turnstile(), 0));
}

class Absent final : public Teacher {
 public:
  Outcome<Said> ask(const Word& /*word*/) override {
    return problem(ErrorCode::kRefused, "nowhere", "start it");
  }
};

TEST(Learner, PassesOnWhyTheTeacherCannotBeAsked) {
  Absent teacher;
  const auto learned = learn(teacher, kTurnstileLetters, {});
  ASSERT_FALSE(learned);
  EXPECT_EQ(learned.error().code, ErrorCode::kRefused);
}

}  // namespace
}  // namespace armjig::mealy
