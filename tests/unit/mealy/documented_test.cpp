// SPDX-License-Identifier: Apache-2.0
#include "harness/mealy/documented.hpp"

#include <gtest/gtest.h>

#include "tests/unit/mealy/machines.hpp"

namespace armjig::mealy {
namespace {

TEST(Documented, IsTheTable) {
  const auto machine = turnstile();
  ASSERT_EQ(machine.states.size(), 2U);
  EXPECT_EQ(machine.states[0].name, "shut");
  EXPECT_EQ(machine.answers({1, 0, 0, 1}), (Said{"", "clicks", "returned", "turns"}));
}

TEST(Documented, PutsTablesSideBySide) {
  constexpr Row kLampRows[] = {
      {"dark", "push", "light", "light"}, {"light", "push", "dark", "dark"}, {"", "", "", ""}};
  const Table tables[] = {kTurnstile[0], {"dark", kLampRows}};
  const auto machine = documented(tables, kTurnstileLetters, "both").value();
  EXPECT_EQ(machine.states.size(), 4U);
  EXPECT_EQ(machine.states[0].name, "shut + dark");
  EXPECT_EQ(machine.answers({0, 1}), (Said{"clicks", "turns, light"}));
}

TEST(Documented, RefusesAStateWithoutARow) {
  constexpr Row kRows[] = {{"shut", "coin", "", "open"}, {"shut", "push", "", ""}};
  const Table kTables[] = {{"shut", kRows}};
  const auto machine = documented(kTables, kTurnstileLetters, "turnstile");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().hint, "no row says what coin does in open");
}

TEST(Documented, RefusesALetterThatThereIsNot) {
  constexpr Row kRows[] = {{"", "kick", "", ""}, {"", "", "", ""}};
  const Table kTables[] = {{"shut", kRows}};
  EXPECT_FALSE(documented(kTables, kTurnstileLetters, "turnstile"));
}

}  // namespace
}  // namespace armjig::mealy
