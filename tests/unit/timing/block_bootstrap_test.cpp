// SPDX-License-Identifier: Apache-2.0
#include "harness/timing/block_bootstrap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

constexpr std::array kMedian{50.0};

std::vector<Duration> dice_of(std::uint32_t seed, std::size_t count) {
  test::Dice dice{seed};
  std::vector<Duration> values;
  for (std::size_t i = 0; i < count; ++i) values.emplace_back(dice.between(0, 1'000'000));
  return values;
}

TEST(BlockBootstrap, IsTheSameForTheSameSeed) {
  const auto values = dice_of(1, 1'000);
  const auto once = percentile_intervals(values, kMedian, {.seed = 7});
  EXPECT_EQ(once, percentile_intervals(values, kMedian, {.seed = 7}));
  EXPECT_NE(once, percentile_intervals(values, kMedian, {.seed = 8}));
}

/// Of 100 runs with values of which half are below 500,000, the interval of 95 % misses that about
/// five times; 15 or more have a chance of one in ten thousand.
TEST(BlockBootstrap, CoversTheTrueMedianAsOftenAsItSays) {
  int missed = 0;
  for (std::uint32_t run = 0; run < 100; ++run) {
    const auto interval =
        percentile_intervals(dice_of(run + 1, 400), kMedian, {.confidence = 0.95}).front();
    if (interval.low > 500'000ns || interval.high < 500'000ns) ++missed;
  }
  EXPECT_LT(missed, 15);
  EXPECT_GT(missed, 0);
}

/// Each value 50 times in a row says no more than once: blocks see that, single values do not.
TEST(BlockBootstrap, IsNotFooledByNeighboursThatAreAlike) {
  const auto few = dice_of(3, 80);
  std::vector<Duration> values;
  for (const auto value : few) values.insert(values.end(), 50, value);
  const auto width = [&values](std::size_t block) {
    const auto one = percentile_intervals(values, kMedian, {.block = block}).front();
    return one.high - one.low;
  };
  EXPECT_GT(width(0), 3 * width(1));
}

TEST(BlockBootstrap, OfOneValueIsThatValue) {
  const std::array one{Duration{5ms}};
  EXPECT_EQ(percentile_intervals(one, kMedian, {}).front(), (ConfidenceInterval{5ms, 5ms}));
  EXPECT_EQ(mean_interval(one, {}), (ConfidenceInterval{5ms, 5ms}));
}

}  // namespace
}  // namespace armjig
