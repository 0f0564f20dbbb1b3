// SPDX-License-Identifier: Apache-2.0
#include "harness/timing/lookout.hpp"

#include <gtest/gtest.h>

namespace armjig {
namespace {

using namespace std::chrono_literals;

constexpr Lookout::Wall::time_point after(Lookout::Wall::duration time) {
  return Lookout::Wall::time_point{} + time;
}

TEST(Lookout, NoticesWhenNobodyLookedForTooLong) {
  Lookout lookout{15ms, after(0ms)};
  EXPECT_FALSE(lookout.look(after(10ms)));
  EXPECT_FALSE(lookout.look(after(25ms))) << "as long as it may take";
  EXPECT_EQ(lookout.look(after(600ms)), (Lookout::Gap{after(25ms), after(600ms)}));
  EXPECT_FALSE(lookout.look(after(610ms))) << "it was told";
}

}  // namespace
}  // namespace armjig
