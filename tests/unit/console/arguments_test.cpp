// SPDX-License-Identifier: Apache-2.0
#include "harness/console/arguments.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace armjig {
namespace {

using namespace std::chrono_literals;

TEST(Arguments, ReadsNumbersWithTheirUnits) {
  EXPECT_EQ(parse_number("-1.5deg")->value, -1.5);
  EXPECT_EQ(parse_number("-1.5deg")->unit, "deg");
  EXPECT_EQ(parse_number("+2")->value, 2);
  for (const auto* const text : {"", "x", "nan", "inf", "1e999", "-"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
}

TEST(Arguments, ReadsOnlyNumbersThatSinglePrecisionHas) {
  EXPECT_EQ(parse_float("0.1"), 0.1F);
  for (const auto* const text : {"1e39", "-1e39", "1rad", "nan"}) {
    EXPECT_FALSE(parse_float(text)) << text;
  }
}

TEST(Arguments, ReadsTimesUpToAnHour) {
  EXPECT_EQ(parse_seconds("1.5"), Duration{1500ms});
  EXPECT_EQ(parse_seconds("3600s"), Duration{1h});
  for (const auto* const text : {"0", "-1", "3600.1", "1ms", "now"}) {
    EXPECT_FALSE(parse_seconds(text)) << text;
  }
}

TEST(Arguments, ReadsWholeNumbersOfARange) {
  EXPECT_EQ(parse_whole("node", "16", 0, 16), 16);
  EXPECT_EQ(parse_whole("node", "17", 0, 16).error(),
            "'17' is no node: a whole number from 0 to 16");
  for (const auto* const text : {"", "1.0", "+1", "99999999999"}) {
    EXPECT_FALSE(parse_whole("node", text, 0, 16)) << text;
  }
}

}  // namespace
}  // namespace armjig
