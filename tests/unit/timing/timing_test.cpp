// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "harness/timing/latency_histogram.hpp"
#include "harness/timing/schedule.hpp"
#include "tests/unit/support/bytes.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

TEST(PeriodicSchedule, ALateCycleDoesNotMoveTheNextDeadline) {
  PeriodicSchedule schedule{at(0ms), 10ms};
  const auto cycle = schedule.begin(at(3ms));
  EXPECT_EQ(cycle.lateness, 3ms);
  EXPECT_EQ(cycle.skipped, 0U);
  EXPECT_EQ(schedule.next(), at(10ms));
}

TEST(PeriodicSchedule, CountsDeadlinesThatPassedByAndDoesNotMakeUpForThem) {
  PeriodicSchedule schedule{at(0ms), 10ms};
  const auto cycle = schedule.begin(at(34ms));
  EXPECT_EQ(cycle.deadline, at(30ms));
  EXPECT_EQ(cycle.lateness, 4ms);
  EXPECT_EQ(cycle.skipped, 3U);
  EXPECT_EQ(schedule.next(), at(40ms));
}

TEST(PeriodicSchedule, SkipsWhatCameDueWhileACycleWasServed) {
  PeriodicSchedule schedule{at(0ms), 10ms};
  schedule.begin(at(0ms));
  EXPECT_EQ(schedule.skip_until(at(9ms)), 0U);
  EXPECT_EQ(schedule.next(), at(10ms));
  EXPECT_EQ(schedule.skip_until(at(10ms)), 1U);
  EXPECT_EQ(schedule.next(), at(20ms));
  EXPECT_EQ(schedule.skip_until(at(45ms)), 3U);
  EXPECT_EQ(schedule.next(), at(50ms));
}

TEST(LatencyHistogram, IsEmptyAtFirst) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.count(), 0U);
  EXPECT_EQ(histogram.min(), 0ns);
  EXPECT_EQ(histogram.max(), 0ns);
  EXPECT_EQ(histogram.percentile(50), 0ns);
}

TEST(LatencyHistogram, PercentilesAreWithinAThousandthOfTheSortedValues) {
  test::Dice dice{1};
  LatencyHistogram histogram;
  std::vector<std::int64_t> values;
  for (int i = 0; i < 10'000; ++i) {
    values.push_back(dice.between(0, std::int64_t{1} << dice.between(1, 35)));
    histogram.record(Duration{values.back()});
  }
  std::ranges::sort(values);
  EXPECT_EQ(histogram.min().count(), values.front());
  EXPECT_EQ(histogram.max().count(), values.back());
  // Of 10,000 values, in whole hundredths of a percent: 99.9 % is the one at place 9,990.
  for (const std::size_t rank : {1U, 100U, 2'500U, 5'000U, 9'000U, 9'900U, 9'990U, 10'000U}) {
    const auto percent = static_cast<double>(rank) / 100;
    const auto exact = static_cast<double>(values[rank - 1]);
    const auto shown = static_cast<double>(histogram.percentile(percent).count());
    EXPECT_GE(shown, exact) << percent;
    EXPECT_LE(shown, exact * 1.001) << percent;
  }
}

TEST(LatencyHistogram, TakesWhatIsOutOfRangeWithoutHarm) {
  LatencyHistogram histogram;
  histogram.record(-5ms);
  histogram.record(Duration::max());
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_EQ(histogram.min(), 0ns);
  EXPECT_EQ(histogram.max(), Duration::max());
  EXPECT_EQ(histogram.percentile(100), Duration::max());
}

}  // namespace
}  // namespace armjig
