// SPDX-License-Identifier: Apache-2.0
#include "harness/core/quantity.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <type_traits>

namespace armjig {
namespace {

// No unit becomes another one, or a bare number, by itself.
static_assert(!std::is_convertible_v<int, Steps>);
static_assert(!std::is_convertible_v<Steps, int>);
static_assert(!std::is_convertible_v<Steps, StepsPerSecond>);
static_assert(!std::is_constructible_v<Steps, StepsPerSecond>);
static_assert(!std::is_convertible_v<Degrees, Radians>);
static_assert(std::is_trivially_copyable_v<Steps> && sizeof(Steps) == 4);

template <class A, class B>
concept CanBeAdded = requires(A a, B b) { a + b; };
template <class A, class B>
concept CanBeCompared = requires(A a, B b) { a < b; };
static_assert(CanBeAdded<Steps, Steps> && CanBeCompared<Steps, Steps>);
static_assert(!CanBeAdded<Steps, StepsPerSecond> && !CanBeCompared<Steps, StepsPerSecond>);
static_assert(!CanBeAdded<Millimetres, MillimetresPerSecond>);

TEST(Quantity, AddsAndComparesWithinAUnit) {
  EXPECT_EQ(Steps{3} + Steps{4}, Steps{7});
  EXPECT_EQ(Steps{3} - Steps{4}, Steps{-1});
  EXPECT_EQ(-Milliamperes{200}, Milliamperes{-200});
  EXPECT_LT(Degrees{1.5}, Degrees{2.0});
  EXPECT_GE(Ticks{7}, Ticks{7});
}

TEST(Quantity, IsZeroUnlessTold) {
  EXPECT_EQ(Steps{}.value, 0);
  EXPECT_EQ(Percent{}.value, 0.0);
}

TEST(Quantity, KnowsItsSymbol) {
  EXPECT_EQ(std::string_view{StepsPerSecond::unit::symbol}, "steps/s");
  EXPECT_EQ(std::string_view{Radians::unit::symbol}, "rad");
}

}  // namespace
}  // namespace armjig
