// SPDX-License-Identifier: Apache-2.0
#include "harness/mealy/deviation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "tests/unit/mealy/machines.hpp"
#include "tests/unit/support/property.hpp"

namespace armjig::mealy {
namespace {

/// A door with a lock: enough letters to tell its states by.
constexpr Row kDoorRows[] = {
    {"open", "close", "thud", "closed"},   {"closed", "open", "creak", "open"},
    {"closed", "lock", "click", "locked"}, {"locked", "unlock", "clack", "closed"},
    {"locked", "open", "rattle", ""},      {"", "", "", ""}};
constexpr Table kDoor[] = {{"open", kDoorRows}};
const std::vector<std::string> kDoorLetters{"open", "close", "lock", "unlock"};

Machine door() { return documented(kDoor, kDoorLetters, "door").value(); }
std::size_t state_of(const Machine& machine, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(machine.states, name, &State::name) -
                                  machine.states.begin());
}

/// What is learned of it.
Machine learned(const Machine& machine) {
  Owner owner{machine};
  return learn(owner, machine.letters, {}).value().machine;
}

TEST(Deviation, ThereIsNoneBetweenAlike) {
  const auto comparison = compare(learned(door()), door());
  EXPECT_TRUE(comparison.deviations.empty());
  const auto machine = named(learned(door()), door(), comparison);
  EXPECT_EQ(machine.states[machine.state_after({1, 2})].name, "locked");
}

TEST(Deviation, NamesAStepThatLeadsElsewhere) {
  auto wrong = door();
  wrong.states[state_of(wrong, "locked")].steps[3].to = state_of(wrong, "open");
  const auto comparison = compare(learned(wrong), door());
  ASSERT_EQ(comparison.deviations.size(), 1U);
  const auto& deviation = comparison.deviations.front();
  EXPECT_EQ(deviation.name, "locked.unlock");
  EXPECT_EQ(deviation.sentence, "in locked, unlock is answered with clack and leads to open");
  EXPECT_EQ(deviation.documented, "clack and closed");
  EXPECT_NE(wrong.answers(deviation.shown_by), door().answers(deviation.shown_by));
}

TEST(Deviation, NamesAnAnswerThatIsWrong) {
  auto wrong = door();
  wrong.states[state_of(wrong, "closed")].steps[2].said = "crunch";
  const auto comparison = compare(learned(wrong), door());
  ASSERT_EQ(comparison.deviations.size(), 1U);
  EXPECT_EQ(comparison.deviations.front().name, "closed.lock");
  EXPECT_EQ(comparison.deviations.front().learned, "crunch and locked");
}

TEST(Deviation, NamesAStateThatNobodyWroteDown) {
  auto wrong = door();
  wrong.states.push_back(
      {"jammed", {}, std::vector<Step>(4, {wrong.states.size(), "nothing goes"})});
  wrong.states[state_of(wrong, "locked")].steps[2] = {wrong.states.size() - 1, "crack"};
  const auto comparison = compare(learned(wrong), door());
  ASSERT_EQ(comparison.deviations.size(), 2U);
  EXPECT_EQ(comparison.deviations[0].name, "locked.lock");
  EXPECT_NE(comparison.deviations[1].sentence.find("close, lock, lock leads to"), std::string::npos)
      << comparison.deviations[1].sentence;
}

TEST(Deviation, NamesADocumentedStateThatIsNotMet) {
  auto wrong = door();
  wrong.states[state_of(wrong, "closed")].steps[2] = {state_of(wrong, "closed"), ""};
  const auto comparison = compare(learned(wrong), door());
  ASSERT_EQ(comparison.deviations.size(), 2U);
  EXPECT_EQ(comparison.deviations[0].name, "closed.lock");
  EXPECT_EQ(comparison.deviations[1].sentence, "no letters lead to locked");
}

TEST(Deviation, IsThereIfAndOnlyIfMachinesDiffer) {
  test::for_all([] {
    const auto documented = drawn_machine(*rc::gen::arbitrary<unsigned>(), 8, 5, 4);
    auto other = documented;
    const auto state = *rc::gen::inRange<std::size_t>(0, 8);
    const auto letter = *rc::gen::inRange<std::size_t>(0, 5);
    other.states[state].steps[letter].to = *rc::gen::inRange<std::size_t>(0, 8);
    const auto machine = learned(other);
    const auto comparison = compare(machine, documented);
    RC_ASSERT(comparison.deviations.empty() == !difference(machine, 0, documented, 0).has_value());
  });
}

}  // namespace
}  // namespace armjig::mealy
