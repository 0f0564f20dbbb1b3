// SPDX-License-Identifier: Apache-2.0
#include "harness/timing/sentinel.hpp"

#include <gtest/gtest.h>

#include <array>

#include "harness/timing/realtime.hpp"

namespace armjig {
namespace {

using namespace std::chrono_literals;

TEST(OversleptWithin, CountsOnlyWhatLiesInTheStretch) {
  const std::array oversleeps{Oversleep{at(10ms), 5ms}, Oversleep{at(20ms), 100ms}};
  EXPECT_EQ(overslept_within(oversleeps, at(0ms), at(10ms)), 0ns);
  EXPECT_EQ(overslept_within(oversleeps, at(0ms), at(12ms)), 2ms);
  EXPECT_EQ(overslept_within(oversleeps, at(0ms), at(1s)), 100ms);
  EXPECT_EQ(overslept_within(oversleeps, at(50ms), at(70ms)), 20ms);
  EXPECT_EQ(overslept_within(oversleeps, at(120ms), at(130ms)), 0ns);
}

/// How late it is depends on the machine; that it wakes, counts and ends does not.
TEST(Sentinel, CountsEachOfItsSleeps) {
  Sentinel sentinel{at(3s), 100us, 0ns};
  while (sentinel.is_fresh()) std::this_thread::yield();
  sentinel.stop();
  ASSERT_FALSE(sentinel.oversleeps().empty());
  EXPECT_EQ(sentinel.oversleeps().front().due, at(3s) + 100us);
  EXPECT_EQ(sentinel.lateness().count(), sentinel.oversleeps().size());
}

TEST(Realtime, SaysOfEachPrivilegeWhetherItIsGranted) {
  const Realtime realtime{{.processor = 100'000}};
  ASSERT_EQ(realtime.privileges().size(), 3U);
  for (const auto& one : realtime.privileges()) EXPECT_FALSE(one.text.empty()) << one.name;
  EXPECT_FALSE(realtime.privileges().back().is_granted) << "no machine has that processor";
}

}  // namespace
}  // namespace armjig
