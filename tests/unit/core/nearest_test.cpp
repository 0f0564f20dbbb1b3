// SPDX-License-Identifier: Apache-2.0
#include "harness/core/nearest.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string_view>

namespace armjig {
namespace {

constexpr std::array<std::string_view, 5> kNames{"conformance", "console", "decode", "kin",
                                                 "trace"};

TEST(Nearest, CountsLettersThatAreWrong) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("trace", "trase"), 1U);   // another letter
  EXPECT_EQ(edit_distance("trace", "trce"), 1U);    // one is missing
  EXPECT_EQ(edit_distance("trace", "tracee"), 1U);  // one too many
  EXPECT_EQ(edit_distance("trace", "rtace"), 1U);   // neighbours exchanged
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

TEST(Nearest, IsTheNameThatWasMeant) {
  EXPECT_EQ(nearest("trase", kNames), "trace");
  EXPECT_EQ(nearest("conformence", kNames), "conformance");
  EXPECT_EQ(nearest("edcode", kNames), "decode");
  EXPECT_EQ(nearest("konsole", kNames), "console");
  EXPECT_EQ(nearest("kim", kNames), "kin");
}

TEST(Nearest, IsANameThatWasOnlyBegun) {
  EXPECT_EQ(nearest("conf", kNames), "conformance");
  EXPECT_EQ(nearest("con", kNames), "conformance");  // the first of several
}

TEST(Nearest, IsNothingIfNoneIsNear) {
  EXPECT_EQ(nearest("frobnicate", kNames), "");
  EXPECT_EQ(nearest("kin", kNames), "");  // it is a name
  EXPECT_EQ(nearest("", kNames), "");
  EXPECT_EQ(nearest("x", kNames), "");
  EXPECT_EQ(nearest("trace", {}), "");
}

TEST(Nearest, IsSaidInFrontOfAHint) {
  EXPECT_EQ(did_you_mean("decod", kNames), "did you mean 'decode'? ");
  EXPECT_EQ(did_you_mean("toaster", kNames), "");
}

}  // namespace
}  // namespace armjig
