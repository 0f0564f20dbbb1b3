// SPDX-License-Identifier: Apache-2.0
#include "harness/config/toml_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace armjig {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TomlTable parsed(std::string_view text) { return TomlTable::parse(text, "a.toml").value(); }

TEST(TomlTable, ReadsWhatIsAskedFor) {
  auto table = parsed("a = 1.5\nb = 7\nc = \"x\"\nd = [1, 2.5]\ne = true\n");
  EXPECT_EQ(table.number("a"), 1.5);
  EXPECT_EQ(table.number("b"), 7.0);
  EXPECT_EQ(table.integer("b", 0, 9), 7);
  EXPECT_EQ(table.text("c"), "x");
  EXPECT_THAT(table.numbers("d").value(), ElementsAre(1.0, 2.5));
  EXPECT_EQ(table.boolean("e"), true);
  EXPECT_EQ(table.number("f"), std::nullopt);
  EXPECT_TRUE(table.finish());
}

TEST(TomlTable, NamesTheLineOfAKeyThatNobodyAskedFor) {
  auto table = parsed("a = 1\n\ntypo = 2\n");
  (void)table.number("a");
  const auto finished = table.finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().where, "a.toml:3");
  EXPECT_THAT(finished.error().hint, HasSubstr("'typo'"));
}

TEST(TomlTable, NamesTheLineOfAKeyInATableOfAList) {
  auto table = parsed("[[node]]\nid = 1\n[[node]]\nid = 2\nmass = 3\n");
  for (auto& node : table.tables("node")) (void)node.integer("id", 0, 9);
  EXPECT_EQ(table.finish().error().where, "a.toml:5");
}

TEST(TomlTable, RefusesValuesOfAnotherTypeOrOutOfRange) {
  auto table = parsed("a = \"1\"\n");
  EXPECT_EQ(table.number("a"), std::nullopt);
  EXPECT_THAT(table.finish().error().hint, HasSubstr("a has to be a number"));
  auto other = parsed("b = 10\n");
  EXPECT_EQ(other.integer("b", 0, 9), std::nullopt);
  EXPECT_THAT(other.finish().error().hint, HasSubstr("from 0 to 9"));
  auto third = parsed("node = 1\n");
  EXPECT_TRUE(third.tables("node").empty());
  EXPECT_THAT(third.finish().error().hint, HasSubstr("[[node]]"));
}

TEST(TomlTable, TellsTheFirstMistakeOnly) {
  auto table = parsed("a = \"1\"\nb = \"2\"\n");
  (void)table.number("b");
  (void)table.number("a");
  EXPECT_EQ(table.finish().error().where, "a.toml:2");
}

TEST(TomlTable, NamesTheLineThatIsNoToml) {
  const auto table = TomlTable::parse("a = 1\nb =\n", "a.toml");
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().code, ErrorCode::kMalformed);
  EXPECT_THAT(table.error().where, HasSubstr("a.toml:2"));
}

TEST(TomlTable, RefusesKeysOfEndlessTables) {
  std::string endless;
  for (int i = 0; i < 200'000; ++i) endless += "a.";
  for (const auto& text : {endless + "b = 1", "\n[" + endless + "b]\nx = 1"}) {
    const auto table = TomlTable::parse(text, "a.toml");
    ASSERT_FALSE(table);
    EXPECT_THAT(table.error().hint, HasSubstr("levels deep"));
  }
  EXPECT_TRUE(TomlTable::parse("a = 1 # " + endless, "a.toml"));
}

TEST(TomlTable, NamesAFileThatIsNotThere) {
  EXPECT_EQ(TomlTable::read("/nonexistent").error().code, ErrorCode::kCannotRead);
}

}  // namespace
}  // namespace armjig
