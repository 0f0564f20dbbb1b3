// SPDX-License-Identifier: Apache-2.0
#include "harness/core/time.hpp"

#include <gtest/gtest.h>

namespace armjig {
namespace {

using namespace std::chrono_literals;

TEST(Time, CountsWholeMicrosecondsRoundedDown) {
  EXPECT_EQ(microseconds(at(0ns)), 0);
  EXPECT_EQ(microseconds(at(1999ns)), 1);
  EXPECT_EQ(microseconds(at(2us)), 2);
  EXPECT_EQ(microseconds(at(-1ns)), -1);
}

TEST(Time, ReachesBeyondAHundredYears) {
  EXPECT_GT(at(24h * 365 * 100), at(24h * 365 * 99));
  EXPECT_EQ(microseconds(at(24h * 365 * 100)), INT64_C(3'153'600'000'000'000));
}

}  // namespace
}  // namespace armjig
