// SPDX-License-Identifier: Apache-2.0
#include "harness/report/scene.hpp"

#include <gmock/gmock.h>

namespace armjig {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Scene, HandsItsPosesToThePage) {
  const Scene scene{
      "a < b", "mm", {{0, {{0, 0, 0}, {1, -2.25, 3}}}, {0.5, {{0, 0, 0}, {4, 5, 6}}}}};
  EXPECT_THAT(to_figure(scene),
              AllOf(HasSubstr("{\"times\":[0.0,0.5],\"chains\":[[0.0,0.0,0.0,1.0,-2.2,3.0],"
                              "[0.0,0.0,0.0,4.0,5.0,6.0]]}"),
                    HasSubstr("a &lt; b"), HasSubstr("type=\"range\"")));
}

TEST(Scene, KeepsTheFirstAndTheLastOfManyPoses) {
  Scene scene{"long", "mm", {}};
  for (int i = 0; i <= 100'000; ++i) scene.poses.push_back({0.01 * i, {{}, {1.0 * i, 0, 0}}});
  const auto figure = to_figure(scene);
  EXPECT_LT(figure.size(), 40'000U);
  EXPECT_THAT(figure, AllOf(HasSubstr("[[0.0,0.0,0.0,0.0,0.0,0.0],"),
                            HasSubstr(",[0.0,0.0,0.0,100000.0,0.0,0.0]]"), HasSubstr(",1000.0]")));
}

TEST(Scene, WithoutPosesSaysSo) {
  EXPECT_THAT(to_figure(Scene{.title = "none"}),
              AllOf(HasSubstr("no data"), Not(HasSubstr("range"))));
}

}  // namespace
}  // namespace armjig
