// SPDX-License-Identifier: Apache-2.0
// What estimates of figures are made of; whole fits of boards are in
// tests/integration/shadow_test.py.
#include "emulators/shadow/fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace armjig {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(Fit, WritesANumberWithTheFewestDecimalsWithinItsBounds) {
  EXPECT_EQ(roundest(0.69993, 0.70003), "0.7");
  EXPECT_EQ(roundest(-0.60001, -0.59999), "-0.6");
  EXPECT_EQ(roundest(-0.2, 0.1), "0");
  EXPECT_EQ(roundest(16.9, 17.2), "17");
  EXPECT_EQ(roundest(0.123455, 0.123457), "0.123456");
}

TEST(ValleySearch, FindsWhereTheScoreIsLeast) {
  const ValleySearch search{.least = 50, .most = 50'000, .resolution = 1, .is_geometric = true};
  for (const double best : {50.0, 700.0, 2'301.0, 49'999.0}) {
    int tried = 0;
    const auto valley = search.find([&](double value) -> Outcome<double> {
      ++tried;
      return std::abs(value - best);
    });
    ASSERT_TRUE(valley);
    EXPECT_EQ(valley->least, best);
    EXPECT_EQ(valley->most, best);
    EXPECT_LT(tried, 150);
  }
}

TEST(ValleySearch, AnswersAPlateauFromItsBeginningToItsEnd) {
  const auto valley = ValleySearch{.least = 0, .most = 20}.find(
      [](double value) -> Outcome<double> { return value < 7 || value > 11 ? 1 : 0; });
  ASSERT_TRUE(valley);
  EXPECT_EQ(valley->least, 7);
  EXPECT_EQ(valley->most, 11);
  EXPECT_EQ(valley->worst_score, 1);
}

TEST(ValleySearch, EndsWhereNothingDependsOnTheValue) {
  const auto valley =
      ValleySearch{.least = 1, .most = 1'000'000}.find([](double) -> Outcome<double> { return 3; });
  ASSERT_TRUE(valley);
  EXPECT_EQ(valley->score, valley->worst_score);
}

TEST(ValleySearch, EndsWithTheProblemOfAReplay) {
  const auto valley = ValleySearch{.least = 1, .most = 5}.find(
      [](double) -> Outcome<double> { return problem(ErrorCode::kMalformed, "there", "why"); });
  ASSERT_FALSE(valley);
  EXPECT_EQ(valley.error().where, "there");
}

TEST(Fit, GivesEachFigureWhatThoseBeforeItTold) {
  constexpr std::array kFigures{
      FitFigure{"clock", "%",
                [](const FitTalk&, const DeviceOptions& so_far) -> Outcome<FigureAnswer> {
                  EXPECT_TRUE(so_far.empty());
                  return FigureAnswer{.value = "0.5", .estimates = {}, .basis = "ticks"};
                }},
      FitFigure{"load", "N m", nullptr, "nobody can know"},
      FitFigure{"pass-us", "us",
                [](const FitTalk&, const DeviceOptions& so_far) -> Outcome<FigureAnswer> {
                  EXPECT_THAT(so_far, ElementsAre(Pair("clock", "0.5")));
                  return FigureAnswer{.estimates = {{"", 20, 10, 40}}, .basis = "too steady"};
                }}};
  const auto found = fit(kFigures, {});
  ASSERT_TRUE(found);
  EXPECT_THAT(found->options, ElementsAre(Pair("clock", "0.5")));
  EXPECT_EQ(found->figures[1].answer.basis, "nobody can know");
  EXPECT_EQ(found->figures[2].answer.estimates.front().most, 40);
}

}  // namespace
}  // namespace armjig
