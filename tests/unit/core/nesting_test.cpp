// SPDX-License-Identifier: Apache-2.0
#include "harness/core/nesting.hpp"

#include <gtest/gtest.h>

#include <string>

namespace armjig {
namespace {

std::string nested(std::size_t levels, char open = '[', char close = ']') {
  return std::string(levels, open) + std::string(levels, close);
}

TEST(Nesting, IsFineUpToTheLimit) {
  EXPECT_FALSE(is_too_deep(nested(kDeepestNesting)));
  EXPECT_TRUE(is_too_deep(nested(kDeepestNesting + 1)));
  EXPECT_TRUE(is_too_deep(nested(kDeepestNesting + 1, '{', '}')));
}

TEST(Nesting, IsNotCountedSideBySide) {
  std::string many;
  for (int i = 0; i < 1000; ++i) many += nested(2) + ',';
  EXPECT_FALSE(is_too_deep('[' + many + ']'));
}

TEST(Nesting, IsNotCountedInsideOfTexts) {
  const auto brackets = std::string(1000, '[');
  EXPECT_FALSE(is_too_deep("\"" + brackets + "\""));
  EXPECT_FALSE(is_too_deep(R"("\")" + brackets + "\""));
  EXPECT_TRUE(is_too_deep(R"("\\")" + brackets));
}

TEST(Nesting, SurvivesWhatClosesTooMuch) { EXPECT_FALSE(is_too_deep("]]]}}}[[[")); }

}  // namespace
}  // namespace armjig
