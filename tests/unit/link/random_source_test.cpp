// SPDX-License-Identifier: Apache-2.0
#include "harness/link/random_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace armjig {
namespace {

using ::testing::ElementsAre;

/// Moments and shares of many draws. Bounds below are five standard errors.
struct Sample {
  double mean{};
  double variance{};
  std::vector<double> values;

  [[nodiscard]] double share_above(double limit) const {
    double count = 0;
    for (const auto value : values) count += value > limit ? 1 : 0;
    return count / static_cast<double>(values.size());
  }
};

constexpr int kDraws = 200'000;

template <class Draw>
Sample sample(Draw draw) {
  Sample result;
  RandomSource random{42};
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    result.values.push_back(draw(random));
    sum += result.values.back();
    squares += result.values.back() * result.values.back();
  }
  result.mean = sum / kDraws;
  result.variance = squares / kDraws - result.mean * result.mean;
  return result;
}

TEST(RandomSource, IsSplitMix64) {
  // Published with the algorithm's task on rosettacode.org, "Pseudo-random numbers/Splitmix64".
  RandomSource random{1234567};
  const std::array numbers{random.next(), random.next(), random.next(), random.next(),
                           random.next()};
  EXPECT_THAT(numbers, ElementsAre(6457827717110365317U, 3203168211198807973U, 9817491932198370423U,
                                   4593380528125082431U, 16408922859458223821U));
}

TEST(RandomSource, TakesTheUpper53BitsForAUniformNumber) {
  // 6457827717110365317 >> 11 = 3153236189995295, and 2^53 = 9007199254740992.
  EXPECT_EQ(RandomSource{1234567}.uniform(), 3153236189995295.0 / 9007199254740992.0);
}

TEST(RandomSource, DrawsUniformlyBelowOne) {
  const auto drawn = sample([](RandomSource& random) { return random.uniform(); });
  EXPECT_NEAR(drawn.mean, 0.5, 5 * std::sqrt(1.0 / 12 / kDraws));
  EXPECT_NEAR(drawn.variance, 1.0 / 12, 5 * std::sqrt(1.0 / 180 / kDraws));
  EXPECT_THAT(drawn.values, ::testing::Each(::testing::AllOf(::testing::Ge(0), ::testing::Lt(1))));
}

TEST(RandomSource, DrawsEachNumberBelowABound) {
  RandomSource random{7};
  std::array<int, 6> counts{};
  for (int i = 0; i < 60'000; ++i) ++counts.at(random.below(6));
  for (const auto count : counts) EXPECT_NEAR(count, 10'000, 5 * std::sqrt(60'000 * 5.0 / 36));
}

TEST(RandomSource, DrawsOnlyZeroBelowOne) { EXPECT_EQ(RandomSource{3}.below(1), 0U); }

TEST(RandomSource, LetsNothingHappenAtZeroAndEverythingAtOne) {
  RandomSource random{9};
  for (int i = 0; i < 10'000; ++i) {
    EXPECT_FALSE(random.happens(0));
    EXPECT_TRUE(random.happens(1));
  }
}

TEST(RandomSource, DrawsExponentially) {
  const auto drawn = sample([](RandomSource& random) { return random.exponential(); });
  EXPECT_NEAR(drawn.mean, 1, 5 * std::sqrt(1.0 / kDraws));
  EXPECT_NEAR(drawn.variance, 1, 5 * std::sqrt(8.0 / kDraws));  // fourth central moment: 9
  for (const double limit : {0.1, 0.5, 1.0, 2.0, 5.0}) {
    const double share = std::exp(-limit);
    EXPECT_NEAR(drawn.share_above(limit), share, 5 * std::sqrt(share * (1 - share) / kDraws));
  }
  EXPECT_THAT(drawn.values, ::testing::Each(::testing::Ge(0)));
}

TEST(RandomSource, DrawsNormally) {
  const auto drawn = sample([](RandomSource& random) { return random.normal(); });
  EXPECT_NEAR(drawn.mean, 0, 5 * std::sqrt(1.0 / kDraws));
  EXPECT_NEAR(drawn.variance, 1, 5 * std::sqrt(2.0 / kDraws));
  for (const double limit : {-2.0, -1.0, 0.0, 0.5, 1.0, 3.0}) {
    const double share = std::erfc(limit / std::numbers::sqrt2) / 2;
    EXPECT_NEAR(drawn.share_above(limit), share, 5 * std::sqrt(share * (1 - share) / kDraws));
  }
}

TEST(RandomSource, ForksIntoSourcesThatDiffer) {
  const RandomSource random{1};
  EXPECT_NE(random.fork(0).next(), random.fork(1).next());
  EXPECT_NE(random.fork(0).next(), RandomSource{2}.fork(0).next());
  EXPECT_EQ(random.fork(5).next(), random.fork(5).next());
}

TEST(RandomSource, ForksAreNotCorrelated) {
  auto one = RandomSource{1}.fork(0);
  auto other = RandomSource{1}.fork(1);
  double sum = 0;
  for (int i = 0; i < kDraws; ++i) sum += (one.uniform() - 0.5) * (other.uniform() - 0.5);
  EXPECT_NEAR(sum / kDraws, 0, 5 * std::sqrt(1.0 / 144 / kDraws));
}

}  // namespace
}  // namespace armjig
